/* SPDX-License-Identifier: MIT
 *
 * echo_uav: implements the servant, the client task and the boot of the test's firmware.
 */
#include "echo_uav.h"
#include "Echo.h"
#include "uav.h"
#include "uav_cores.h"
#include "uav_modem.h"
#include "uav_os.h"
#include "uav_radio_state.h"
#include "uav_tasks.h"
#include "ucos_ii.h"

#define STACK_WORDS 1024
#define PAUSE_TICKS (OS_TICKS_PER_SEC / 100U) /* pause without a message to send */
#define TIMEOUT_MS 20000                      /* time-out of a call to the ground, ms */

static OS_STK serverStack[STACK_WORDS], clientStack[STACK_WORDS], radioStack[STACK_WORDS],
    coresStack[STACK_WORDS];
static Ice_Communicator ic;
static Ice_ObjectAdapter adapter;
static RadioTest_Echo servant;
static U8 irqEnabled;
static const EchoUav_Port* port;
static void* portContext;
static Ice_Byte sent[ECHO_UAV_LONGEST], fetched[8192];
/* buffer for the reply, followed by the buffer for the decoded sequence */
static U32 replyBuffer[2 * 8192 / 4];

void EchoUav_setPort(const EchoUav_Port* tests, void* context) {
    port = tests;
    portContext = context;
}

/* ---- servant ---- */

Ice_Status RadioTest_Echo_repeat(RadioTest_EchoPtr self, Ice_Int id, const RadioTest_Bytes* data,
                                 RadioTest_Bytes* result, const Ice_Current* current) {
    (void)self, (void)current;
    port->executed(portContext, id, data->data, data->size);
    *result = *data;
    return ICE_OK;
}

Ice_Status RadioTest_Echo_take(RadioTest_EchoPtr self, Ice_Int id, const RadioTest_Bytes* data,
                               const Ice_Current* current) {
    (void)self, (void)current;
    port->executed(portContext, id, data->data, data->size);
    return ICE_OK;
}

Ice_Status RadioTest_Echo_fetch(RadioTest_EchoPtr self, Ice_Int size, RadioTest_Bytes* result,
                                const Ice_Current* current) {
    (void)self, (void)current;
    if (size < 0 || (U32)size > sizeof fetched)
        return ICE_LIMIT;
    result->size = size;
    result->data = fetched;
    return ICE_OK;
}

Ice_Status RadioTest_Echo_note(RadioTest_EchoPtr self, Ice_Int id, const Ice_Current* current) {
    (void)self, (void)current;
    port->executed(portContext, id, 0, 0);
    return ICE_OK;
}

/* ---- tasks ---- */

/* Calls the ground, one message at a time. */
static void clientTask(void* argument) {
    static RadioTest_EchoPrx twoway, oneway;
    (void)argument;
    (void)Ice_Communicator_stringToProxy(&ic, "station:xbee-at -a 0x0000", &twoway);
    Ice_ObjectPrx_ice_invocationTimeout(&twoway, TIMEOUT_MS);
    Ice_ObjectPrx_setReplyBuffer(&twoway, replyBuffer, (Ice_Int)sizeof replyBuffer);
    oneway = twoway;
    Ice_ObjectPrx_ice_oneway(&oneway);
    for (;;) {
        RadioTest_Bytes data, answer;
        Ice_Status status;
        int id, isOneway;
        data.data = sent;
        data.size = port->next(portContext, &id, sent, &isOneway);
        if (data.size < 0) {
            OSTimeDly(PAUSE_TICKS);
            continue;
        }
        answer.size = 0;
        answer.data = 0;
        if (isOneway)
            status = RadioTest_EchoPrx_note(&oneway, id);
        else
            status = RadioTest_EchoPrx_repeat(&twoway, id, &data, &answer);
        port->outcome(portContext, id, (int)status, Ice_Status_text(status), answer.data,
                      answer.size);
    }
}

static void mainTask(void* argument) {
    (void)argument;
    Ice_initialize(&ic);
    Ice_Communicator_setOs(&ic, &uav_iceOs, 0);
    UAV_useRadio(&ic);
    (void)Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "Adapter", "xbee-at", &adapter);
    RadioTest_Echo_init(&servant);
    (void)Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&servant, "echo");
    UAV_startCores(&adapter);
    Ice_ObjectAdapter_activate(&adapter);
    (void)OSTaskCreate(UAV_coresTask, 0, &coresStack[STACK_WORDS - 1], PRIO_CORES);
    (void)OSTaskCreate(UAV_radioTask, 0, &radioStack[STACK_WORDS - 1], PRIO_RADIO);
    (void)OSTaskCreate(clientTask, 0, &clientStack[STACK_WORDS - 1], PRIO_CLIENT);
    Ice_Communicator_waitForShutdown(&ic);
    for (;;)
        OSTimeDly(OS_TICKS_PER_SEC);
}

int EchoUav_irqEnabled(void) {
    return irqEnabled;
}

void EchoUav_start(const FSMC_Port* fsmc, void* context) {
    irqEnabled = 0;
    if (FSMC_init(fsmc, context) != FSMC_OK)
        return;
    UAV_initRadio();
    UAV_initIceOs();
    UAV_initCores();
    irqEnabled = 1;
    (void)OSTaskCreate(mainTask, 0, &serverStack[STACK_WORDS - 1], PRIO_SERVER);
}
