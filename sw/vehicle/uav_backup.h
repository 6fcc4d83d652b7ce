/* SPDX-License-Identifier: MIT
 *
 * uav_backup: the vehicle's memory that a battery keeps (backup.h), its random numbers, and the
 * state that is kept there: address and flight.
 */
#pragma once

#include "backup.h"

/* Functions of the board for secrets and random numbers. `context` is passed back unchanged. */
typedef struct UAV_Board {
    /* Returns 32 bits that cannot be guessed. */
    U32 (*random)(void* context);
    /* Read and write words 0..BACKUP_WORDS - 1, which keep their values without power. */
    U32 (*load)(void* context, U32 word);
    void (*store)(void* context, U32 word, U32 value);
} UAV_Board;

/* Sets the board, which must stay valid. Call it first. */
void UAV_useBoard(const UAV_Board* board, void* context);

/* Returns 32 bits that cannot be guessed. */
U32 UAV_random(void* unused);

U32 UAV_load(U32 word);
void UAV_store(U32 word, U32 value);

/* Returns the vehicle's address: its modem's MY, to which its keys are bound. */
U32 UAV_address(void);

/* Return and set whether the vehicle flies; kept through a restart in flight. */
int UAV_isFlying(void);
void UAV_setFlying(int isFlying);
