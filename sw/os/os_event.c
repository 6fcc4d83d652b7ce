/* SPDX-License-Identifier: MIT
 *
 * os_event: semaphores, mutexes with priority ceiling, message queues.
 */
#include "os_core.h"

/* Allocates an event. Returns 0 if all events are in use, or in an interrupt. */
static OS_EVENT* create(OS_EventType type) {
    OS_CPU_SR cpu_sr;
    OS_EVENT* found = 0;
    U32 i;
    if (os_kernel.interruptNesting)
        return 0;
    OS_ENTER_CRITICAL();
    for (i = 0; i < OS_MAX_EVENTS && !found; ++i)
        if (os_kernel.events[i].type == OS_EVENT_FREE)
            found = &os_kernel.events[i];
    if (found)
        found->type = type;
    OS_EXIT_CRITICAL();
    return found;
}

/* Checks whether a task may wait for an event of this type. Returns OS_ERR_NONE, or the error for
 * the caller. */
static U8 pendError(const OS_EVENT* event, OS_EventType type) {
    if (!event)
        return OS_ERR_PEVENT_NULL;
    if (event->type != type)
        return OS_ERR_EVENT_TYPE;
    if (os_kernel.interruptNesting)
        return OS_ERR_PEND_ISR;
    return os_kernel.lockNesting ? OS_ERR_PEND_LOCKED : OS_ERR_NONE;
}

/* Suspends the current task until the event is signalled or `timeout` ticks have passed. Returns 1
 * after a time-out. Interrupts must be disabled before the call and are disabled after it; they are
 * enabled while the task waits. */
static U8 waitFor(OS_EVENT* event, U32 timeout, OS_CPU_SR* cpu_sr) {
    OS_Task* task = os_kernel.current;
    task->event = event;
    task->timedOut = 0;
    task->delay = timeout;
    OS_Set_remove(&os_kernel.ready, task->priority);
    OS_Set_add(&event->waiting, task->priority);
    OS_CPU_SR_Restore(*cpu_sr);
    OS_Sched();
    *cpu_sr = OS_CPU_SR_Save();
    return task->timedOut;
}

/* Of the tasks that wait for the event, makes the task with the highest priority ready, and returns
 * this task. Returns 0 if no task waits. */
static OS_Task* wake(OS_EVENT* event) {
    U8 priority;
    OS_Task* task;
    if (!(event->waiting.word[0] | event->waiting.word[1]))
        return 0;
    priority = OS_Set_first(&event->waiting);
    task = os_kernel.byPriority[priority];
    OS_Set_remove(&event->waiting, priority);
    task->event = 0;
    task->delay = 0;
    OS_Set_add(&os_kernel.ready, priority);
    return task;
}

OS_EVENT* OSSemCreate(INT16U cnt) {
    OS_EVENT* event = create(OS_EVENT_SEM);
    if (event)
        event->count = cnt;
    return event;
}

void OSSemPend(OS_EVENT* pevent, INT32U timeout, INT8U* perr) {
    OS_CPU_SR cpu_sr;
    *perr = pendError(pevent, OS_EVENT_SEM);
    if (*perr != OS_ERR_NONE)
        return;
    OS_ENTER_CRITICAL();
    if (pevent->count)
        --pevent->count;
    else if (waitFor(pevent, timeout, &cpu_sr))
        *perr = OS_ERR_TIMEOUT;
    OS_EXIT_CRITICAL();
}

INT16U OSSemAccept(OS_EVENT* pevent) {
    OS_CPU_SR cpu_sr;
    INT16U count = 0;
    if (!pevent || pevent->type != OS_EVENT_SEM)
        return 0;
    OS_ENTER_CRITICAL();
    if (pevent->count)
        count = pevent->count--;
    OS_EXIT_CRITICAL();
    return count;
}

INT8U OSSemPost(OS_EVENT* pevent) {
    OS_CPU_SR cpu_sr;
    INT8U error = OS_ERR_NONE;
    if (!pevent)
        return OS_ERR_PEVENT_NULL;
    if (pevent->type != OS_EVENT_SEM)
        return OS_ERR_EVENT_TYPE;
    OS_ENTER_CRITICAL();
    if (!wake(pevent)) {
        if (pevent->count < 65535U)
            ++pevent->count;
        else
            error = OS_ERR_SEM_OVF;
    }
    OS_EXIT_CRITICAL();
    OS_Sched();
    return error;
}

