/* SPDX-License-Identifier: MIT
 *
 * board: set-up of the STM32F2: clock, pins, FSMC, interrupts, watchdog, stack guard.
 */
#pragma once

#include "fsmc.h"

/* Functions with which the FSMC driver makes loads and stores on this processor. They do not use
 * the context. */
extern const FSMC_Port board_fsmc;

/* Configures the clock (120 MHz), the flash wait states and the pins of the FSMC; board_pins.h
 * describes the board. Uses no RAM. */
void Board_start(void);
/* Returns 1 if the jumper JUMPER_WIRED is closed. The board then has no modem: wires replace the
 * radio. */
int Board_isWired(void);
/* Starts SysTick, the FPGA's interrupt and the watchdog. Call this with interrupts masked, before
 * OSStart. */
void Board_startInterrupts(void);
/* Refreshes the watchdog, which resets the processor after one second without a refresh. */
void Board_serveWatchdog(void);
/* Returns the priority of the running task; 255 before the first task runs. */
U32 Board_task(void);

/* Interrupt routines, for the vector table. */
void EXTI0_Handler(void);
void SysTick_Handler(void);
