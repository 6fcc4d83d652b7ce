/* SPDX-License-Identifier: MIT
 *
 * guard: protects the stacks of other tasks against a task that overflows its stack. An MPU region
 * over the lowest 32 bytes of the running task's stack is read-only, so an overflow causes a
 * MemManage fault.
 */
#pragma once

#include "stm32f2.h"
#include "ucos_ii.h"

#define GUARD_BYTES 32UL
#define REGION_0 0x10UL /* RBAR.VALID: the low bits select the region */
/* Attributes of the region: never executable, read-only (because OSTaskStkChk reads it), 2^(4+1)
 * bytes, enabled. */
#define GUARD_RASR (1UL << 28 | 5UL << 24 | 4UL << 1 | 1UL)

/* Makes the lowest 32 bytes of a stack, aligned to 32, read-only; a `bottom` of 0 removes this
 * guard. Called at each task switch with interrupts disabled. */
static void Guard_place(const OS_STK* bottom) {
    if (!bottom) {
        MPU_CTRL = 0;
        return;
    }
    MPU_RBAR = (((U32)bottom + GUARD_BYTES - 1UL) & ~(GUARD_BYTES - 1UL)) | REGION_0;
    MPU_RASR = GUARD_RASR;
    MPU_CTRL = MPU_CTRL_ON;
}
