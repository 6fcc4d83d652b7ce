/* SPDX-License-Identifier: MIT
 *
 * os_cases_mutex: mutexes: inheritance and errors.
 */
#include "os_cases_private.h"

static OS_EVENT *sem, *mutex, *mutex2;
static INT8U err;

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

/* The owner waits for something else while it inherits: it is moved in that list, too. */
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
    OSMutexPend(mutex2, 0, &err); /* its ceiling is below this task's priority */
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
    (void)OSMutexCreate(3, &err); /* taken by the mutex */
    OsCase_sayNumber(err);
    (void)OSMutexCreate(6, &err); /* by this task */
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
