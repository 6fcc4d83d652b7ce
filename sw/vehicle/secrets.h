/* SPDX-License-Identifier: MIT
 *
 * secrets: random numbers, and memory for keys that keeps its contents without power.
 */
#pragma once

#include "uav_backup.h"

extern const UAV_Board secrets_board; /* functions for UAV_useBoard; their context is not used */

/* Starts the random number generator and the memory. Needs the clocks that Board_start sets. */
void Secrets_start(void);
