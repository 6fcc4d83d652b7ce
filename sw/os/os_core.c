/* SPDX-License-Identifier: MIT
 *
 * os_core: scheduler, time and interrupts of the kernel, which is preemptive with fixed priorities.
 */
#include "os_core.h"

OS_Kernel os_kernel;
INT8U OSPrioCur;

int OS_PriorityTaken(U8 priority) {
    return os_kernel.byPriority[priority] != 0 || OS_SET_HAS(&os_kernel.reserved, priority);
}

U8 OS_Set_first(const OS_Set* set) {
    U32 n = set->word[0] ? 0U : 32U;
    U32 bits = set->word[n >> 5];
    return (U8)(bits ? n + OS_LOWEST_BIT(bits) : OS_LOWEST_PRIO + 1U);
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

U8 OS_EventWait(OS_EVENT* event, U32 timeout, OS_CPU_SR cpu_sr) {
    OS_Task* task = os_kernel.current;
    task->event = event;
    task->timedOut = 0;
    task->delay = timeout;
    OS_SET_REMOVE(&os_kernel.ready, task->priority);
    OS_SET_ADD(&event->waiting, task->priority);
    OS_EXIT_CRITICAL();
    OS_Sched();
    return task->timedOut;
}

OS_Task* OS_EventWake(OS_EVENT* event) {
    U8 priority = OS_Set_first(&event->waiting);
    OS_Task* task = os_kernel.byPriority[priority];
    OS_SET_REMOVE(&event->waiting, priority);
    task->event = 0;
    task->delay = 0;
    OS_SET_ADD(&os_kernel.ready, priority);
    return task;
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
    OS_SET_REMOVE(&os_kernel.ready, os_kernel.current->priority);
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
        OS_SET_REMOVE(&task->event->waiting, task->priority);
        task->event = 0;
        task->timedOut = 1;
    }
    OS_SET_ADD(&os_kernel.ready, task->priority);
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
    if (OS_SET_HAS(set, from)) {
        OS_SET_REMOVE(set, from);
        OS_SET_ADD(set, to);
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

void OS_MutexWait(OS_EVENT* event, U32 timeout, U8* error, OS_CPU_SR cpu_sr) {
    OS_Task* owner = event->owner;
    if (owner->priority > os_kernel.current->priority && owner->priority > event->ceiling)
        OS_ChangePriority(owner, event->ceiling);
    if (OS_EventWait(event, timeout, cpu_sr))
        *error = OS_ERR_TIMEOUT;
}

U8 OS_MutexPass(OS_EVENT* event, OS_CPU_SR cpu_sr) {
    OS_Task* self = os_kernel.current;
    if (self->priority == event->ceiling && self->priority != self->base)
        OS_ChangePriority(self, self->base);
    event->owner = OS_IS_WAITED(event) ? OS_EventWake(event) : 0;
    OS_EXIT_CRITICAL();
    OS_Sched();
    return OS_ERR_NONE;
}
