/* SPDX-License-Identifier: MIT
 *
 * bringup: limits of the self-test, which a debugger may change. board_pins.h has the properties of
 * the board.
 */
#pragma once

#include "base.h"

/* Limits of the self-test. The defaults suit a real board; a simulation shortens some of them. */
typedef struct Bringup_Limits {
    U32 steps;       /* groups of steps to run, an OR of BRINGUP_... */
    U32 modemBootMs; /* limit for the start of a modem, ms */
    U32 guardMs;     /* guard time of the modem's command mode, ms (GT) */
    U32 patternKib;  /* size of the tested memory, KiB; 0 means all of DDR3 */
    U32 retentionMs; /* time for which DDR3 must keep its values, ms */
    U32 watchdogMs;  /* time after which a step counts as hung, ms */
} Bringup_Limits;

#define BRINGUP_WIRES 1UL /* wires between microcontroller and FPGA */
#define BRINGUP_CLOCK 2UL
#define BRINGUP_MODEM_WIRES 4UL
#define BRINGUP_BUS 8UL
#define BRINGUP_MEMORY 16UL
#define BRINGUP_TIMING 32UL /* bus timing; needs BRINGUP_MEMORY */
#define BRINGUP_MODEM 64UL
#define BRINGUP_ALL 0xFFFFFFFFUL

extern Bringup_Limits bringup_limits;
