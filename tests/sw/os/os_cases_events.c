/* SPDX-License-Identifier: MIT
 *
 * os_cases_events: semaphores, queues and time-outs.
 */
#include "os_cases_private.h"

static OS_EVENT *sem, *sem2, *mutex, *queue;
static void* slots[3];
static INT8U err;

/* ---- time-outs count ticks ---- */

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

/* ---- semaphores count to 65535; of several tasks the highest gets the unit ---- */

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
        OsCase_sayNumber(OSQPost(queue, &messages[i])); /* the fourth does not fit */
    for (i = 0; i < 3; ++i)
        sayMessage(OSQPend(queue, 0, &err));
    OsCase_sayNumber(OSQPost(queue, &messages[3])); /* around the end of the array */
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
