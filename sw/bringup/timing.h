/* SPDX-License-Identifier: MIT
 *
 * timing: sets the clock of the microcontroller, and waits.
 */
#pragma once

#include "base.h"

typedef struct Timing_Clock {
    U32 hclkHz;
    int isCrystal; /* 0 if the crystal does not oscillate, and the internal oscillator is used */
} Timing_Clock;

/* Switches to the highest clock that the board allows, 120 MHz. */
const Timing_Clock* Timing_start(void);
/* Switches HCLK to `hz`, 20 to 120 MHz in steps of 1 MHz. The bus timings keep their numbers of
 * cycles. */
void Timing_setHclk(U32 hz);
U32 Timing_mhz(void); /* HCLK */
/* Waits for at least this number of HCLK cycles. */
void Timing_pause(U32 cycles);
void Timing_wait(U32 us);
/* Returns the number of HCLK cycles since Timing_start, modulo 2^24. */
U32 Timing_cycles(void);
