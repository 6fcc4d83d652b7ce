/* SPDX-License-Identifier: MIT
 *
 * os_cases_events: the cases about semaphores, queues, mutexes and time-outs.
 */
#include "os_cases.h"

static OS_EVENT *sem, *sem2, *mutex, *mutex2, *queue;
static void* slots[3];
static INT8U err;

/* ---- a time-out is a number of ticks ---- */

static void timesOut(void) {
    INT32U start;
    start = OSTimeGet();
    OSSemPend(sem, 7, &err);
    OsCase_sayNumber(err);
    OsCase_sayNumber((unsigned)(OSTimeGet() - start));
    start = OSTimeGet();
    OSMutexPend(mutex, 3, &err);
    OsCase_sayNumber(err);
    OsCase_sayNumber((unsigned)(OSTimeGet() - start));
    start = OSTimeGet();
    OsCase_sayNumber(OSQPend(queue, 2, &err) == 0);
    OsCase_sayNumber(err);
    OsCase_sayNumber((unsigned)(OSTimeGet() - start));
    OSTimeDly(0); /* no delay */
    OsCase_sayNumber((unsigned)(OSTimeGet() - start));
}

static void holdsMutex(void) {
    OSMutexPend(mutex, 0, &err);
}

void OsCase_timing(void) {
    sem = OSSemCreate(0);
    mutex = OSMutexCreate(3, &err);
    queue = OSQCreate(slots, 3);
    (void)OsCase_task(timesOut, 9);
    (void)OsCase_task(holdsMutex, 8);
}

/* ---- semaphores count up to 65535; of several waiting tasks, the one of highest priority gets the
 * unit ---- */

static void countsSem(void) {
    OsCase_sayNumber(OSSemAccept(sem));
    OsCase_sayNumber(OSSemAccept(sem));
    OsCase_sayNumber(OSSemAccept(sem));
    OsCase_sayNumber(OSSemPost(sem));
    OSSemPend(sem, 0, &err);
    OsCase_sayNumber(err);
    OsCase_sayNumber(OSSemPost(sem2));
    OsCase_sayNumber(OSSemPost(0));
    OsCase_sayNumber(OSSemPost(queue));
    OSSemPend(0, 0, &err);
    OsCase_sayNumber(err);
    OSSemPend(mutex, 0, &err);
    OsCase_sayNumber(err);
    OsCase_sayNumber(OSSemAccept(mutex));
}

void OsCase_counting(void) {
    sem = OSSemCreate(2);
    sem2 = OSSemCreate(65535);
    mutex = OSMutexCreate(3, &err);
    queue = OSQCreate(slots, 3);
    (void)OsCase_task(countsSem, 9);
}

static void takesUnit(void) {
    OSSemPend(sem, 0, &err);
    OsCase_sayNumber(OSPrioCur);
}

static void givesUnits(void) {
    OsCase_say("gives");
    (void)OSSemPost(sem);
    (void)OSSemPost(sem);
    (void)OSSemPost(sem);
    OsCase_say("gave");
}

void OsCase_choosing(void) {
    sem = OSSemCreate(0);
    (void)OsCase_task(takesUnit, 12);
    (void)OsCase_task(takesUnit, 7);
    (void)OsCase_task(takesUnit, 9);
    (void)OsCase_task(givesUnits, 20);
}

/* ---- queues ---- */

static char messages[4];

static void sayMessage(void* message) {
    static const char* const names[] = {"m0", "m1", "m2", "m3"};
    OsCase_say(message ? names[(char*)message - messages] : "none");
}

static void usesQueue(void) {
    int i;
    for (i = 0; i < 4; ++i)
        /* the queue has no room for the fourth message */
        OsCase_sayNumber(OSQPost(queue, &messages[i]));
    for (i = 0; i < 3; ++i)
        sayMessage(OSQPend(queue, 0, &err));
    /* the index of the next message wraps around to the start of the array */
    OsCase_sayNumber(OSQPost(queue, &messages[3]));
    sayMessage(OSQPend(queue, 1, &err));
    sayMessage(OSQPend(queue, 1, &err));
    OsCase_sayNumber(err);
    OsCase_sayNumber(OSQPost(0, &messages[0]));
    OsCase_sayNumber(OSQPost(sem, &messages[0]));
    sayMessage(OSQPend(sem, 1, &err));
    OsCase_sayNumber(err);
}

