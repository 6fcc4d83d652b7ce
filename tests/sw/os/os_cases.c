/* SPDX-License-Identifier: MIT
 *
 * os_cases: the list of cases, and their output.
 */
#include "os_cases_private.h"

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

/* `p`: the task's body, which may return. */
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
