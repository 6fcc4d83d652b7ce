/* SPDX-License-Identifier: MIT
 *
 * freertos: serves and calls Ice objects from several tasks of FreeRTOS. Messages pass through the
 * link layer on a serial port.
 *
 * Three structs of functions adapt the libraries to FreeRTOS: Ice_Os for the tasks that use IceC,
 * Link_Port for the radio (here the serial port), and XBeeATEndpoint_Port between IceC and the task
 * that owns the link.
 */
#include "icec_radio.h"
#include "meter.h"
#include "mps2.h"

#include "FreeRTOS.h"
#include "semphr.h"
#include "task.h"

#define BYTE_TIME_US16 1440U /* 111,111 baud */
#define OWN_ADDRESS 1

enum { RADIO, SERVER, CALLER, TASKS }; /* numbers of the tasks */
#define STACK_WORDS 2048U

static Ice_Communicator ic; /* large: not on a stack */
static Link radio;
static Link_Buffers buffers;
static XBeeATEndpoint endpoint;
static TaskHandle_t tasks[TASKS];

static TickType_t ticksOf(Ice_Int ms) {
    return ms <= 0 ? 0 : pdMS_TO_TICKS((TickType_t)ms);
}

/* ---- Ice_Os: two locks, and a binary semaphore for each call and for waiting servers ---- */

static SemaphoreHandle_t locks[2]; /* indexed by ICE_LOCK_STATE and ICE_LOCK_SEND */
static SemaphoreHandle_t slots[ICE_CALLS + 1];

static void lockIce(void* context, int which) {
    (void)context;
    (void)xSemaphoreTake(locks[which], portMAX_DELAY);
}

static void unlockIce(void* context, int which) {
    (void)context;
    (void)xSemaphoreGive(locks[which]);
}

/* Waits for a wake. Ice_Os requires that a wake which precedes the wait is not lost; a semaphore
 * has this property. */
static int waitSlot(void* context, int slot, Ice_Int timeoutMs) {
    (void)context;
    return xSemaphoreTake(slots[slot], ticksOf(timeoutMs)) == pdTRUE;
}

static void wakeSlot(void* context, int slot) {
    (void)context;
    (void)xSemaphoreGive(slots[slot]);
}

static int taskNumber(void* context) {
    TaskHandle_t self = xTaskGetCurrentTaskHandle();
    int task;
    (void)context;
    for (task = 0; task < TASKS - 1; ++task)
        if (tasks[task] == self)
            break;
    return task;
}

static const Ice_Os iceOs = {lockIce, unlockIce, waitSlot, wakeSlot, taskNumber};

/* ---- Link_Port ---- */

static U32 nowUs(void) {
    return (U32)xTaskGetTickCount() * (1000000U / configTICK_RATE_HZ);
}

static int transmit(void* context, const U8* frame, U32 size) {
    (void)context;
    return Mps2_send(frame, size);
}

/* Returns a pseudo-random number, which is sufficient for an example. A link with keys needs a true
 * random source here. */
static U32 randomWord(void* context) {
    static U32 state = 0x9E3779B9U;
    (void)context;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state + (U32)xTaskGetTickCount();
}

static void onState(void* context, Link_State state) {
    (void)context;
    (void)state;
}

static const Link_Port linkPort = {
    transmit, randomWord, XBeeATEndpoint_onMessage, XBeeATEndpoint_onChannel, onState, 0, 0};
static const Link_Config linkConfig = {&linkPort, &endpoint, BYTE_TIME_US16, LINK_USE(buffers)};

/* ---- XBeeATEndpoint_Port: a lock around the link, and two signals ---- */

static SemaphoreHandle_t linkLock, endpointEvent;

static void lockLink(void* context) {
    (void)context;
    (void)xSemaphoreTake(linkLock, portMAX_DELAY);
}

static void unlockLink(void* context) {
    (void)context;
    (void)xSemaphoreGive(linkLock);
}

static void kick(void* context) {
    (void)context;
    (void)xTaskNotifyGive(tasks[RADIO]);
}

static int waitEvent(void* context, Ice_Int timeoutMs) {
    (void)context;
    return xSemaphoreTake(endpointEvent, ticksOf(timeoutMs)) == pdTRUE;
}

