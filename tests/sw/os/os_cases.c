/* SPDX-License-Identifier: MIT
 *
 * os_cases: tasks that say what they do.
 */
#include "os_cases.h"

#define STACKS 6
#define WORDS 128

char os_said[512];

static OS_STK stacks[STACKS][WORDS];
static unsigned stacksUsed;
static OS_EVENT *sem, *sem2, *mutex, *mutex2, *queue;
static void *slots[3];
static INT8U err;

static void begin(void) {
    os_said[0] = 0;
    stacksUsed = 0;
}

static void say(const char *word) {
    unsigned at = 0;
    while (os_said[at])
        ++at;
    while (*word && at < sizeof os_said - 2)
        os_said[at++] = *word++;
    os_said[at++] = ' ';
    os_said[at] = 0;
}

static void sayNumber(unsigned value) {
    char digits[12];
    unsigned at = sizeof digits - 1;
    digits[at] = 0;
    do {
        digits[--at] = (char)('0' + value % 10U);
        value /= 10U;
    } while (value);
    say(digits + at);
}

static INT8U task(void (*body)(void *), INT8U priority) {
    OS_STK *stack = stacks[stacksUsed++];
    return OSTaskCreateExt(body, 0, &stack[WORDS - 1], priority, priority, stack, WORDS, 0,
                           OS_TASK_OPT_STK_CHK | OS_TASK_OPT_STK_CLR);
}

static void end(void) {
    for (;;)
        OSTimeDly(1000);
}

/* ---- a post lets the task of higher priority go on at once ---- */

static void waitsForSem(void *p) {
    (void)p;
    say("high-waits");
    OSSemPend(sem, 0, &err);
    say("high-goes");
    end();
}

static void postsSem(void *p) {
    (void)p;
    say("low-posts");
    sayNumber(OSSemPost(sem));
    say("low-ends");
    end();
}

static void preempting(void) {
    begin();
    sem = OSSemCreate(0);
    (void)task(postsSem, 10);
    (void)task(waitsForSem, 5);
}

/* ---- a task that creates one of higher priority is preempted by it ---- */

static void created(void *p) {
    (void)p;
    say("created");
    end();
}

static void creates(void *p) {
    (void)p;
    say("creates");
    sayNumber(task(created, 4));
    sayNumber(task(created, 4)); /* the priority is taken */
    say("goes-on");
    sayNumber(task(created, 20));
    say("ends");
    end();
}

static void creating(void) {
    begin();
    (void)task(creates, 8);
}

/* ---- time-outs count ticks ---- */

static void timesOut(void *p) {
    INT32U start;
    (void)p;
    start = OSTimeGet();
    OSSemPend(sem, 7, &err);
    sayNumber(err);
    sayNumber((unsigned)(OSTimeGet() - start));
    start = OSTimeGet();
    OSMutexPend(mutex, 3, &err);
    sayNumber(err);
    sayNumber((unsigned)(OSTimeGet() - start));
    start = OSTimeGet();
    sayNumber(OSQPend(queue, 2, &err) == 0);
    sayNumber(err);
    sayNumber((unsigned)(OSTimeGet() - start));
    OSTimeDly(0); /* no delay */
    sayNumber((unsigned)(OSTimeGet() - start));
    end();
}

static void holdsMutex(void *p) {
    (void)p;
    OSMutexPend(mutex, 0, &err);
    end();
}

static void timing(void) {
    begin();
    sem = OSSemCreate(0);
    mutex = OSMutexCreate(3, &err);
    queue = OSQCreate(slots, 3);
    (void)task(timesOut, 9);
    (void)task(holdsMutex, 8);
}

/* ---- semaphores count to 65535; of several tasks the highest gets the unit ---- */

static void countsSem(void *p) {
    (void)p;
    sayNumber(OSSemAccept(sem));
    sayNumber(OSSemAccept(sem));
    sayNumber(OSSemAccept(sem));
    sayNumber(OSSemPost(sem));
    OSSemPend(sem, 0, &err);
    sayNumber(err);
    sayNumber(OSSemPost(sem2));
    sayNumber(OSSemPost(0));
    sayNumber(OSSemPost(queue));
    OSSemPend(0, 0, &err);
    sayNumber(err);
    OSSemPend(mutex, 0, &err);
    sayNumber(err);
    sayNumber(OSSemAccept(mutex));
    end();
}

