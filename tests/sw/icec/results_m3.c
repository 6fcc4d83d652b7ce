/* SPDX-License-Identifier: MIT
 *
 * results_m3: a program with several tasks for a Cortex-M3. The tasks call objects of the same
 * program through one communicator, with the vehicle's Ice_Os, and check the results of each call:
 * a string, an exception with an instance, and an instance with a sequence. An interrupt, which may
 * come at any instruction, wakes the tasks of higher priority. m3_runner.c runs this program.
 */
#include "Graph.h"
#include "os_cases.h"
#include "uav_os.h"
#include "uav_tasks.h"
#include "ucos_ii.h"

#include <string.h>

#define WORDS 1024 /* size of a task's stack, words */
/* Priorities of the tasks: two tasks that the interrupt wakes, the server, and two other tasks. */
#define WOKEN 7
#define SERVER 9
#define LOW 10

static Ice_Communicator ic;
static Ice_ObjectAdapter adapter;
static Graph_Maker maker;
static Graph_Node nodes[2]; /* the servant's */
static Graph_Leaf leaf;
static OS_STK stacks[5][WORDS];
static OS_EVENT *arrived, *go[2];
static unsigned tasks, ended;
char os_said[512];

/* ---- a transport that connects its connection 0 to its connection 1 ---- */

#define WAITING 8

static struct {
    Ice_EventKind kind;
    int connection;
    Ice_Int size;
    Ice_Byte bytes[ICE_MESSAGE_MAX];
} queue[WAITING];
static volatile unsigned first, last;
static Ice_Byte isOpen;

static void put(Ice_EventKind kind, int connection, const Ice_Byte* bytes, Ice_Int size) {
    unsigned at = last % WAITING;
    queue[at].kind = kind;
    queue[at].connection = connection;
    queue[at].size = size;
    memcpy(queue[at].bytes, bytes, (size_t)size);
    ++last;
    (void)OSSemPost(arrived);
}

static Ice_Status receive(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event) {
    INT8U error;
    unsigned at = first % WAITING;
    (void)context;
    OSSemPend(arrived, (INT32U)timeoutMs, &error);
    if (first == last)
        return ICE_OK; /* woken */
    event->kind = queue[at].kind;
    event->connection = queue[at].connection;
    event->size = queue[at].size;
    memcpy(buffer, queue[at].bytes, (size_t)queue[at].size);
    ++first;
    return ICE_OK;
}

/* Only one task sends at a time, under ICE_LOCK_SEND; connect does not hold this lock. */
static Ice_Status send(void* context, int connection, const Ice_Byte* message, Ice_Int size) {
    (void)context;
    OSSchedLock();
    put(ICE_EVENT_MESSAGE, !connection, message, size);
    OSSchedUnlock();
    return ICE_OK;
}

static Ice_Status connect(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection) {
    (void)context, (void)encoded;
    *connection = 0;
    OSSchedLock();
    if (!isOpen)
        put(ICE_EVENT_OPENED, 1, encoded, 0);
    isOpen = 1;
    OSSchedUnlock();
    return size ? ICE_OK : ICE_NO_ENDPOINT;
}

static void closeIt(void* context, int connection) {
    (void)context, (void)connection;
}

static Ice_Status listen(void* context, const char* options) {
    (void)context, (void)options;
    return ICE_OK;
}

static void encode(void* context, const char* options, Ice_OutputStreamPtr os) {
    static const Ice_Byte endpoint[8] = {0x50, 0x4C, 6, 0, 0, 0, 1, 1};
    (void)context, (void)options;
    Ice_OutputStream_writeBlob(os, endpoint, (Ice_Int)sizeof endpoint);
}

static void wakeReceiver(void* context) {
    (void)context;
    (void)OSSemPost(arrived);
}

static U32 nowMs(void* context) {
    (void)context;
    return OSTimeGet();
}

/* ---- the servant, which returns the values that it receives, and throws an exception if the id is
 * odd ---- */

Ice_Status Graph_Maker_echo(Graph_MakerPtr self, Ice_String text, Ice_String* result,
                            const Ice_Current* current) {
    (void)self, (void)current;
    *result = text;
    return ICE_OK;
}

Ice_Status Graph_Maker_make(Graph_MakerPtr self, const Graph_Node* a, const Ice_Value* b,
                            const Graph_Node** result, Graph_Maker_make_Exception* ex,
                            const Ice_Current* current) {
    static Graph_Node* all[2];
    int i;
    (void)self, (void)b, (void)current;
    if (a->id % 2) {
        ex->type = Graph_Maker_make_Failure;
        ex->u.Failure.why = a->text;
        ex->u.Failure.node = Graph_Node_cast(a);
        return ICE_USER_EXCEPTION;
    }
    Graph_Leaf_init(&leaf);
    for (i = 0; i < 2; ++i) {
        Graph_Node_init(&nodes[i]);
        nodes[i].id = a->id + i;
        all[i] = &nodes[i];
    }
    leaf.all.size = 2;
    leaf.all.data = all;
    leaf.base.id = a->id;
    *result = &leaf.base;
    return ICE_OK;
}

