/* SPDX-License-Identifier: MIT
 *
 * uav_keys: the vehicle's keys, in memory that keeps them without power. Each ground that it serves
 * has two slots, one in use and one that takes the next key. A vehicle without a key starts only if
 * it was opened on purpose. Power may fail at any word: the slot then has its old content, none, or
 * its new one, and the other slot is not touched.
 */
#pragma once

#include "link.h"

#define UAV_KEY_SLOTS 2
/* A ground: two slots of four words of key and their check, then states and addresses. */
#define UAV_GROUND_WORDS 16U
/* Whom a vehicle serves: the first ground, a second one, and a vehicle that it calls, too. */
#define UAV_GROUNDS 3
#define UAV_SECOND 1
#define UAV_FELLOW 2
#define UAV_GROUP UAV_GROUNDS /* in a ground's place: the group's key, of calls to all vehicles */
#define UAV_KEY_WORDS ((UAV_GROUNDS + 1) * UAV_GROUND_WORDS)
#define UAV_EVERYBODY 0xFFFFU     /* the group's address */
#define UAV_NO_GROUND 0xFFFFFFFFU /* in place of an address */
#define UAV_FLIGHT_WORD 11U
#define UAV_FLYING 0x464C5921U /* in that word; anything else: on the ground */

/* The board keeps secrets and draws random numbers. `context` is passed back unchanged. */
typedef struct UAV_Board {
    /* Returns 32 bits that nobody can guess. */
    U32 (*random)(void* context);
    /* Reads and writes words 0..UAV_KEY_WORDS - 1, which keep their values without power. */
    U32 (*load)(void* context, U32 word);
    void (*store)(void* context, U32 word, U32 value);
} UAV_Board;

/* Sets the board, which must stay valid. Call it first. */
void UAV_useBoard(const UAV_Board* board, void* context);

/* Returns 32 bits that nobody can guess. */
U32 UAV_random(void* unused);

/* Provides the vehicle, in its factory, with its address and this key alone. 0: no key; anyone may
 * call. */
void UAV_provide(U32 address, const U8* key);

/* Provides it with a UAV_SECOND ground, by its modem's address, and with that one's key; or with a
 * UAV_FELLOW, which has the same key and this one's address; or with the key of its UAV_GROUP. 0:
 * no key, for an open vehicle. UAV_NO_GROUND: it has none, as after UAV_provide. */
void UAV_provideGround(int ground, U32 address, const U8* key);

/* Returns 1 if the vehicle takes calls to all vehicles: it has the group's key, or is open. */
int UAV_isOfGroup(void);

/* Decrypts such a call, unless it is one that this vehicle has seen (Link_openBroadcast), and
 * remembers its number. Returns the message's size; 0: it is not to be carried out. */
U32 UAV_openBroadcast(U8* packet, U32 size);

/* Returns the address of the second ground or fellow, as it was provided, or UAV_NO_GROUND. */
U32 UAV_addressOf(int ground);

/* Returns 1 if this vehicle has the ground's part in sessions with its fellow: of the two it has
 * the lower address. */
int UAV_hasGroundsPart(void);

/* Returns the vehicle's address: its modem's MY, to which its keys are bound. */
U32 UAV_address(void);

/* Whether the vehicle flies; a restart in flight does not change it. */
int UAV_isFlying(void);
void UAV_setFlying(int isFlying);

/* Grounds are numbered from 0 on. Reads the key of a ground's slot. Returns 0 where it has none. */
int UAV_readKey(int ground, int slot, U8* key);

/* Returns 1 if this is one of the first ground's keys, in the same time for any other. */
int UAV_isKey(const U8* key);

/* Returns how many slots of a ground have a key. */
int UAV_countKeys(int ground);

/* Returns 1 if the vehicle has no key and was opened. */
int UAV_isOpen(void);

/* Gives a ground's link the keys of both slots; returns how many there are. */
int UAV_giveKeys(int ground, Link* link);

/* Puts a ground's next key into the slot that is not in use. Returns 0 where the session has no
 * key, since everybody on the air would read the new one. The present key is accepted and changes
 * nothing. */
int UAV_setNextKey(int ground, Link* link, const U8* key);

/* Removes the old key once a session is up under the next one, which the peer then has. Returns 1
 * where it did. */
int UAV_confirmKey(int ground, Link* link);
