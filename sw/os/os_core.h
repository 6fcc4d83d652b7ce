/* SPDX-License-Identifier: MIT
 *
 * os_core: what the kernel's own files share, and the seam to a port (os_cpu). Not for
 * applications.
 */
#ifndef OS_CORE_H
#define OS_CORE_H

#include "ucos_ii.h"

/* A set of priorities: bit p of word p / 32. */
typedef struct OsSet {
    U32 word[2];
} OsSet;

typedef enum OsEventType { OS_EVENT_FREE, OS_EVENT_SEM, OS_EVENT_MUTEX, OS_EVENT_Q } OsEventType;

typedef struct OsTask {
    OS_STK *stack; /* the port's: where the context was left */
    U8 priority;   /* now; raised while the owner of a contended mutex */
    U8 base;       /* as created */
    U8 used;
    U8 timedOut;
    U32 delay;       /* ticks left, 0: none */
    OS_EVENT *event; /* what it waits for */
    void *message;   /* what OSQPost handed over */
    OS_STK *bottom;  /* lowest address of the stack; 0: not known */
    U32 words;       /* its size */
    U16 options;     /* OS_TASK_OPT_... */
} OsTask;

struct os_event {
    OsEventType type;
    U16 count;      /* semaphore: units; queue: entries */
    U16 size, head; /* queue */
    void **slots;   /* queue */
    OsTask *owner;  /* mutex */
    U8 ceiling;     /* mutex */
    OsSet waiting;
};

typedef struct OsKernel {
    OsSet ready;
    OsSet reserved; /* ceilings of mutexes: no task may have them */
    OsTask *byPriority[OS_LOWEST_PRIO + 1];
    OsTask tasks[OS_MAX_TASKS + 1];
    OS_EVENT events[OS_MAX_EVENTS];
    OsTask *current;
    U32 ticks;
    U8 running, interruptNesting, lockNesting;
} OsKernel;

extern OsKernel os_kernel;

void OsSet_add(OsSet *set, U8 priority);
void OsSet_remove(OsSet *set, U8 priority);
int OsSet_has(const OsSet *set, U8 priority);
/* Lowest number in the set; OS_LOWEST_PRIO + 1 where it is empty. */
U8 OsSet_first(const OsSet *set);

/* 1 where a task or a mutex has this priority. */
int OS_PriorityTaken(U8 priority);
/* Creates a task, with interrupts disabled; of `stack` the bounds and options are used. */
U8 OS_TaskMake(void (*task)(void *), void *argument, OS_STK *ptos, U8 priority, const OsTask *stack);
/* Switches to the highest ready task, unless in an interrupt or locked. */
void OS_Sched(void);
/* Puts the current task to sleep on an event; back when it is signalled or `timeout` ticks are
 * over. Returns 1 on time-out. Call with interrupts disabled: the state is restored and saved
 * around it. */
U8 OS_EventWait(OS_EVENT *event, U32 timeout, OS_CPU_SR *cpu_sr);
/* Makes the first waiting task ready and returns it; 0 where none waits. */
OsTask *OS_EventWake(OS_EVENT *event);
OS_EVENT *OS_EventCreate(OsEventType type);
/* Error of a pend call for an event of this type, OS_ERR_NONE where it may go on. */
U8 OS_PendError(const OS_EVENT *event, OsEventType type);
/* Gives a task another priority, wherever it is listed. */
void OS_ChangePriority(OsTask *task, U8 priority);

/* The port. */
OS_STK *OSTaskStkInit(void (*task)(void *p_arg), void *p_arg, OS_STK *ptos, INT16U opt);
void OSStartHighRdy(void);              /* first switch: to os_kernel.current */
void OSCtxSw(OsTask *from, OsTask *to); /* also from OSIntExit */
void OSTaskIdleHook(void);              /* the idle task, again and again */

#endif
