/* SPDX-License-Identifier: MIT
 *
 * os_cases: programs that use uC/OS-II's API, with the output that its manual implies
 * ("MicroC/OS-II, The Real-Time Kernel", chapter 16). They run on the host's port, on the
 * Cortex-M3's, and on request on the real uC/OS-II, with one expected text.
 */
#pragma once

#include "ucos_ii.h"

typedef struct OsCase {
    const char* name;
    void (*prepare)(void); /* function that prepares the case, called between OSInit and OSStart */
    void (*interrupt)(void); /* interrupt routine, called between OSIntEnter and OSIntExit; or 0 */
    unsigned ticks;          /* length of the case, ticks */
    const char* expected;    /* the expected output */
} OsCase;

extern const OsCase os_cases[];
extern const unsigned os_caseCount;
extern char os_said[512]; /* output of the last case */

void OsCase_begin(void); /* before `prepare`: clears output and stacks */
/* Makes an interrupt arrive now; implemented by the runner. */
void Runner_interrupt(void);
/* Serves an interrupt that has become possible (a real processor does so at once); implemented by
 * the runner. */
void Runner_passTime(void);

/* Shared by the files of cases: tasks that print their steps. */
#define OS_CASE_WORDS 128 /* size of a task's stack */

void OsCase_say(const char* word);
void OsCase_sayNumber(unsigned value);
/* Creates a task on a separate stack, with its priority as its number. Returns the result of
 * OSTaskCreateExt. */
INT8U OsCase_task(void (*body)(void), INT8U priority);
INT8U OsCase_uncheckedTask(void (*body)(void), INT8U priority); /* without the stack's options */

/* Tasks of several cases. */
extern OS_EVENT* osCase_sem;
void OsCase_waitsForSem(void);
void OsCase_created(void);

/* Functions that prepare a case, or serve as its interrupt routine. */
/* clang-format off */
#define OS_CASES(X) \
    X(choosing) X(computing) X(counting) X(creating) X(delaying) X(handingOver) X(inheriting) \
    X(inheritingInAList) X(interruptRoutine) X(interrupting) X(locking) X(masking) X(mutexErrors) \
    X(postsFromInterrupt) X(preempting) X(queueing) X(saysIrq) X(stackChecking) X(timing)
/* clang-format on */
#define OS_CASE_DECLARED(name) void OsCase_##name(void);
OS_CASES(OS_CASE_DECLARED)
