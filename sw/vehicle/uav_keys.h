/* SPDX-License-Identifier: MIT
 *
 * uav_keys: the vehicle's keys, in memory that keeps them without power. Each role has two slots,
 * one in use and one that takes the next key. A vehicle without a key starts only if it was opened
 * on purpose. Power may fail at any word: the slot then has its old content, none, or its new one,
 * and the other slot is not touched.
 */
#pragma once

#include "link.h"
#include "uav_peers.h"

#define UAV_STATE_OPEN 0x4F50454EU /* the first ground's state: no key, any ground may call */
#define UAV_PEER_WORDS ((U32)(sizeof(Backup_Other) / sizeof(U32)))

/* Stores the vehicle's address and this key as the only one, in the factory. 0: no key; any ground
 * may call. Returns 0 for a key in firmware without keys. */
int UAV_provide(U32 address, const U8* key);

/* Reads the key of a slot. Returns 0 if the slot is empty. */
int UAV_readKey(int role, int slot, U8* key);

/* Writes a slot; without a key, empties it. */
void UAV_writeKey(int role, int slot, const U8* key);

/* Return the index of a role's state word, and of the inverted address of any role but the first
 * ground. */
U32 UAV_stateAt(int role);
U32 UAV_addressAt(int role);

/* Returns 1 if this is one of the first ground's keys, in the same time for any other. */
int UAV_isKey(const U8* key);

/* Returns how many slots of a role have a key. */
int UAV_countKeys(int role);

/* Returns 1 if the vehicle has no key and was opened. */
int UAV_isOpen(void);

/* Returns the address of a role's peer, if it has a key or the vehicle is open; else UAV_NO_PEER.
 */
U32 UAV_addressOf(int role);

/* Returns 1 if this vehicle has the ground's part in sessions with another vehicle: of the two it
 * has the lower address. */
int UAV_hasGroundsPart(void);

/* Gives a peer's link the keys of both slots; returns how many there are. */
int UAV_giveKeys(int role, Link* link);

/* Stores a peer's next key in the slot that is not in use. Returns 0 if the session has no key,
 * since the new one could be read on the air. The present key is accepted and changes nothing. */
int UAV_setNextKey(int role, Link* link, const U8* key);

/* Removes the old key once a session is up under the next one, which the peer then has. Returns 1
 * if it did. */
int UAV_confirmKey(int role, Link* link);
