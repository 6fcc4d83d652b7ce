/* SPDX-License-Identifier: MIT
 *
 * os_core: scheduler, time and interrupts of the kernel, which is preemptive with fixed priorities.
 */
#include "os_core.h"

OS_Kernel os_kernel;
INT8U OSPrioCur;

void OS_Set_add(OS_Set* set, U8 priority) {
    set->word[priority >> 5] |= 1U << (priority & 31U);
}

void OS_Set_remove(OS_Set* set, U8 priority) {
    set->word[priority >> 5] &= ~(1U << (priority & 31U));
}

int OS_Set_has(const OS_Set* set, U8 priority) {
    return (int)(set->word[priority >> 5] >> (priority & 31U) & 1U);
}

int OS_PriorityTaken(U8 priority) {
    return os_kernel.byPriority[priority] != 0 || OS_Set_has(&os_kernel.reserved, priority);
}

U8 OS_Set_first(const OS_Set* set) {
    /* Returns the number of the lowest set bit. A de Bruijn sequence is used: the upper five bits
     * of the product are different for each of the 32 bits. */
    static const U8 place[32] = {0,  1,  28, 2,  29, 14, 24, 3, 30, 22, 20, 15, 25, 17, 4,  8,
                                 31, 27, 13, 23, 21, 19, 16, 7, 26, 12, 18, 6,  11, 5,  10, 9};
    U32 n = set->word[0] ? 0U : 32U, bits = set->word[n >> 5];
    if (bits == 0)
        return OS_LOWEST_PRIO + 1U;
    return (U8)(n + place[((bits & (0U - bits)) * 0x077CB531U) >> 27]);
}

/* Switches to the ready task with the highest priority. Interrupts must be disabled. */
static void switchToFirst(void) {
    OS_Task* from = os_kernel.current;
    OS_Task* to = os_kernel.byPriority[OS_Set_first(&os_kernel.ready)];
    if (to != from) {
        os_kernel.current = to;
        OSPrioCur = to->priority;
        OSCtxSw(from, to);
    }
}

void OS_Sched(void) {
    OS_CPU_SR cpu_sr;
    OS_ENTER_CRITICAL();
    if (os_kernel.running && !os_kernel.interruptNesting && !os_kernel.lockNesting)
        switchToFirst();
    OS_EXIT_CRITICAL();
}

void OSSchedLock(void) {
    OS_CPU_SR cpu_sr;
    OS_ENTER_CRITICAL();
    if (os_kernel.running && !os_kernel.interruptNesting && os_kernel.lockNesting < 255U)
        ++os_kernel.lockNesting;
    OS_EXIT_CRITICAL();
}

void OSSchedUnlock(void) {
    OS_CPU_SR cpu_sr;
    OS_ENTER_CRITICAL();
    if (os_kernel.lockNesting && !os_kernel.interruptNesting)
        --os_kernel.lockNesting;
    OS_EXIT_CRITICAL();
    OS_Sched();
}

void OSIntEnter(void) {
    if (os_kernel.running && os_kernel.interruptNesting < 255U)
        ++os_kernel.interruptNesting;
}

void OSIntExit(void) {
    if (os_kernel.interruptNesting)
        --os_kernel.interruptNesting;
    OS_Sched();
}

void OSTimeDly(INT32U ticks) {
    OS_CPU_SR cpu_sr;
    if (os_kernel.interruptNesting || os_kernel.lockNesting || ticks == 0)
        return;
    OS_ENTER_CRITICAL();
    os_kernel.current->delay = ticks;
    OS_Set_remove(&os_kernel.ready, os_kernel.current->priority);
    OS_EXIT_CRITICAL();
    OS_Sched();
}

INT32U OSTimeGet(void) {
    OS_CPU_SR cpu_sr;
    INT32U ticks;
    OS_ENTER_CRITICAL();
    ticks = os_kernel.ticks;
    OS_EXIT_CRITICAL();
    return ticks;
}

/* Makes a task ready when its delay or time-out has expired. If it waits for an event, ends this
 * wait. */
static void expire(OS_Task* task) {
    if (task->event) {
        OS_Set_remove(&task->event->waiting, task->priority);
        task->event = 0;
        task->timedOut = 1;
    }
    OS_Set_add(&os_kernel.ready, task->priority);
}

void OSTimeTick(void) {
    OS_CPU_SR cpu_sr;
    U32 i;
    OS_ENTER_CRITICAL();
    ++os_kernel.ticks;
    for (i = 0; i <= OS_MAX_TASKS; ++i) {
        OS_Task* task = &os_kernel.tasks[i];
        if (task->used && task->delay && --task->delay == 0)
            expire(task);
    }
    OS_EXIT_CRITICAL();
}

static void moveInSet(OS_Set* set, U8 from, U8 to) {
    if (OS_Set_has(set, from)) {
        OS_Set_remove(set, from);
        OS_Set_add(set, to);
    }
}

void OS_ChangePriority(OS_Task* task, U8 priority) {
    U8 old = task->priority;
    moveInSet(&os_kernel.ready, old, priority);
    if (task->event)
        moveInSet(&task->event->waiting, old, priority);
    os_kernel.byPriority[old] = 0;
    os_kernel.byPriority[priority] = task;
    task->priority = priority;
    if (task == os_kernel.current)
        OSPrioCur = priority;
}
