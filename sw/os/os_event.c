/* SPDX-License-Identifier: MIT
 *
 * os_event: semaphores, mutexes with priority ceiling, message queues.
 */
#include "os_core.h"

OS_EVENT* OSSemCreate(INT16U cnt) {
    OS_EVENT* event = OS_EventCreate(OS_EVENT_SEM);
    if (event)
        event->count = cnt;
    return event;
}

void OSSemPend(OS_EVENT* pevent, INT32U timeout, INT8U* perr) {
    OS_CPU_SR cpu_sr;
    *perr = OS_PendError(pevent, OS_EVENT_SEM);
    if (*perr != OS_ERR_NONE)
        return;
    OS_ENTER_CRITICAL();
    if (pevent->count)
        --pevent->count;
    else if (OS_EventWait(pevent, timeout, &cpu_sr))
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
    if (!OS_EventWake(pevent)) {
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
    event = OS_EventCreate(OS_EVENT_MUTEX);
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
    *perr = OS_PendError(pevent, OS_EVENT_MUTEX);
    if (*perr != OS_ERR_NONE)
        return;
    OS_ENTER_CRITICAL();
    if (!pevent->owner) {
        pevent->owner = self;
        if (self->priority <= pevent->ceiling)
            *perr = OS_ERR_PIP_LOWER; /* owned all the same, as in uC/OS-II */
    } else {
        OS_Task* owner = pevent->owner;
        if (owner->priority > self->priority && owner->priority > pevent->ceiling)
            OS_ChangePriority(owner, pevent->ceiling);
        if (OS_EventWait(pevent, timeout, &cpu_sr))
            *perr = OS_ERR_TIMEOUT;
    }
    OS_EXIT_CRITICAL();
}

INT8U OSMutexPost(OS_EVENT* pevent) {
    OS_CPU_SR cpu_sr;
    OS_Task* self = os_kernel.current;
    U8 priority = self->priority;
    int mayRun; /* another task: one that waited, or now that this one has its own priority again */
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
    pevent->owner = OS_EventWake(pevent);
    mayRun = pevent->owner || self->priority != priority;
    OS_EXIT_CRITICAL();
    if (mayRun)
        OS_Sched();
    return OS_ERR_NONE;
}

OS_EVENT* OSQCreate(void** start, INT16U size) {
    OS_EVENT* event = OS_EventCreate(OS_EVENT_Q);
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
    *perr = OS_PendError(pevent, OS_EVENT_Q);
    if (*perr != OS_ERR_NONE)
        return 0;
    OS_ENTER_CRITICAL();
    if (pevent->count) {
        message = pevent->slots[pevent->head];
        pevent->head = (U16)((pevent->head + 1U) % pevent->size);
        --pevent->count;
    } else if (OS_EventWait(pevent, timeout, &cpu_sr)) {
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
    task = OS_EventWake(pevent);
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
