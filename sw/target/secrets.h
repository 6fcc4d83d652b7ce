/* SPDX-License-Identifier: MIT
 *
 * secrets: the STM32F2's random numbers and the memory that its battery keeps, for the
 * application's keys.
 */
#ifndef SECRETS_H
#define SECRETS_H

#include "uav_keys.h"

/* The random number generator, and the first words of the backup SRAM; the context is not used. */
extern const UAV_Board secrets_board;

/* Starts both; needs the clocks of Board_start. */
void Secrets_start(void);

#endif
