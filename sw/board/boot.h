/* SPDX-License-Identifier: MIT
 *
 * boot: records why the firmware was started and what has ended the previous run. At each start,
 * the reason is written to the system slot's SCRATCH register, which every client of the FPGA can
 * read.
 *
 *   31..24  0xB0, which distinguishes a report from other uses of the register
 *   23..16  starts since power-on, modulo 256
 *   15..8   Boot_Reason
 *    7..0   detail: for faults, the priority of the running task (63 the idle task, 255 none)
 */
#pragma once

#include "base.h"

typedef enum Boot_Reason {
    BOOT_POWER_ON = 1,
    BOOT_SOFTWARE = 2,       /* a software reset was requested, without a fault */
    BOOT_WATCHDOG = 3,       /* the watchdog was not refreshed for one second */
    BOOT_IMAGE_CORRUPT = 4,  /* the checksum of the image is wrong: the firmware did not start */
    BOOT_STACK_OVERFLOW = 5, /* a task overflowed its stack */
    BOOT_BUS_FAULT = 6,      /* a bus access got no response */
    BOOT_USAGE_FAULT = 7,    /* an undefined instruction was executed */
    BOOT_HARD_FAULT = 8,
    BOOT_NO_FPGA = 9, /* the system slot does not respond; used only in Boot_record */
    BOOT_NO_KEY = 10  /* the vehicle has no key and was not explicitly opened */
} Boot_Reason;

#define BOOT_REPORT_MARK 0xB0U

/* Record of the last fault. It survives resets, but not a loss of power. */
typedef struct Boot_Record {
    U32 magic;
    U32 starts;  /* number of starts since power-on */
    U32 reason;  /* Boot_Reason of a fault that is not reported yet; otherwise 0 */
    U32 pc, lr;  /* program counter and link register at the fault */
    U32 address; /* address of the access that failed; 0 for other faults */
    U32 status;  /* SCB's CFSR */
    U32 task;    /* priority of the running task */
} Boot_Record;

extern Boot_Record boot_record; /* record of the previous run, valid after Boot_begin */

/* Counts the start and determines its reason. Must be called before all other functions. */
void Boot_begin(void);
/* Returns 1 if the checksum that the build appended to the image is correct. */
int Boot_imageIsSound(void);
/* Returns 1 if the FPGA must load its bitstream: after power-on, or if it did not respond. */
int Boot_loadsFpga(void);
/* Returns the report in the format of SCRATCH. */
U32 Boot_report(void);
/* Makes the next start report this reason, even if something else ends the current run. */
void Boot_note(Boot_Reason reason);
/* Records the fault and resets the processor. */
void Boot_fail(Boot_Reason reason, U32 pc, U32 lr, U32 address);
/* Reports a corrupt image in SCRATCH, and stops forever. */
void Boot_refuse(void);