OS_EVENT* OSMutexCreate(INT8U prio, INT8U* perr) {
    OS_EVENT* event;
    if (os_kernel.interruptNesting) {
        *perr = OS_ERR_CREATE_ISR;
        return 0;
    }
    if (prio >= OS_LOWEST_PRIO) {
        *perr = OS_ERR_PRIO_INVALID;
        return 0;
    }
    if (OS_PriorityTaken(prio)) {
        *perr = OS_ERR_PRIO_EXIST;
        return 0;
    }
    event = create(OS_EVENT_MUTEX);
    *perr = event ? OS_ERR_NONE : OS_ERR_PEVENT_NULL;
    if (event) {
        event->ceiling = prio;
        OS_Set_add(&os_kernel.reserved, prio);
    }
    return event;
}

void OSMutexPend(OS_EVENT* pevent, INT32U timeout, INT8U* perr) {
    OS_CPU_SR cpu_sr;
    OS_Task* self = os_kernel.current;
    *perr = pendError(pevent, OS_EVENT_MUTEX);
    if (*perr != OS_ERR_NONE)
        return;
    OS_ENTER_CRITICAL();
    if (!pevent->owner) {
        pevent->owner = self;
        if (self->priority <= pevent->ceiling)
            /* as in uC/OS-II, the task owns the mutex although this is an error */
            *perr = OS_ERR_PIP_LOWER;
    } else {
        OS_Task* owner = pevent->owner;
        if (owner->priority > self->priority && owner->priority > pevent->ceiling)
            OS_ChangePriority(owner, pevent->ceiling);
        if (waitFor(pevent, timeout, &cpu_sr))
            *perr = OS_ERR_TIMEOUT;
    }
    OS_EXIT_CRITICAL();
}

INT8U OSMutexPost(OS_EVENT* pevent) {
    OS_CPU_SR cpu_sr;
    OS_Task* self = os_kernel.current;
    U8 priority = self->priority;
    /* 1 if another task may have to run: a task that has waited for the mutex, or a task that could
     * not run while the priority was raised */
    int mayRun;
    if (os_kernel.interruptNesting)
        return OS_ERR_POST_ISR;
    if (!pevent)
        return OS_ERR_PEVENT_NULL;
    if (pevent->type != OS_EVENT_MUTEX)
        return OS_ERR_EVENT_TYPE;
    if (pevent->owner != self)
        return OS_ERR_NOT_MUTEX_OWNER;
    OS_ENTER_CRITICAL();
    if (self->priority == pevent->ceiling && self->priority != self->base)
        OS_ChangePriority(self, self->base);
    pevent->owner = wake(pevent);
    mayRun = pevent->owner || self->priority != priority;
    OS_EXIT_CRITICAL();
    if (mayRun)
        OS_Sched();
    return OS_ERR_NONE;
}

OS_EVENT* OSQCreate(void** start, INT16U size) {
    OS_EVENT* event = create(OS_EVENT_Q);
    if (event) {
        event->slots = start;
        event->size = size;
        event->count = event->head = 0;
    }
    return event;
}

void* OSQPend(OS_EVENT* pevent, INT32U timeout, INT8U* perr) {
    OS_CPU_SR cpu_sr;
    void* message = 0;
    *perr = pendError(pevent, OS_EVENT_Q);
    if (*perr != OS_ERR_NONE)
        return 0;
    OS_ENTER_CRITICAL();
    if (pevent->count) {
        message = pevent->slots[pevent->head];
        pevent->head = (U16)((pevent->head + 1U) % pevent->size);
        --pevent->count;
    } else if (waitFor(pevent, timeout, &cpu_sr)) {
        *perr = OS_ERR_TIMEOUT;
    } else {
        message = os_kernel.current->message;
    }
    OS_EXIT_CRITICAL();
    return message;
}

INT8U OSQPost(OS_EVENT* pevent, void* pmsg) {
    OS_CPU_SR cpu_sr;
    INT8U error = OS_ERR_NONE;
    OS_Task* task;
    if (!pevent)
        return OS_ERR_PEVENT_NULL;
    if (pevent->type != OS_EVENT_Q)
        return OS_ERR_EVENT_TYPE;
    OS_ENTER_CRITICAL();
    task = wake(pevent);
    if (task) {
        task->message = pmsg;
    } else if (pevent->count < pevent->size) {
        pevent->slots[(pevent->head + pevent->count) % pevent->size] = pmsg;
        ++pevent->count;
    } else {
        error = OS_ERR_Q_FULL;
    }
    OS_EXIT_CRITICAL();
    OS_Sched();
    return error;
}
