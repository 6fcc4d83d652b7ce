/* SPDX-License-Identifier: MIT
 *
 * os_cases: programs that use the API of uC/OS-II, each with the output that uC/OS-II's manual
 * implies ("MicroC/OS-II, The Real-Time Kernel", chapter 16). They run on the kernel's port for the
 * host, on its port for the Cortex-M3, and on request on the real uC/OS-II; the expected output is
 * always the same.
 */
#pragma once

#include "ucos_ii.h"

typedef struct OsCase {
    const char* name;
    void (*prepare)(void); /* function that prepares the case; called between OSInit and OSStart */
    /* interrupt routine of the case, called between OSIntEnter and OSIntExit; 0 if the case has
     * none */
    void (*interrupt)(void);
    unsigned ticks;       /* duration of the case, ticks */
    const char* expected; /* the expected output */
} OsCase;

extern const OsCase os_cases[];
extern const unsigned os_caseCount;
extern char os_said[512]; /* output of the last case */

void OsCase_begin(void); /* clears output and stacks; called before `prepare` */
/* Causes an interrupt now; implemented by the runner. */
void Runner_interrupt(void);
/* Handles an interrupt that was blocked and is now allowed. A real processor handles it by itself.
 * Implemented by the runner. */
void Runner_passTime(void);

/* Used in the files of cases: tasks that print their steps. */
#define OS_CASE_WORDS 128 /* size of a task's stack */

void OsCase_say(const char* word);
void OsCase_sayNumber(unsigned value);
/* Creates a task with a separate stack; the task's number equals its priority. Returns the result
 * of OSTaskCreateExt. */
INT8U OsCase_task(void (*body)(void), INT8U priority);
/* creates a task without the options for its stack */
INT8U OsCase_uncheckedTask(void (*body)(void), INT8U priority);

/* A semaphore and tasks that several cases use. */
extern OS_EVENT* osCase_sem;
void OsCase_waitsForSem(void);
void OsCase_created(void);

/* Declares the functions that prepare the cases, and the cases' interrupt routines. */
/* clang-format off */
#define OS_CASES(X) \
    X(choosing) X(computing) X(counting) X(creating) X(delaying) X(handingOver) X(inheriting) \
    X(inheritingInAList) X(interruptRoutine) X(interrupting) X(locking) X(masking) X(mutexErrors) \
    X(postsFromInterrupt) X(preempting) X(queueing) X(saysIrq) X(stackChecking) X(timing)
/* clang-format on */
#define OS_CASE_DECLARED(name) void OsCase_##name(void);
OS_CASES(OS_CASE_DECLARED)
