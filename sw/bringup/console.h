/* SPDX-License-Identifier: MIT
 *
 * console: writes the report of the self-test to the console's UART (115,200 baud, 8N1).
 *
 * Each line begins with a keyword, so that a program can parse it (tools/icesoc/board/bringup.py):
 *
 *     BOARD name ...
 *     STEP  name: purpose of the test, and condition for passing it
 *     INFO  text
 *     FAIL  step wire kind: observation; check: likely causes
 *     PASS  step: figures
 *     NEXT  action needed before the test continues
 *     END   number of failures
 *
 * A wire is named by its net, a pair of wires by both nets with a hyphen in between.
 */
#pragma once

#include "base.h"

/* Configures the UART; `hz` is the clock of its bus (PCLK2). */
void Console_start(U32 hz);
void Console_text(const char* text);
void Console_number(U32 value);
void Console_hex(U32 value, U32 digits);
/* Writes a number; its last `decimals` digits are decimals. */
void Console_fixed(U32 value, U32 decimals);
void Console_end(void); /* ends a line */

/* Begins a step. Report_fail and Report_pass print its name. */
void Report_step(const char* name, const char* passes);
/* Reports a failure of the current step. `second` is the other wire of a pair, or 0. */
void Report_fail(const char* wire, const char* second, const char* kind, const char* seen,
                 const char* check);
/* If the step has no failure, prints the beginning of the line PASS and returns 1. The caller then
 * prints the measured values and calls Console_end. */
int Report_pass(void);
/* Return the number of failures of this step, and of all steps. */
U32 Report_stepFailures(void);
U32 Report_failures(void);