static void signalEvent(void* context) {
    (void)context;
    (void)xSemaphoreGive(endpointEvent);
}

static U32 nowMs(void* context) {
    (void)context;
    return (U32)xTaskGetTickCount() * (1000U / configTICK_RATE_HZ);
}

static const XBeeATEndpoint_Port endpointPort = {lockLink,  unlockLink,  kick,
                                                 waitEvent, signalEvent, nowMs};

/* ---- tasks ---- */

void Mps2_onReceive(void) {
    BaseType_t higher = pdFALSE;
    vTaskNotifyGiveFromISR(tasks[RADIO], &higher);
    portYIELD_FROM_ISR(higher);
}

/* Runs the link: passes received bytes to the link, and polls the link when it has work that is
 * due. */
static void radioTask(void* argument) {
    (void)argument;
    Mps2_start();
    lockLink(0);
    Link_start(&radio, nowUs());
    unlockLink(0);
    for (;;) {
        U8 bytes[64];
        U32 size, wait;
        lockLink(0);
        size = Mps2_read(bytes, sizeof(bytes));
        if (size)
            Link_receive(&radio, bytes, size, nowUs());
        Link_poll(&radio, nowUs());
        wait = Link_deadline(&radio, nowUs()) / 1000U;
        if (Mps2_pump() || size == sizeof(bytes))
            wait = 1;
        unlockLink(0);
        (void)ulTaskNotifyTake(pdTRUE, ticksOf(wait > 1000U ? 1000 : wait ? (Ice_Int)wait : 1));
    }
}

static void serverTask(void* argument) {
    (void)argument;
    Ice_Communicator_waitForShutdown(&ic);
    for (;;)
        vTaskDelay(portMAX_DELAY);
}

/* Calls the ground station; the server's task receives messages at the same time. */
static void callerTask(void* argument) {
    (void)argument;
    while (Meter_report(&ic, "station:xbee-at -a 0x0000") != ICE_OK)
        vTaskDelay(ticksOf(1000));
    for (;;)
        vTaskDelay(portMAX_DELAY);
}

void vApplicationGetIdleTaskMemory(StaticTask_t** task, StackType_t** stack,
                                   configSTACK_DEPTH_TYPE* size);
void vApplicationGetIdleTaskMemory(StaticTask_t** task, StackType_t** stack,
                                   configSTACK_DEPTH_TYPE* size) {
    static StaticTask_t idle;
    static StackType_t idleStack[configMINIMAL_STACK_SIZE];
    *task = &idle;
    *stack = idleStack;
    *size = configMINIMAL_STACK_SIZE;
}

static void startTask(int number, const char* name, TaskFunction_t function) {
    static StaticTask_t memory[TASKS];
    static StackType_t stacks[TASKS][STACK_WORDS];
    tasks[number] = xTaskCreateStatic(function, name, STACK_WORDS, 0, (UBaseType_t)(TASKS - number),
                                      stacks[number], &memory[number]);
}

int main(void) {
    static StaticSemaphore_t memory[2 + ICE_CALLS + 1 + 2];
    StaticSemaphore_t* next = memory;
    int i;
    locks[ICE_LOCK_STATE] = xSemaphoreCreateMutexStatic(next++);
    locks[ICE_LOCK_SEND] = xSemaphoreCreateMutexStatic(next++);
    for (i = 0; i <= ICE_CALLS; ++i)
        slots[i] = xSemaphoreCreateBinaryStatic(next++);
    linkLock = xSemaphoreCreateMutexStatic(next++);
    endpointEvent = xSemaphoreCreateBinaryStatic(next++);

    Link_init(&radio, &linkConfig);
    Ice_initialize(&ic);
    Ice_Communicator_setOs(&ic, &iceOs, 0);
    XBeeATEndpoint_init(&ic, "xbee-at", &endpoint, &radio, OWN_ADDRESS, &endpointPort, 0);
    if (Meter_serve(&ic, "xbee-at", "FreeRTOS") != ICE_OK)
        return 1;
    startTask(RADIO, "radio", radioTask);
    startTask(SERVER, "server", serverTask);
    startTask(CALLER, "caller", callerTask);
    vTaskStartScheduler();
    return 1;
}