static void counting(void) {
    begin();
    sem = OSSemCreate(2);
    sem2 = OSSemCreate(65535);
    mutex = OSMutexCreate(3, &err);
    queue = OSQCreate(slots, 3);
    (void)task(countsSem, 9);
}

static void takesUnit(void *p) {
    (void)p;
    OSSemPend(sem, 0, &err);
    sayNumber(OSPrioCur);
    end();
}

static void givesUnits(void *p) {
    (void)p;
    say("gives");
    (void)OSSemPost(sem);
    (void)OSSemPost(sem);
    (void)OSSemPost(sem);
    say("gave");
    end();
}

static void choosing(void) {
    begin();
    sem = OSSemCreate(0);
    (void)task(takesUnit, 12);
    (void)task(takesUnit, 7);
    (void)task(takesUnit, 9);
    (void)task(givesUnits, 20);
}

/* ---- priority inheritance ---- */

static void lowOwner(void *p) {
    (void)p;
    OSMutexPend(mutex, 0, &err);
    OSTimeDly(2);
    say("low-works-at");
    sayNumber(OSPrioCur);
    (void)OSMutexPost(mutex);
    say("low-ends-at");
    sayNumber(OSPrioCur);
    end();
}

static void highWants(void *p) {
    (void)p;
    OSTimeDly(1);
    say("high-wants");
    OSMutexPend(mutex, 0, &err);
    say("high-has");
    (void)OSMutexPost(mutex);
    end();
}

static void middle(void *p) {
    (void)p;
    OSTimeDly(2);
    say("middle");
    end();
}

static void inheriting(void) {
    begin();
    mutex = OSMutexCreate(2, &err);
    (void)task(lowOwner, 20);
    (void)task(highWants, 5);
    (void)task(middle, 10);
}

/* The owner waits for something else while it inherits: it is moved in that list, too. */
static void ownerWaits(void *p) {
    (void)p;
    OSMutexPend(mutex, 0, &err);
    OSSemPend(sem, 0, &err);
    say("owner");
    (void)OSMutexPost(mutex);
    end();
}

static void rivalWaits(void *p) {
    (void)p;
    OSSemPend(sem, 0, &err);
    say("rival");
    end();
}

static void wantsMutex(void *p) {
    (void)p;
    OSTimeDly(1);
    OSMutexPend(mutex, 0, &err);
    say("high-has");
    (void)OSMutexPost(mutex);
    end();
}

static void postsLate(void *p) {
    (void)p;
    OSTimeDly(2);
    (void)OSSemPost(sem);
    (void)OSSemPost(sem);
    end();
}

static void inheritingInAList(void) {
    begin();
    mutex = OSMutexCreate(2, &err);
    sem = OSSemCreate(0);
    (void)task(ownerWaits, 20);
    (void)task(rivalWaits, 10);
    (void)task(wantsMutex, 6);
    (void)task(postsLate, 30);
}

/* ---- mutexes: errors ---- */

static void mutexOwner(void *p) {
    (void)p;
    OSMutexPend(mutex, 0, &err);
    sayNumber(err);
    OSMutexPend(mutex2, 0, &err); /* its ceiling is below this task's priority */
    sayNumber(err);
    sayNumber(OSMutexPost(mutex2));
    end();
}

static void mutexStranger(void *p) {
    (void)p;
    sayNumber(OSMutexPost(mutex));
    sayNumber(OSMutexPost(sem));
    sayNumber(OSMutexPost(0));
    OSMutexPend(0, 0, &err);
    sayNumber(err);
    OSMutexPend(sem, 0, &err);
    sayNumber(err);
    (void)OSMutexCreate(3, &err); /* taken by the mutex */
    sayNumber(err);
    (void)OSMutexCreate(6, &err); /* by this task */
    sayNumber(err);
    (void)OSMutexCreate(OS_LOWEST_PRIO, &err);
    sayNumber(err);
    end();
}

