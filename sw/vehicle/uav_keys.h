/* SPDX-License-Identifier: MIT
 *
 * uav_keys: the vehicle's keys, in memory that keeps them without power. Each role has two slots:
 * one holds the current key, the other one can take the next key. A vehicle without a key starts
 * only if it was explicitly opened. If power fails during a write, the slot has its old content, no
 * content or its new content, and the other slot is unchanged.
 */
#pragma once

#include "link.h"
#include "uav_peers.h"

/* state of the first ground station without a key, if any ground station may call */
#define UAV_STATE_OPEN 0x4F50454EU
#define UAV_PEER_WORDS ((U32)(sizeof(Backup_Other) / sizeof(U32)))

/* Index of a word in the memory: the state of a role. In roles other than UAV_GROUND, the inverted
 * address follows. */
#define UAV_STATE_AT(role) ((U32)(role) * UAV_PEER_WORDS + BACKUP_AT(vehicle.keys.state))
#define UAV_ADDRESS_AT(role) (BACKUP_AT(others[0].inverted) + ((U32)(role) - 1U) * UAV_PEER_WORDS)

/* Sets the vehicle's address and its only key, in the factory; all other keys are deleted. If `key`
 * is 0, any ground station may call. Returns 0 if there is a key but the firmware does not support
 * keys. */
int UAV_provide(U32 address, const U8* key);

/* Reads the key of a slot. Returns 0 if the slot is empty. */
int UAV_readKey(int role, int slot, U8* key);

/* Writes a key to a slot; if `key` is 0, empties the slot. */
void UAV_writeKey(int role, int slot, const U8* key);

/* Returns 1 if `key` is one of the first ground station's keys. The execution time does not depend
 * on the key. */
int UAV_isKey(const U8* key);

/* Returns how many slots of a role contain a key. */
int UAV_countKeys(int role);

/* Returns 1 if the vehicle has no key and was explicitly opened. */
int UAV_isOpen(void);

/* Returns the address of the peer in a role; UAV_NO_PEER if the peer has no key and the vehicle is
 * not open. */
U32 UAV_addressOf(int role);

/* Returns 1 if this vehicle acts as the ground station in sessions with the other vehicle, that is,
 * if this vehicle has the lower address. */
int UAV_hasGroundsPart(void);

/* Sets the keys of both slots of a role on the peer's link. Returns the number of keys. */
int UAV_giveKeys(int role, Link* link);

/* Writes the next key of a peer into the unused slot. Returns 0 if the session is not encrypted,
 * because the new key could then be read on the air. If `key` is the current key, returns 1 and
 * changes nothing. */
int UAV_setNextKey(int role, Link* link, const U8* key);

/* Removes the old key if the session uses the next key, because this shows that the peer has the
 * next key. Returns 1 if the old key was removed. */
int UAV_confirmKey(int role, Link* link);
