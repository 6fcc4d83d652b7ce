/* SPDX-License-Identifier: MIT
 *
 * os_cases: the list of all cases, the functions that record their output, and the cases about
 * creation, preemption, delays, the scheduler's lock, stacks, registers and interrupts.
 */
#include "os_cases.h"

#define STACKS 6

char os_said[512];

static OS_STK stacks[STACKS][OS_CASE_WORDS];
static void (*bodies[STACKS])(void);
static unsigned stacksUsed;
OS_EVENT* osCase_sem;

void OsCase_begin(void) {
    os_said[0] = 0;
    stacksUsed = 0;
}

void OsCase_say(const char* word) {
    unsigned at = 0;
    while (os_said[at])
        ++at;
    while (*word && at < sizeof os_said - 2)
        os_said[at++] = *word++;
    os_said[at++] = ' ';
    os_said[at] = 0;
}

void OsCase_sayNumber(unsigned value) {
    char digits[12];
    unsigned at = sizeof digits - 1;
    digits[at] = 0;
    do {
        digits[--at] = (char)('0' + value % 10U);
        value /= 10U;
    } while (value);
    OsCase_say(digits + at);
}

/* `p` is the body of the task; the body may return. */
static void runs(void* p) {
    (*(void (**)(void))p)();
    for (;;)
        OSTimeDly(1000);
}

INT8U OsCase_task(void (*body)(void), INT8U priority) {
    OS_STK* stack = stacks[stacksUsed];
    INT8U error;
    bodies[stacksUsed] = body;
    error =
        OSTaskCreateExt(runs, &bodies[stacksUsed], stack + OS_CASE_WORDS - 1, priority, priority,
                        stack, OS_CASE_WORDS, 0, OS_TASK_OPT_STK_CHK | OS_TASK_OPT_STK_CLR);
    stacksUsed += error == OS_ERR_NONE;
    return error;
}

INT8U OsCase_uncheckedTask(void (*body)(void), INT8U priority) {
    OS_STK* stack = stacks[stacksUsed];
    bodies[stacksUsed] = body;
    return OSTaskCreate(runs, &bodies[stacksUsed++], stack + OS_CASE_WORDS - 1, priority);
}

void OsCase_waitsForSem(void) {
    INT8U error;
    OsCase_say("high-waits");
    OSSemPend(osCase_sem, 0, &error);
    OsCase_say("high-goes");
}

void OsCase_created(void) {
    OsCase_say("created");
}

static OS_EVENT *sem2, *mutex, *queue;
static void* slots[3];
static INT8U err;

/* ---- a post makes a waiting task of higher priority run at once ---- */

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

/* ---- if a task creates a task of higher priority, the new task runs at once ---- */

static void creates(void) {
    OsCase_say("creates");
    OsCase_sayNumber(OsCase_task(OsCase_created, 4));
    OsCase_sayNumber(OsCase_task(OsCase_created, 4)); /* another task already has this priority */
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

/* ---- delays, and which task runs when they end ---- */

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
    OsCase_sayNumber(OSTaskStkChk(33, &data)); /* no task */
    OsCase_sayNumber(OSTaskStkChk(3, &data));  /* a mutex */
    OsCase_sayNumber(OSTaskStkChk(9, 0));
    OsCase_sayNumber(OSTaskStkChk(12, &data)); /* this task was created without the option */
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

/* ---- a computation that uses all registers, and a task that may interrupt it anywhere ---- */

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

const OsCase os_cases[] = {
    {"APostLetsTheHigherTaskGoOnAtOnce", OsCase_preempting, 0, 4,
     "high-waits low-posts high-goes 0 low-ends "},
    {"ACreatedTaskOfHigherPriorityRunsAtOnce", OsCase_creating, 0, 4,
     "creates created 0 40 goes-on 0 ends created "},
    {"TimeOutsCountTicks", OsCase_timing, 0, 20, "10 7 10 3 1 10 2 2 "},
    {"SemaphoresCountAndRefuse", OsCase_counting, 0, 4, "2 1 0 0 0 51 4 1 4 1 0 "},
    {"TheHighestTaskGetsTheUnit", OsCase_choosing, 0, 4, "gives 7 9 12 gave "},
    {"AnOwnerInheritsTheCeiling", OsCase_inheriting, 0, 10,
     "high-wants low-works-at 2 high-has middle low-ends-at 20 "},
    {"AnOwnerInheritsInTheListWhereItWaits", OsCase_inheritingInAList, 0, 10,
     "owner high-has rival "},
    {"MutexErrors", OsCase_mutexErrors, 0, 4, "0 120 0 100 1 4 4 1 40 40 42 "},
    {"QueuesKeepOrderAndReportFull", OsCase_queueing, 0, 8,
     "0 0 0 30 m0 m1 m2 0 m3 none 10 4 1 none 1 "},
    {"AMessageGoesToTheHighestTask", OsCase_handingOver, 0, 4, "7 m1 12 m2 posted "},
    {"InterruptsMayPostAndNotWait", OsCase_interrupting, OsCase_interruptRoutine, 4,
     "high-waits background 2 2 5 2 60 1 16 irq high-goes ends "},
    {"CriticalSectionsHoldInterruptsBack", OsCase_masking, OsCase_saysIrq, 4,
     "critical irq after "},
    {"ALockedSchedulerDoesNotSwitch", OsCase_locking, OsCase_saysIrq, 4,
     "high-waits 13 irq still-locked high-goes ends "},
    {"DelaysEndInOrderOfPriority", OsCase_delaying, 0, 12, "9 10 9 10 9 10 "},
    {"RegistersSurviveSwitches", OsCase_computing, OsCase_postsFromInterrupt, 2, "3828057899 "},
    {"StacksAreChecked", OsCase_stackChecking, 0, 4, "0 128 67 67 9 69 42 created "},
};
const unsigned os_caseCount = sizeof os_cases / sizeof os_cases[0];
