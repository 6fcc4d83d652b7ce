/* SPDX-License-Identifier: MIT
 *
 * minimal: what the smallest program shares with its start-up code.
 */
#pragma once

#include "base.h"

extern volatile U32 minimal_ticks; /* milliseconds since the start */

/* Sleeps until the next tick. */
void Minimal_sleep(void);

/* The program; returns where the FPGA or the modem does not answer. */
int main(void);
