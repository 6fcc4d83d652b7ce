/* SPDX-License-Identifier: MIT
 *
 * bringup: limits of the self-test, which a debugger may change. Facts of the board are in
 * board_pins.h.
 */
#pragma once

#include "base.h"

/* Limits of the self-test. The defaults suit a board; a simulation shortens some. */
typedef struct Bringup_Limits {
    U32 steps;       /* groups of steps to run, BRINGUP_... */
    U32 modemBootMs; /* longest start of a modem, ms */
    U32 guardMs;     /* guard time of the modem's command mode, ms (GT) */
    U32 patternKib;  /* tested memory, KiB; 0: all of DDR3 */
    U32 retentionMs; /* time for which DDR3 must keep its values, ms */
} Bringup_Limits;

#define BRINGUP_WIRES 1UL /* between microcontroller and FPGA */
#define BRINGUP_CLOCK 2UL
#define BRINGUP_MODEM_WIRES 4UL
#define BRINGUP_BUS 8UL
#define BRINGUP_MEMORY 16UL
#define BRINGUP_TIMING 32UL /* needs the memory */
#define BRINGUP_MODEM 64UL
#define BRINGUP_ALL 0xFFFFFFFFUL

extern Bringup_Limits bringup_limits;
