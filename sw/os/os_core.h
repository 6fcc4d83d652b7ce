/* SPDX-License-Identifier: MIT
 *
 * os_core: declarations that the files of the kernel and of the processor port (os_cpu) share.
 * Applications must not use them.
 */
#pragma once

#include "ucos_ii.h"

/* A set of priorities: priority p is bit p % 32 of word p / 32. */
typedef struct OS_Set {
    U32 word[2];
} OS_Set;

typedef enum OS_EventType { OS_EVENT_FREE, OS_EVENT_SEM, OS_EVENT_MUTEX, OS_EVENT_Q } OS_EventType;

typedef struct OS_Task {
    OS_STK* stack; /* stack pointer of the saved context, for the port */
    /* current priority; raised while the task owns a mutex for which a task of higher priority
     * waits */
    U8 priority;
    U8 base; /* priority at creation */
    U8 used;
    U8 timedOut;
    U32 delay;       /* remaining ticks; 0 means no delay */
    OS_EVENT* event; /* event for which the task waits */
    void* message;   /* message from OSQPost */
    OS_STK* bottom;  /* lowest address of the stack; 0 if unknown */
    U32 words;       /* size of the stack, words */
    U16 options;     /* OS_TASK_OPT_... */
} OS_Task;

struct os_event {
    OS_EventType type;
    U16 count;      /* semaphore: number of units; queue: number of entries */
    U16 size, head; /* queue */
    void** slots;   /* queue */
    OS_Task* owner; /* mutex */
    U8 ceiling;     /* mutex */
    OS_Set waiting;
};

typedef struct OS_Kernel {
    OS_Set ready;
    OS_Set reserved; /* priorities that are ceilings of mutexes; tasks cannot have them */
    OS_Task* byPriority[OS_LOWEST_PRIO + 1];
    OS_Task tasks[OS_MAX_TASKS + 1];
    OS_EVENT events[OS_MAX_EVENTS];
    OS_Task* current;
    U32 ticks;
    U8 running, interruptNesting, lockNesting;
} OS_Kernel;

extern OS_Kernel os_kernel;

/* Number of the lowest bit that is set in `bits`, which is not 0. */
#define OS_LOWEST_BIT(bits) ((U32)__builtin_ctz(bits))

/* Operations on sets. */
#define OS_SET_WORD(set, priority) ((set)->word[(priority) >> 5])
#define OS_SET_BIT(priority) (1U << (priority) % 32U)
#define OS_SET_ADD(set, priority) (OS_SET_WORD(set, priority) |= OS_SET_BIT(priority))
#define OS_SET_REMOVE(set, priority) (OS_SET_WORD(set, priority) &= ~OS_SET_BIT(priority))
#define OS_SET_HAS(set, priority) ((OS_SET_WORD(set, priority) & OS_SET_BIT(priority)) != 0)
/* Returns the lowest number in the set, or OS_LOWEST_PRIO + 1 if the set is empty. */
U8 OS_Set_first(const OS_Set* set);

/* Whether tasks wait for an event. */
#define OS_IS_WAITED(event) (((event)->waiting.word[0] | (event)->waiting.word[1]) != 0)
/* Suspends the current task until the event is signalled or `timeout` ticks have passed. Returns 1
 * after a time-out. Interrupts must be disabled; the function ends the critical section, which has
 * saved `cpu_sr`. */
U8 OS_EventWait(OS_EVENT* event, U32 timeout, OS_CPU_SR cpu_sr);
/* Makes that task ready which has the highest priority of the tasks that wait for the event, and
 * returns this task. At least one task must wait. Interrupts must be disabled. */
OS_Task* OS_EventWake(OS_EVENT* event);

/* The parts of OSMutexPend and OSMutexPost for a mutex for which a task waits. They are separate
 * functions, so that the usual case saves no registers. Interrupts must be disabled; the functions
 * end the critical section, which has saved `cpu_sr`. */

/* Waits until the owner has released the mutex; raises the owner's priority if necessary. */
void OS_MutexWait(OS_EVENT* event, U32 timeout, U8* error, OS_CPU_SR cpu_sr);
/* Restores the priority of the current task, which owns the mutex, and passes the mutex to the next
 * task that waits for it. Returns OS_ERR_NONE. */
U8 OS_MutexPass(OS_EVENT* event, OS_CPU_SR cpu_sr);

/* Returns 1 if a task or a mutex has this priority. */
int OS_PriorityTaken(U8 priority);
/* Creates a task with the given entry, stack bounds and options. Interrupts must be disabled.
 * Returns OS_ERR_NONE or OS_ERR_TASK_NO_MORE_TCB. */
U8 OS_TaskMake(void (*task)(void*), void* argument, OS_STK* ptos, U8 priority,
               const OS_Task* stack);
/* Switches to the ready task with the highest priority; in an interrupt, or if the scheduler is
 * locked, does nothing. */
void OS_Sched(void);
/* Changes the priority of a task in all sets and lists. */
void OS_ChangePriority(OS_Task* task, U8 priority);

/* Functions that the processor port defines. */
OS_STK* OSTaskStkInit(void (*task)(void* p_arg), void* p_arg, OS_STK* ptos, INT16U opt);
void OSStartHighRdy(void);                /* switches to the first task, os_kernel.current */
void OSCtxSw(OS_Task* from, OS_Task* to); /* also called by OSIntExit */
void OSTaskIdleHook(void);                /* called repeatedly by the idle task */
