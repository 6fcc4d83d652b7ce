/* SPDX-License-Identifier: MIT
 *
 * board: the STM32F2 around the firmware: clock, pins, FSMC, interrupts, watchdog, stack guard.
 */
#pragma once

#include "fsmc.h"

/* Loads and stores of the processor; the context is not used. */
extern const FSMC_Port board_fsmc;

/* Sets up the clock (120 MHz), flash wait states and the FSMC pins, as board_pins.h describes the
 * board. Uses no RAM. */
void Board_start(void);
/* Returns whether the jumper JUMPER_WIRED is closed: the board is wired, without a modem. */
int Board_isWired(void);
/* Starts SysTick, the FPGA's interrupt and the watchdog. To be called with interrupts masked,
 * before OSStart. */
void Board_startInterrupts(void);
/* Serves the watchdog, which resets the processor if this is not called for a second. */
void Board_serveWatchdog(void);
/* Returns the priority of the running task; 255 before the first task runs. */
U32 Board_task(void);

/* Interrupt routines, for the vectors. */
void EXTI0_Handler(void);
void SysTick_Handler(void);
