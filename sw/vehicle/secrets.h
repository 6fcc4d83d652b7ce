/* SPDX-License-Identifier: MIT
 *
 * secrets: random numbers, and memory for keys that keeps its contents when power is off.
 */
#pragma once

#include "uav_backup.h"

/* functions that are passed to UAV_useBoard; they do not use their context */
extern const UAV_Board secrets_board;

/* Starts the random number generator and the memory. Needs the clocks that Board_start sets. */
void Secrets_start(void);
