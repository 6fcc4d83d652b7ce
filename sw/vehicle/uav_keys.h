/* SPDX-License-Identifier: MIT
 *
 * uav_keys: the vehicle's keys, in memory that keeps them without power. Each role has two slots,
 * one in use and one that takes the next key. A vehicle without a key starts only if it was opened
 * on purpose. Power may fail at any word: the slot then has its old content, no content or its new
 * content, and the other slot is unchanged.
 */
#pragma once

#include "link.h"
#include "uav_peers.h"

/* state of the first ground: there is no key, and any ground may call */
#define UAV_STATE_OPEN 0x4F50454EU
#define UAV_PEER_WORDS ((U32)(sizeof(Backup_Other) / sizeof(U32)))

/* Index of a word: the state of a role; the inverted address of a role other than UAV_GROUND. */
#define UAV_STATE_AT(role) ((U32)(role) * UAV_PEER_WORDS + BACKUP_AT(vehicle.keys.state))
#define UAV_ADDRESS_AT(role) (BACKUP_AT(others[0].inverted) + ((U32)(role) - 1U) * UAV_PEER_WORDS)

/* Gives the vehicle its address and one key, in the factory; all others are deleted. With `key` 0
 * any ground may call. Returns 0 if a key is given and the firmware does not support keys. */
int UAV_provide(U32 address, const U8* key);

/* Reads the key of a slot. Returns 0 if the slot is empty. */
int UAV_readKey(int role, int slot, U8* key);

/* Writes a slot; empties it if `key` is 0. */
void UAV_writeKey(int role, int slot, const U8* key);

/* Returns 1 if `key` is one of the first ground's keys. The time does not depend on the key. */
int UAV_isKey(const U8* key);

/* Returns the number of a role's slots that have a key. */
int UAV_countKeys(int role);

/* Returns 1 if the vehicle has no key and was opened. */
int UAV_isOpen(void);

/* Returns the address of a role's peer if it has a key or the vehicle is open; otherwise
 * UAV_NO_PEER. */
U32 UAV_addressOf(int role);

/* Returns 1 if this vehicle has the role of the ground in sessions with another vehicle. The
 * vehicle with the lower address has this role. */
int UAV_hasGroundsPart(void);

/* Gives a peer's link the keys of both slots. Returns the number of keys. */
int UAV_giveKeys(int role, Link* link);

/* Writes the next key of a peer into its unused slot. Returns 0 if the session is not encrypted,
 * because then everyone on the air could read the new key. If `key` is the current key, it is
 * accepted and nothing changes. */
int UAV_setNextKey(int role, Link* link, const U8* key);

/* Removes the old key if the session uses the next one, since the peer then has it. Returns 1 if
 * the key was removed. */
int UAV_confirmKey(int role, Link* link);
