/* SPDX-License-Identifier: MIT
 *
 * secrets: random numbers, and memory for keys that keeps its content without power.
 */
#pragma once

#include "uav_backup.h"

extern const UAV_Board secrets_board; /* its context is not used */

/* Starts the generator and the memory. Needs the clocks of Board_start. */
void Secrets_start(void);
