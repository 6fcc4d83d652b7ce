/* SPDX-License-Identifier: MIT
 *
 * guard: a task that runs over the end of its stack gets a MemManage fault before it harms
 * another's: an MPU region, read-only, over the lowest 32 bytes of the running task's stack.
 */
#pragma once

#include "stm32f2.h"
#include "ucos_ii.h"

#define GUARD_BYTES 32UL
#define REGION_0 0x10UL /* RBAR.VALID: the region is in the low bits */
/* Never execute, read only (for OSTaskStkChk), 2^(4+1) bytes, on. */
#define GUARD_RASR (1UL << 28 | 5UL << 24 | 4UL << 1 | 1UL)

/* Forbids writing to the lowest 32 bytes of a stack (aligned to 32); 0 removes the guard. Called at
 * each switch, with interrupts off. */
static void Guard_place(const OS_STK* bottom) {
    if (!bottom) {
        MPU_CTRL = 0;
        return;
    }
    MPU_RBAR = (((U32)bottom + GUARD_BYTES - 1UL) & ~(GUARD_BYTES - 1UL)) | REGION_0;
    MPU_RASR = GUARD_RASR;
    MPU_CTRL = MPU_CTRL_ON;
}
