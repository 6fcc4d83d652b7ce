/* SPDX-License-Identifier: MIT
 *
 * os_cases_interrupts: interrupt routines and critical sections.
 */
#include "os_cases_private.h"

static OS_EVENT *mutex, *queue;
static void* slots[3];
static INT8U err;

/* ---- interrupts ---- */

void OsCase_interruptRoutine(void) {
    INT8U e;
    OSSemPend(osCase_sem, 0, &e);
    OsCase_sayNumber(e);
    OSMutexPend(mutex, 0, &e);
    OsCase_sayNumber(e);
    OsCase_sayNumber(OSMutexPost(mutex));
    (void)OSQPend(queue, 0, &e);
    OsCase_sayNumber(e);
    OsCase_sayNumber(OsCase_task(OsCase_created, 30));
    OsCase_sayNumber(OSSemCreate(0) == 0);
    (void)OSMutexCreate(4, &e);
    OsCase_sayNumber(e);
    OSTimeDly(5);
    (void)OSSemPost(osCase_sem);
    OsCase_say("irq");
}

static void interrupted(void) {
    OsCase_say("background");
    Runner_interrupt();
    OsCase_say("ends");
}

void OsCase_interrupting(void) {
    osCase_sem = OSSemCreate(0);
    mutex = OSMutexCreate(3, &err);
    queue = OSQCreate(slots, 3);
    (void)OsCase_task(OsCase_waitsForSem, 5);
    (void)OsCase_task(interrupted, 6);
}

void OsCase_saysIrq(void) {
    OsCase_say("irq");
}

static void disablesInterrupts(void) {
    OS_CPU_SR cpu_sr;
    OS_ENTER_CRITICAL();
    Runner_interrupt();
    OsCase_say("critical");
    OS_EXIT_CRITICAL();
    Runner_passTime();
    OsCase_say("after");
}

void OsCase_masking(void) {
    (void)OsCase_task(disablesInterrupts, 6);
}
