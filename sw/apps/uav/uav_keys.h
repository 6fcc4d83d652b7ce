/* SPDX-License-Identifier: MIT
 *
 * uav_keys: the vehicle's keys, in memory that keeps them without power. Of two slots one is in use
 * and the other takes the next key. A vehicle without a key starts only if it was opened on
 * purpose. Power may fail at any word: the slot then has its old content, none, or its new one, and
 * the other slot is not touched.
 */
#pragma once

#include "link.h"

#define UAV_KEY_SLOTS 2
#define UAV_KEY_WORDS 13U /* a slot: four words of key, its check; two states; the address */
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

/* Returns the vehicle's address: its modem's MY, to which its keys are bound. */
U32 UAV_address(void);

/* Whether the vehicle flies; a restart in flight does not change it. */
int UAV_isFlying(void);
void UAV_setFlying(int isFlying);

/* Reads a slot's key. Returns 0 where it has none. */
int UAV_readKey(int slot, U8* key);

/* Returns 1 if this is one of the vehicle's keys, in the same time for any other. */
int UAV_isKey(const U8* key);

/* Returns how many slots have a key. */
int UAV_countKeys(void);

/* Returns 1 if the vehicle has no key and was opened. */
int UAV_isOpen(void);

/* Gives the link the keys of both slots; returns how many there are. */
int UAV_giveKeys(Link* link);

/* Puts the next key into the slot that is not in use. Returns 0 where the session has no key, since
 * everybody on the air would read the new one. The present key is accepted and changes nothing. */
int UAV_setNextKey(Link* link, const U8* key);

/* Removes the old key once a session is up under the next one, which the peer then has. Returns 1
 * where it did. */
int UAV_confirmKey(Link* link);
