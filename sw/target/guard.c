/* SPDX-License-Identifier: MIT
 *
 * guard: an MPU region, read-only, over the lowest 32 bytes of the running task's stack.
 */
#include "guard.h"
#include "stm32f2.h"

#define GUARD_BYTES 32UL
#define REGION_0 0x10UL /* RBAR.VALID: the region is in the low bits */
/* Never execute, read only (for OSTaskStkChk), 2^(4+1) bytes, on. */
#define GUARD_RASR (1UL << 28 | 5UL << 24 | 4UL << 1 | 1UL)

void Guard_place(const OS_STK* bottom) {
    if (!bottom) {
        MPU_CTRL = 0;
        return;
    }
    MPU_RBAR = (((U32)bottom + GUARD_BYTES - 1UL) & ~(GUARD_BYTES - 1UL)) | REGION_0;
    MPU_RASR = GUARD_RASR;
    MPU_CTRL = MPU_CTRL_ON;
}
