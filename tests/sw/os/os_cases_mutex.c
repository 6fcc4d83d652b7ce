/* SPDX-License-Identifier: MIT
 *
 * os_cases_mutex: mutexes: inheritance and errors.
 */
#include "os_cases_private.h"

static OS_EVENT *sem, *mutex, *mutex2;
static INT8U err;

/* ---- priority inheritance ---- */

static void lowOwner(void* p) {
    (void)p;
    OSMutexPend(mutex, 0, &err);
    OSTimeDly(2);
    OsCase_say("low-works-at");
    OsCase_sayNumber(OSPrioCur);
    (void)OSMutexPost(mutex);
    OsCase_say("low-ends-at");
    OsCase_sayNumber(OSPrioCur);
    OsCase_end();
}

static void highWants(void* p) {
    (void)p;
    OSTimeDly(1);
    OsCase_say("high-wants");
    OSMutexPend(mutex, 0, &err);
    OsCase_say("high-has");
    (void)OSMutexPost(mutex);
    OsCase_end();
}

static void middle(void* p) {
    (void)p;
    OSTimeDly(2);
    OsCase_say("middle");
    OsCase_end();
}

void OsCase_inheriting(void) {
    OsCase_begin();
    mutex = OSMutexCreate(2, &err);
    (void)OsCase_task(lowOwner, 20);
    (void)OsCase_task(highWants, 5);
    (void)OsCase_task(middle, 10);
}

/* The owner waits for something else while it inherits: it is moved in that list, too. */
static void ownerWaits(void* p) {
    (void)p;
    OSMutexPend(mutex, 0, &err);
    OSSemPend(sem, 0, &err);
    OsCase_say("owner");
    (void)OSMutexPost(mutex);
    OsCase_end();
}

static void rivalWaits(void* p) {
    (void)p;
    OSSemPend(sem, 0, &err);
    OsCase_say("rival");
    OsCase_end();
}

static void wantsMutex(void* p) {
    (void)p;
    OSTimeDly(1);
    OSMutexPend(mutex, 0, &err);
    OsCase_say("high-has");
    (void)OSMutexPost(mutex);
    OsCase_end();
}

static void postsLate(void* p) {
    (void)p;
    OSTimeDly(2);
    (void)OSSemPost(sem);
    (void)OSSemPost(sem);
    OsCase_end();
}

void OsCase_inheritingInAList(void) {
    OsCase_begin();
    mutex = OSMutexCreate(2, &err);
    sem = OSSemCreate(0);
    (void)OsCase_task(ownerWaits, 20);
    (void)OsCase_task(rivalWaits, 10);
    (void)OsCase_task(wantsMutex, 6);
    (void)OsCase_task(postsLate, 30);
}

/* ---- mutexes: errors ---- */

static void mutexOwner(void* p) {
    (void)p;
    OSMutexPend(mutex, 0, &err);
    OsCase_sayNumber(err);
    OSMutexPend(mutex2, 0, &err); /* its ceiling is below this task's priority */
    OsCase_sayNumber(err);
    OsCase_sayNumber(OSMutexPost(mutex2));
    OsCase_end();
}

static void mutexStranger(void* p) {
    (void)p;
    OsCase_sayNumber(OSMutexPost(mutex));
    OsCase_sayNumber(OSMutexPost(sem));
    OsCase_sayNumber(OSMutexPost(0));
    OSMutexPend(0, 0, &err);
    OsCase_sayNumber(err);
    OSMutexPend(sem, 0, &err);
    OsCase_sayNumber(err);
    (void)OSMutexCreate(3, &err); /* taken by the mutex */
    OsCase_sayNumber(err);
    (void)OSMutexCreate(6, &err); /* by this task */
    OsCase_sayNumber(err);
    (void)OSMutexCreate(OS_LOWEST_PRIO, &err);
    OsCase_sayNumber(err);
    OsCase_end();
}

void OsCase_mutexErrors(void) {
    OsCase_begin();
    mutex = OSMutexCreate(3, &err);
    mutex2 = OSMutexCreate(8, &err);
    sem = OSSemCreate(0);
    (void)OsCase_task(mutexOwner, 5);
    (void)OsCase_task(mutexStranger, 6);
}
