/* SPDX-License-Identifier: MIT
 *
 * os_cases_private: shared by the files of cases: tasks that print their steps.
 */
#ifndef OS_CASES_PRIVATE_H
#define OS_CASES_PRIVATE_H

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
void OsCase_choosing(void);
void OsCase_computing(void);
void OsCase_counting(void);
void OsCase_creating(void);
void OsCase_delaying(void);
void OsCase_handingOver(void);
void OsCase_inheriting(void);
void OsCase_inheritingInAList(void);
void OsCase_interruptRoutine(void);
void OsCase_interrupting(void);
void OsCase_locking(void);
void OsCase_masking(void);
void OsCase_mutexErrors(void);
void OsCase_postsFromInterrupt(void);
void OsCase_preempting(void);
void OsCase_queueing(void);
void OsCase_saysIrq(void);
void OsCase_stackChecking(void);
void OsCase_timing(void);

#endif
