/* SPDX-License-Identifier: MIT
 *
 * os_start: starts the kernel and its idle task. It is separate from os_core, because os_core must
 * not depend on os_task.
 */
#include "os_core.h"

#define IDLE_WORDS 128U

static OS_STK idleStack[IDLE_WORDS];

static void idleTask(void* argument) {
    (void)argument;
    for (;;)
        OSTaskIdleHook();
}

void OSInit(void) {
    static const OS_Kernel empty;
    OS_Task stack;
    os_kernel = empty;
    stack.bottom = idleStack;
    stack.words = IDLE_WORDS;
    stack.options = OS_TASK_OPT_STK_CHK | OS_TASK_OPT_STK_CLR;
    (void)OS_TaskMake(idleTask, 0, idleStack + IDLE_WORDS - 1, OS_LOWEST_PRIO, &stack);
}

void OSStart(void) {
    if (os_kernel.running)
        return;
    os_kernel.running = 1;
    os_kernel.current = os_kernel.byPriority[OS_Set_first(&os_kernel.ready)];
    OSPrioCur = os_kernel.current->priority;
    OSStartHighRdy();
}
