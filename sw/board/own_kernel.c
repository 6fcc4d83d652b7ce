/* SPDX-License-Identifier: MIT
 *
 * own_kernel: implements those functions of the board that depend on the kernel, for the kernel in
 * sw/os.
 */
#include "board.h"
#include "boot.h"
#include "guard.h"
#include "os_core.h"
#include "os_m3.h"

void OSTaskIdleHook(void) {
    __asm__ volatile("wfi");
}

void OS_TaskSwitched(OS_STK* bottom) {
    Guard_place(bottom);
}

void OS_StackFault(INT8U priority) {
    (void)priority;
    Boot_fail(BOOT_STACK_OVERFLOW, 0, 0, 0);
}

U32 Board_task(void) {
    return os_kernel.running ? OSPrioCur : 255U;
}