static void mutexErrors(void) {
    begin();
    mutex = OSMutexCreate(3, &err);
    mutex2 = OSMutexCreate(8, &err);
    sem = OSSemCreate(0);
    (void)task(mutexOwner, 5);
    (void)task(mutexStranger, 6);
}

/* ---- queues ---- */

static char messages[4];

static void sayMessage(void *message) {
    static const char *const names[] = {"m0", "m1", "m2", "m3"};
    say(message ? names[(char *)message - messages] : "none");
}

static void usesQueue(void *p) {
    int i;
    (void)p;
    for (i = 0; i < 4; ++i)
        sayNumber(OSQPost(queue, &messages[i])); /* the fourth does not fit */
    for (i = 0; i < 3; ++i)
        sayMessage(OSQPend(queue, 0, &err));
    sayNumber(OSQPost(queue, &messages[3])); /* around the end of the array */
    sayMessage(OSQPend(queue, 1, &err));
    sayMessage(OSQPend(queue, 1, &err));
    sayNumber(err);
    sayNumber(OSQPost(0, &messages[0]));
    sayNumber(OSQPost(sem, &messages[0]));
    sayMessage(OSQPend(sem, 1, &err));
    sayNumber(err);
    end();
}

static void queueing(void) {
    begin();
    queue = OSQCreate(slots, 3);
    sem = OSSemCreate(0);
    (void)task(usesQueue, 9);
}

static void getsMessage(void *p) {
    void *message;
    (void)p;
    message = OSQPend(queue, 0, &err);
    sayNumber(OSPrioCur);
    sayMessage(message);
    end();
}

static void postsMessages(void *p) {
    (void)p;
    (void)OSQPost(queue, &messages[1]);
    (void)OSQPost(queue, &messages[2]);
    say("posted");
    end();
}

static void handingOver(void) {
    begin();
    queue = OSQCreate(slots, 3);
    (void)task(getsMessage, 12);
    (void)task(getsMessage, 7);
    (void)task(postsMessages, 20);
}

/* ---- interrupts ---- */

static void interruptRoutine(void) {
    INT8U e;
    OSSemPend(sem, 0, &e);
    sayNumber(e);
    OSMutexPend(mutex, 0, &e);
    sayNumber(e);
    (void)OSQPend(queue, 0, &e);
    sayNumber(e);
    sayNumber(task(created, 30));
    --stacksUsed;
    sayNumber(OSSemCreate(0) == 0);
    (void)OSMutexCreate(4, &e);
    sayNumber(e);
    OSTimeDly(5);
    (void)OSSemPost(sem);
    say("irq");
}

static void interrupted(void *p) {
    (void)p;
    say("background");
    Runner_interrupt();
    say("ends");
    end();
}

static void interrupting(void) {
    begin();
    sem = OSSemCreate(0);
    mutex = OSMutexCreate(3, &err);
    queue = OSQCreate(slots, 3);
    (void)task(waitsForSem, 5);
    (void)task(interrupted, 6);
}

static void saysIrq(void) {
    say("irq");
}

static void disablesInterrupts(void *p) {
    OS_CPU_SR cpu_sr;
    (void)p;
    OS_ENTER_CRITICAL();
    Runner_interrupt();
    say("critical");
    OS_EXIT_CRITICAL();
    Runner_passTime();
    say("after");
    end();
}

static void masking(void) {
    begin();
    (void)task(disablesInterrupts, 6);
}

/* ---- the scheduler's lock ---- */

static void locks(void *p) {
    (void)p;
    OSSchedLock();
    OSSchedLock();
    (void)OSSemPost(sem);
    OSSemPend(sem2, 1, &err);
    sayNumber(err);
    OSTimeDly(5);
    Runner_interrupt();
    OSSchedUnlock();
    say("still-locked");
    OSSchedUnlock();
    say("ends");
    end();
}

static void locking(void) {
    begin();
    sem = OSSemCreate(0);
    sem2 = OSSemCreate(0);
    (void)task(waitsForSem, 5);
    (void)task(locks, 6);
}