/* ---- the tasks that call ---- */

static void say(const char* word) {
    (void)strcat(os_said, word);
}

static void check(int isRight, const char* what) {
    if (!isRight && strlen(os_said) < sizeof os_said - 40)
        say(what);
}

/* Makes calls with values that are made of `letter`, and checks the results. */
static void call(char letter, Ice_Int id) {
    Graph_MakerPrx prx;
    Graph_Node sent, *node = 0;
    const Graph_Leaf* got;
    Graph_Maker_make_Exception ex;
    Ice_String text;
    char mine[24];
    Ice_Status status;
    memset(mine, letter, sizeof mine);
    text.data = mine;
    text.size = (Ice_Int)sizeof mine;
    (void)Ice_Communicator_stringToProxy(&ic, "maker:self", &prx);
    status = Graph_MakerPrx_echo(&prx, text, &text);
    check(status == ICE_OK && text.size == (Ice_Int)sizeof mine && text.data != mine &&
              memcmp(text.data, mine, sizeof mine) == 0,
          "string ");

    Graph_Node_init(&sent);
    sent.has_text = 1;
    sent.text.data = mine;
    sent.text.size = (Ice_Int)sizeof mine;
    sent.id = id + 1;
    status = Graph_MakerPrx_make(&prx, &sent, 0, &node, &ex);
    check(status == ICE_USER_EXCEPTION && ex.type == Graph_Maker_make_Failure &&
              memcmp(ex.u.Failure.why.data, mine, sizeof mine) == 0 && ex.u.Failure.node &&
              ex.u.Failure.node->id == id + 1,
          "exception ");

    sent.id = id;
    status = Graph_MakerPrx_make(&prx, &sent, 0, &node, &ex);
    got = Graph_Leaf_cast(node);
    check(status == ICE_OK && got && got->base.id == id && got->all.size == 2 &&
              got->all.data[0]->id == id && got->all.data[1]->id == id + 1,
          "instance ");
}

/* `p` is the number of the task. */
static void callsOnce(void* p) {
    unsigned number = (unsigned)((char*)p - os_said);
    call((char)('a' + number), (Ice_Int)(100 * number));
    if (++ended == tasks / 2) {
        say("ended ");
        __asm__ volatile("bkpt #1");
    }
    for (;;)
        OSTimeDly(1000);
}

static void callsWhenWoken(void* p) {
    unsigned number = (unsigned)((char*)p - os_said);
    INT8U error;
    for (;;) {
        OSSemPend(go[number], 0, &error);
        call((char)('A' + number), (Ice_Int)(1000 * (number + 1U)));
    }
}

static void serves(void* p) {
    (void)p;
    Ice_Communicator_waitForShutdown(&ic);
}

static void start(void (*body)(void*), INT8U priority, unsigned number) {
    static unsigned used;
    OS_STK* stack = stacks[used++];
    (void)OSTaskCreateExt(body, os_said + number, stack + WORDS - 1, priority, priority, stack,
                          WORDS, 0, OS_TASK_OPT_STK_CHK);
}

static void prepare(unsigned count) {
    static const Ice_Endpoint endpoint = {"self", receive, send,         connect, closeIt,
                                          listen, encode,  wakeReceiver, nowMs,   0};
    int c;
    tasks = count;
    UAV_initIceOs();
    arrived = OSSemCreate(0);
    for (c = 0; c < 2; ++c)
        go[c] = OSSemCreate(0);
    Ice_initialize(&ic);
    Ice_Communicator_setOs(&ic, &uav_iceOs, 0);
    Ice_Communicator_setEndpoint(&ic, &endpoint, 0);
    (void)Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "self", &adapter);
    Graph_Maker_init(&maker);
    (void)Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&maker, "maker");
    Ice_ObjectAdapter_activate(&adapter);
    start(callsOnce, LOW, 0);
    start(callsWhenWoken, WOKEN, 0);
    if (count == 4) {
        start(callsOnce, LOW + 1, 1);
        start(callsWhenWoken, WOKEN + 1, 1);
    }
    start(serves, SERVER, 0);
}

static void prepareTwo(void) {
    prepare(2);
}

static void prepareFour(void) {
    prepare(4);
}

static void interrupt(void) {
    (void)OSSemPost(go[0]);
    if (tasks == 4)
        (void)OSSemPost(go[1]);
}

const OsCase os_cases[] = {{"TwoTasks", prepareTwo, interrupt, 2000, "ended "},
                           {"FourTasks", prepareFour, interrupt, 2000, "ended "}};
const unsigned os_caseCount = 2;
