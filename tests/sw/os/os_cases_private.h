/* SPDX-License-Identifier: MIT
 *
 * os_cases_private: shared by the files of cases: tasks that print their steps.
 */
#pragma once

#include "os_cases.h"

#define OS_CASE_WORDS 128 /* of a task's stack */

void OsCase_say(const char* word);
void OsCase_sayNumber(unsigned value);
/* Creates a task on a stack of its own, with its priority as its number. Returns OSTaskCreateExt's
 * result. */
INT8U OsCase_task(void (*body)(void), INT8U priority);
INT8U OsCase_uncheckedTask(void (*body)(void), INT8U priority); /* without the stack's options */

/* Tasks of several cases. */
extern OS_EVENT* osCase_sem;
void OsCase_waitsForSem(void);
void OsCase_created(void);

/* Prepare a case, or are its interrupt routine. */
/* clang-format off */
#define OS_CASES(X) \
    X(choosing) X(computing) X(counting) X(creating) X(delaying) X(handingOver) X(inheriting) \
    X(inheritingInAList) X(interruptRoutine) X(interrupting) X(locking) X(masking) X(mutexErrors) \
    X(postsFromInterrupt) X(preempting) X(queueing) X(saysIrq) X(stackChecking) X(timing)
/* clang-format on */
#define OS_CASE_DECLARED(name) void OsCase_##name(void);
OS_CASES(OS_CASE_DECLARED)
