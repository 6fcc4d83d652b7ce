/* SPDX-License-Identifier: MIT
 *
 * own_hooks: our kernel's hooks in the runner.
 */
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
    __asm__ volatile("bkpt #3");
}