void OsCase_queueing(void) {
    queue = OSQCreate(slots, 3);
    sem = OSSemCreate(0);
    (void)OsCase_task(usesQueue, 9);
}

static void getsMessage(void) {
    void* message;
    message = OSQPend(queue, 0, &err);
    OsCase_sayNumber(OSPrioCur);
    sayMessage(message);
}

static void postsMessages(void) {
    (void)OSQPost(queue, &messages[1]);
    (void)OSQPost(queue, &messages[2]);
    OsCase_say("posted");
}

void OsCase_handingOver(void) {
    queue = OSQCreate(slots, 3);
    (void)OsCase_task(getsMessage, 12);
    (void)OsCase_task(getsMessage, 7);
    (void)OsCase_task(postsMessages, 20);
}

/* ---- priority inheritance ---- */

static void lowOwner(void) {
    OSMutexPend(mutex, 0, &err);
    OSTimeDly(2);
    OsCase_say("low-works-at");
    OsCase_sayNumber(OSPrioCur);
    (void)OSMutexPost(mutex);
    OsCase_say("low-ends-at");
    OsCase_sayNumber(OSPrioCur);
}

static void highWants(void) {
    OSTimeDly(1);
    OsCase_say("high-wants");
    OSMutexPend(mutex, 0, &err);
    OsCase_say("high-has");
    (void)OSMutexPost(mutex);
}

static void middle(void) {
    OSTimeDly(2);
    OsCase_say("middle");
}

void OsCase_inheriting(void) {
    mutex = OSMutexCreate(2, &err);
    (void)OsCase_task(lowOwner, 20);
    (void)OsCase_task(highWants, 5);
    (void)OsCase_task(middle, 10);
}

/* While the owner of the mutex inherits a priority, it waits for another event; it must also be
 * moved in the waiting list of that event. */
static void ownerWaits(void) {
    OSMutexPend(mutex, 0, &err);
    OSSemPend(sem, 0, &err);
    OsCase_say("owner");
    (void)OSMutexPost(mutex);
}

static void rivalWaits(void) {
    OSSemPend(sem, 0, &err);
    OsCase_say("rival");
}

static void wantsMutex(void) {
    OSTimeDly(1);
    OSMutexPend(mutex, 0, &err);
    OsCase_say("high-has");
    (void)OSMutexPost(mutex);
}

static void postsLate(void) {
    OSTimeDly(2);
    (void)OSSemPost(sem);
    (void)OSSemPost(sem);
}

void OsCase_inheritingInAList(void) {
    mutex = OSMutexCreate(2, &err);
    sem = OSSemCreate(0);
    (void)OsCase_task(ownerWaits, 20);
    (void)OsCase_task(rivalWaits, 10);
    (void)OsCase_task(wantsMutex, 6);
    (void)OsCase_task(postsLate, 30);
}

/* ---- mutexes: errors ---- */

static void mutexOwner(void) {
    OSMutexPend(mutex, 0, &err);
    OsCase_sayNumber(err);
    /* the ceiling priority of this mutex is lower than the priority of this task */
    OSMutexPend(mutex2, 0, &err);
    OsCase_sayNumber(err);
    OsCase_sayNumber(OSMutexPost(mutex2));
}

static void mutexStranger(void) {
    OsCase_sayNumber(OSMutexPost(mutex));
    OsCase_sayNumber(OSMutexPost(sem));
    OsCase_sayNumber(OSMutexPost(0));
    OSMutexPend(0, 0, &err);
    OsCase_sayNumber(err);
    OSMutexPend(sem, 0, &err);
    OsCase_sayNumber(err);
    (void)OSMutexCreate(3, &err); /* the mutex already has this priority */
    OsCase_sayNumber(err);
    (void)OSMutexCreate(6, &err); /* this task already has this priority */
    OsCase_sayNumber(err);
    (void)OSMutexCreate(OS_LOWEST_PRIO, &err);
    OsCase_sayNumber(err);
}

void OsCase_mutexErrors(void) {
    mutex = OSMutexCreate(3, &err);
    mutex2 = OSMutexCreate(8, &err);
    sem = OSSemCreate(0);
    (void)OsCase_task(mutexOwner, 5);
    (void)OsCase_task(mutexStranger, 6);
}
