/* SPDX-License-Identifier: MIT
 *
 * board: the STM32F2 around the firmware: clock, pins, FSMC, interrupts, watchdog, stack guard.
 */
#ifndef BOARD_H
#define BOARD_H

#include "fsmc.h"

/* Loads and stores of the processor; the context is not used. */
extern const FSMC_Port board_fsmc;

/* 120 MHz from a crystal of 25 MHz, flash wait states; the pins of the FSMC. No RAM is used. */
void Board_start(void);
/* SysTick, the FPGA's interrupt and the watchdog. To be called with interrupts masked, before
 * OSStart. */
void Board_startInterrupts(void);
/* Not called for a second, the watchdog resets the processor. */
void Board_serveWatchdog(void);
/* Priority of the task that runs, 255: none does yet. */
U32 Board_task(void);

/* Interrupt routines, for the vectors. */
void EXTI0_Handler(void);
void SysTick_Handler(void);

#endif
