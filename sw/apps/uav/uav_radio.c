/* SPDX-License-Identifier: MIT
 *
 * uav_radio: the radio task, and what IceC's endpoint needs from it.
 */
#include "radio.h"
#include "uav.h"
#include "uav_keys.h"
#include "uav_private.h"

#define BYTE_TIME_US16 1440U                /* 111,111 baud */
#define DOWN_LIMIT (15U * OS_TICKS_PER_SEC) /* the modem may have lost its settings then */

Link uav_link;
OS_EVENT* uav_radioWork;
const U8* uav_modemKey;
U16 uav_guardMs;
U8 uav_wire;
U8 uav_transparent;

static XBeeATEndpoint endpoint;
static OS_EVENT* linkMutex;
static OS_EVENT* iceEvent;
static U8 isAnswered; /* the radio answers for each packet */

U32 UAV_nowUs(void) {
    return OSTimeGet() * (1000000U / OS_TICKS_PER_SEC);
}

static void lockLink(void* context) {
    INT8U error;
    (void)context;
    OSMutexPend(linkMutex, 0, &error);
}

static void unlockLink(void* context) {
    (void)context;
    (void)OSMutexPost(linkMutex);
}

static void kick(void* context) {
    (void)context;
    (void)OSSemPost(uav_radioWork);
}

static int waitEvent(void* context, Ice_Int timeoutMs) {
    INT8U error;
    (void)context;
    OSSemPend(iceEvent, (INT32U)timeoutMs, &error);
    return error == OS_ERR_NONE;
}

static void signalEvent(void* context) {
    (void)context;
    (void)OSSemPost(iceEvent);
}

static U32 nowMsOf(void* context) {
    (void)context;
    return OSTimeGet() * (1000U / OS_TICKS_PER_SEC);
}

static const XBeeATEndpoint_Port endpointPort = {lockLink,  unlockLink,  kick,
                                                 waitEvent, signalEvent, nowMsOf};

/* Hands a packet over while at most one waits for the line. So the link layer knows how fast the
 * modem is, and chooses late what goes next. */
static int transmit(void* context, const U8* frame, U32 size) {
    if (isAnswered)
        Radio_setWait(Link_randomWait(&uav_link));
    return Radio_waiting() > 1U || Radio_transmit(context, frame, size);
}

static const Link_Port linkPort = {transmit,
                                   UAV_random,
                                   XBeeATEndpoint_onMessage,
                                   XBeeATEndpoint_onChannel,
                                   XBeeATEndpoint_onState,
                                   0,
                                   0};

int UAV_initRadio(void) {
    INT8U error;
    uav_radioWork = OSSemCreate(0);
    iceEvent = OSSemCreate(0);
    linkMutex = OSMutexCreate(PRIO_MUTEX, &error);
    Link_init(&uav_link, &linkPort, &endpoint, BYTE_TIME_US16);
    return UAV_giveKeys(&uav_link) || UAV_isOpen();
}

void UAV_useRadio(Ice_CommunicatorPtr ic) {
    XBeeATEndpoint_init(ic, "xbee-at", &endpoint, &uav_link, 1, &endpointPort, 0);
}

int UAV_nextKey(const U8* key) {
    int isSet;
    lockLink(0);
    isSet = UAV_setNextKey(&uav_link, key);
    unlockLink(0);
    return isSet;
}

static void onAnswer(int isDelivered) {
    Link_answer(&uav_link, isDelivered, UAV_nowUs());
}

static void setUpModem(void) {
    XBeeInitTypeDef xbeeConf = {RADIO_250000, 0x0001, 0x0000, 0, 0, 0, 0, onAnswer};
    static const Radio_Memory rings = {UAV_TRANSMIT_RING, UAV_RECEIVE_RING};
    if (uav_wire || uav_transparent) {
        xbeeConf.baud = uav_wire ? RADIO_WIRE_115200 : XBEE_BD_115200;
        xbeeConf.onAnswer = 0;
    }
    xbeeConf.source = (U16)UAV_address();
    xbeeConf.key = uav_modemKey;
    xbeeConf.guardMs = uav_guardMs;
    Link_limitFrame(&uav_link, uav_modemKey ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME);
    /* The vehicle flies on without its modem, and tries again. */
    while (xbeeInit(&xbeeConf, &rings) != RADIO_OK)
        OSTimeDly(OS_TICKS_PER_SEC);
    isAnswered = (U8)Radio_answers();
    Link_expectAnswers(&uav_link, isAnswered ? 2U : 0U);
}

static void onPacket(void* context, const U8* bytes, U32 size) {
    (void)context;
    Link_receive(&uav_link, bytes, size, UAV_nowUs());
}

void UAV_radioTask(void* argument) {
    INT8U error;
    U32 upAt;
    (void)argument;
    setUpModem();
    upAt = OSTimeGet();
    lockLink(0);
    Link_start(&uav_link, UAV_nowUs());
    unlockLink(0);
    for (;;) {
        U32 wait, now, ticks = OSTimeGet();
        if (ticks - upAt > DOWN_LIMIT) {
            setUpModem();
            upAt = ticks = OSTimeGet();
        }
        lockLink(0);
        (void)Radio_receive(onPacket, 0);
        now = UAV_nowUs();
        Link_poll(&uav_link, now);
        (void)UAV_confirmKey(&uav_link);
        wait = Link_deadline(&uav_link, now);
        if (Link_state(&uav_link) == LINK_STATE_UP)
            upAt = ticks;
        unlockLink(0);
        /* The wait is at least a tick, so that a full ring is not polled. */
        wait = wait > 1000000U ? OS_TICKS_PER_SEC : wait * OS_TICKS_PER_SEC / 1000000U;
        OSSemPend(uav_radioWork, wait ? wait : 1U, &error);
    }
}

static OS_EVENT* callDone[ICE_CALLS + 1]; /* the last is for tasks that want to receive */
static OS_EVENT* iceMutex[2];             /* by ICE_LOCK_STATE and ICE_LOCK_SEND */

void UAV_initIceOs(void) {
    INT8U error;
    int c;
    iceMutex[ICE_LOCK_STATE] = OSMutexCreate(PRIO_MUTEX + 1U, &error);
    iceMutex[ICE_LOCK_SEND] = OSMutexCreate(PRIO_RADIO + 1U, &error);
    for (c = 0; c <= ICE_CALLS; ++c)
        callDone[c] = OSSemCreate(0);
}

static void lockIce(void* context, int which) {
    INT8U error;
    (void)context;
    OSMutexPend(iceMutex[which], 0, &error);
}

static void unlockIce(void* context, int which) {
    (void)context;
    (void)OSMutexPost(iceMutex[which]);
}

static int waitCall(void* context, int slot, Ice_Int timeoutMs) {
    INT8U error;
    (void)context;
    OSSemPend(callDone[slot], (INT32U)timeoutMs, &error);
    return error == OS_ERR_NONE;
}

static void wakeCall(void* context, int slot) {
    (void)context;
    (void)OSSemPost(callDone[slot]);
}

static int taskOf(void* context) {
    (void)context;
    return OSTaskPrio();
}

const Ice_Os uav_iceOs = {lockIce, unlockIce, waitCall, wakeCall, taskOf};
