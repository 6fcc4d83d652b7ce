/* SPDX-License-Identifier: MIT
 *
 * console: the report of the self-test, text on the console's UART (115,200 baud, 8N1).
 *
 * Each line begins with a word, so that a program can read it (tools/icesoc/board/bringup.py):
 *
 *     BOARD name ...
 *     STEP  name: what is tested, and when it has passed
 *     INFO  text
 *     FAIL  step wire kind: what was seen; check: what to look at
 *     PASS  step: figures
 *     NEXT  what to do before the test continues
 *     END   number of failures
 *
 * A wire is the name of a net, or the names of a pair with a hyphen between them.
 */
#pragma once

#include "base.h"

/* Sets the UART up; `hz` is the clock of its bus (PCLK2). */
void Console_start(U32 hz);
void Console_text(const char* text);
void Console_number(U32 value);
void Console_hex(U32 value, U32 digits);
/* Writes a number with `decimals` of its digits after the point. */
void Console_fixed(U32 value, U32 decimals);
void Console_end(void); /* ends a line */

/* Begins a step. Report_fail and Report_pass print its name. */
void Report_step(const char* name, const char* passes);
/* Reports a failure of the present step. `second` is 0, or the other wire of a pair. */
void Report_fail(const char* wire, const char* second, const char* kind, const char* seen,
                 const char* check);
/* Begins a line of figures if no failure was reported in this step; returns 1 if so. The caller
 * writes the figures, then Console_end. */
int Report_pass(void);
/* Returns the failures of this step, and of all steps. */
U32 Report_stepFailures(void);
U32 Report_failures(void);
