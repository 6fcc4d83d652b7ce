/* SPDX-License-Identifier: MIT
 *
 * watchdog: resets the microcontroller if a step of the self-test hangs, for example in an access
 * that waits for NWAIT for ever. After the reset, the self-test in flash reports the step that
 * hung, and ends. If the self-test was started in RAM, the program in flash runs after the reset;
 * the report then ends with the name of the step.
 */
#pragma once

#include "base.h"

/* Starts the watchdog. `ms` is the time without a refresh after which the watchdog resets the
 * processor, 8 to 32000. The error of this time is up to 50 %, because of the watchdog's
 * oscillator. */
void Watchdog_start(U32 ms);
/* Refreshes the watchdog. */
void Watchdog_feed(void);
/* Stores the name of the current step. */
void Watchdog_enter(const char* step);
/* Returns the step that hung, if the watchdog has caused the last reset; otherwise returns 0. A
 * second call returns 0. */
const char* Watchdog_hungStep(void);
