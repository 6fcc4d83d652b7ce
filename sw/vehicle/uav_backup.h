/* SPDX-License-Identifier: MIT
 *
 * uav_backup: the vehicle's memory that a battery powers (backup.h), the vehicle's address and
 * flight state, which are stored in it, and random numbers.
 */
#pragma once

#include "backup.h"

/* Functions of the board for keys and random numbers. `context` is passed to them unchanged. */
typedef struct UAV_Board {
    /* Returns 32 random bits from a source that cannot be predicted. */
    U32 (*random)(void* context);
    /* Read and write words 0..BACKUP_WORDS - 1, which keep their values without power. */
    U32 (*load)(void* context, U32 word);
    void (*store)(void* context, U32 word, U32 value);
} UAV_Board;

/* Sets the board's functions, which must stay valid. Call this before all other functions. */
void UAV_useBoard(const UAV_Board* board, void* context);

/* Returns 32 random bits from the board's source. */
U32 UAV_random(void* unused);

U32 UAV_load(U32 word);
void UAV_store(U32 word, U32 value);

/* Returns the address of the vehicle, which is the MY of its modem. Its keys are bound to this
 * address. */
U32 UAV_address(void);

/* Return and set whether the vehicle is flying. The value survives a restart in flight. */
int UAV_isFlying(void);
void UAV_setFlying(int isFlying);
