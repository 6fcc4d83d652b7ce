/* SPDX-License-Identifier: MIT
 *
 * os_cases_tasks: creation, preemption, delays, the scheduler's lock, stacks, registers,
 * interrupts.
 */
#include "os_cases_private.h"

static OS_EVENT *sem2, *mutex, *queue;
static void* slots[3];
static INT8U err;

/* ---- a post lets the task of higher priority go on at once ---- */

static void postsSem(void) {
    OsCase_say("low-posts");
    OsCase_sayNumber(OSSemPost(osCase_sem));
    OsCase_say("low-ends");
}

void OsCase_preempting(void) {
    osCase_sem = OSSemCreate(0);
    (void)OsCase_task(postsSem, 10);
    (void)OsCase_task(OsCase_waitsForSem, 5);
}

/* ---- a task that creates one of higher priority is preempted by it ---- */

static void creates(void) {
    OsCase_say("creates");
    OsCase_sayNumber(OsCase_task(OsCase_created, 4));
    OsCase_sayNumber(OsCase_task(OsCase_created, 4)); /* the priority is taken */
    OsCase_say("goes-on");
    OsCase_sayNumber(OsCase_task(OsCase_created, 20));
    OsCase_say("ends");
}

void OsCase_creating(void) {
    (void)OsCase_task(creates, 8);
}

/* ---- the scheduler's lock ---- */

static void locks(void) {
    OSSchedLock();
    OSSchedLock();
    (void)OSSemPost(osCase_sem);
    OSSemPend(sem2, 1, &err);
    OsCase_sayNumber(err);
    OSTimeDly(5);
    Runner_interrupt();
    OSSchedUnlock();
    OsCase_say("still-locked");
    OSSchedUnlock();
    OsCase_say("ends");
}

void OsCase_locking(void) {
    osCase_sem = OSSemCreate(0);
    sem2 = OSSemCreate(0);
    (void)OsCase_task(OsCase_waitsForSem, 5);
    (void)OsCase_task(locks, 6);
}

/* ---- delays, and who runs when they end ---- */

static void pulses(void) {
    int i;
    for (i = 0; i < 3; ++i) {
        OsCase_sayNumber(OSPrioCur);
        OSTimeDly(OSPrioCur == 9 ? 2U : 3U);
    }
}

void OsCase_delaying(void) {
    (void)OsCase_task(pulses, 10);
    (void)OsCase_task(pulses, 9);
}

/* ---- stacks ---- */

static void looksAtStacks(void) {
    OS_STK_DATA data;
    OsCase_sayNumber(OSTaskStkChk(9, &data));
    OsCase_sayNumber(data.OSFree + data.OSUsed);
    OsCase_sayNumber(OSTaskStkChk(33, &data)); /* nobody */
    OsCase_sayNumber(OSTaskStkChk(3, &data));  /* a mutex */
    OsCase_sayNumber(OSTaskStkChk(9, 0));
    OsCase_sayNumber(OSTaskStkChk(12, &data)); /* created without the option */
    OsCase_sayNumber(OSTaskStkChk(OS_LOWEST_PRIO + 1, &data));
}

void OsCase_stackChecking(void) {
    mutex = OSMutexCreate(3, &err);
    (void)OsCase_task(looksAtStacks, 9);
    (void)OsCase_uncheckedTask(OsCase_created, 12);
}

/* ---- interrupts and critical sections ---- */

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

/* ---- a computation that needs all registers, and a task that may come in between anywhere ---- */

static unsigned scramble(unsigned a) {
    unsigned b = 3, c = 5, d = 7, e = 11, f = 13, g = 17, h = 19, j = 23, k = 29, l = 31, i;
    for (i = 0; i < 12U; ++i) {
        a += b ^ c;
        b = (b << 3 | b >> 29) + d;
        c ^= e * 2654435761U;
        d += f - g;
        e = (e << 7 | e >> 25) ^ h;
        f += a;
        g ^= b + c;
        h += d ^ i;
        j ^= h + k;
        k += l ^ a;
        l = (l << 11 | l >> 21) + j;
    }
    return a ^ b ^ c ^ d ^ e ^ f ^ g ^ h ^ j ^ k ^ l;
}

static unsigned disturbances;

static void computes(void) {
    OsCase_sayNumber(scramble(1));
}

static void disturbs(void) {
    for (;;) {
        OSSemPend(osCase_sem, 0, &err);
        disturbances += scramble(disturbances);
    }
}

void OsCase_postsFromInterrupt(void) {
    (void)OSSemPost(osCase_sem);
}

void OsCase_computing(void) {
    osCase_sem = OSSemCreate(0);
    (void)OsCase_task(computes, 10);
    (void)OsCase_task(disturbs, 5);
}
