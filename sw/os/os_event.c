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
    if (pevent->count) {
        --pevent->count;
        OS_EXIT_CRITICAL();
    } else if (OS_EventWait(pevent, timeout, cpu_sr)) {
        *perr = OS_ERR_TIMEOUT;
    }
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
    if (OS_IS_WAITED(pevent)) {
        (void)OS_EventWake(pevent);
        OS_EXIT_CRITICAL();
        OS_Sched();
        return OS_ERR_NONE;
    }
    if (pevent->count < 65535U)
        ++pevent->count;
    else
        error = OS_ERR_SEM_OVF;
    OS_EXIT_CRITICAL();
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
        OS_SET_ADD(&os_kernel.reserved, prio);
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
    if (pevent->owner) {
        OS_MutexWait(pevent, timeout, perr, cpu_sr);
        return;
    }
    pevent->owner = self;
    if (self->priority <= pevent->ceiling)
        /* as in uC/OS-II, the task owns the mutex although this is an error */
        *perr = OS_ERR_PIP_LOWER;
    OS_EXIT_CRITICAL();
}

INT8U OSMutexPost(OS_EVENT* pevent) {
    OS_CPU_SR cpu_sr;
    OS_Task* self = os_kernel.current;
    if (os_kernel.interruptNesting)
        return OS_ERR_POST_ISR;
    if (!pevent)
        return OS_ERR_PEVENT_NULL;
    if (pevent->type != OS_EVENT_MUTEX)
        return OS_ERR_EVENT_TYPE;
    if (pevent->owner != self)
        return OS_ERR_NOT_MUTEX_OWNER;
    OS_ENTER_CRITICAL();
    /* The usual case: no task has waited for the mutex, so the priority was not raised. */
    if (OS_IS_WAITED(pevent) || self->priority != self->base)
        return OS_MutexPass(pevent, cpu_sr);
    pevent->owner = 0;
    OS_EXIT_CRITICAL();
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
        OS_EXIT_CRITICAL();
    } else if (OS_EventWait(pevent, timeout, cpu_sr)) {
        *perr = OS_ERR_TIMEOUT;
    } else {
        message = os_kernel.current->message;
    }
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
    if (OS_IS_WAITED(pevent)) {
        task = OS_EventWake(pevent);
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