/* ---- delays, and who runs when they end ---- */

static void pulses(void *p) {
    int i;
    (void)p;
    for (i = 0; i < 3; ++i) {
        sayNumber(OSPrioCur);
        OSTimeDly(OSPrioCur == 9 ? 2U : 3U);
    }
    end();
}

static void delaying(void) {
    begin();
    (void)task(pulses, 10);
    (void)task(pulses, 9);
}

/* ---- stacks ---- */

static void looksAtStacks(void *p) {
    OS_STK_DATA data;
    (void)p;
    sayNumber(OSTaskStkChk(9, &data));
    sayNumber(data.OSFree + data.OSUsed);
    sayNumber(OSTaskStkChk(33, &data)); /* nobody */
    sayNumber(OSTaskStkChk(3, &data));  /* a mutex */
    sayNumber(OSTaskStkChk(9, 0));
    sayNumber(OSTaskStkChk(12, &data)); /* created without the option */
    sayNumber(OSTaskStkChk(OS_LOWEST_PRIO + 1, &data));
    end();
}

static void stackChecking(void) {
    begin();
    mutex = OSMutexCreate(3, &err);
    (void)task(looksAtStacks, 9);
    (void)OSTaskCreate(created, 0, &stacks[STACKS - 1][WORDS - 1], 12);
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

static void computes(void *p) {
    (void)p;
    sayNumber(scramble(1));
    end();
}

static void disturbs(void *p) {
    (void)p;
    for (;;) {
        OSSemPend(sem, 0, &err);
        disturbances += scramble(disturbances);
    }
}

static void postsFromInterrupt(void) {
    (void)OSSemPost(sem);
}

static void computing(void) {
    begin();
    sem = OSSemCreate(0);
    (void)task(computes, 10);
    (void)task(disturbs, 5);
}

const OsCase os_cases[] = {
    {"APostLetsTheHigherTaskGoOnAtOnce", preempting, 0, 4, "high-waits low-posts high-goes 0 low-ends "},
    {"ACreatedTaskOfHigherPriorityRunsAtOnce", creating, 0, 4,
     "creates created 0 40 goes-on 0 ends created "},
    {"TimeOutsCountTicks", timing, 0, 20, "10 7 10 3 1 10 2 2 "},
    {"SemaphoresCountAndRefuse", counting, 0, 4, "2 1 0 0 0 51 4 1 4 1 0 "},
    {"TheHighestTaskGetsTheUnit", choosing, 0, 4, "gives 7 9 12 gave "},
    {"AnOwnerInheritsTheCeiling", inheriting, 0, 10,
     "high-wants low-works-at 2 high-has middle low-ends-at 20 "},
    {"AnOwnerInheritsInTheListWhereItWaits", inheritingInAList, 0, 10, "owner high-has rival "},
    {"MutexErrors", mutexErrors, 0, 4, "0 120 0 100 1 4 4 1 40 40 42 "},
    {"QueuesKeepOrderAndReportFull", queueing, 0, 8, "0 0 0 30 m0 m1 m2 0 m3 none 10 4 1 none 1 "},
    {"AMessageGoesToTheHighestTask", handingOver, 0, 4, "7 m1 12 m2 posted "},
    {"InterruptsMayPostAndNotWait", interrupting, interruptRoutine, 4,
     "high-waits background 2 2 2 60 1 16 irq high-goes ends "},
    {"CriticalSectionsHoldInterruptsBack", masking, saysIrq, 4, "critical irq after "},
    {"ALockedSchedulerDoesNotSwitch", locking, saysIrq, 4,
     "high-waits 13 irq still-locked high-goes ends "},
    {"DelaysEndInOrderOfPriority", delaying, 0, 12, "9 10 9 10 9 10 "},
    {"RegistersSurviveSwitches", computing, postsFromInterrupt, 2, "3828057899 "},
    {"StacksAreChecked", stackChecking, 0, 4, "0 128 67 67 9 69 42 created "},
};
const unsigned os_caseCount = sizeof os_cases / sizeof os_cases[0];
