/* SPDX-License-Identifier: MIT
 *
 * uav_os: implements locks, waits and signals for IceC and its endpoint by means of uC/OS-II's
 * functions.
 */
#include "uav_os.h"
#include "uav_radio_state.h"
#include "uav_tasks.h"

static OS_EVENT* endpointEvent;
/* one semaphore for each slot of a call; the last one is for tasks that wait to receive */
static OS_EVENT* callDone[ICE_CALLS + 1];
static OS_EVENT* iceMutex[2]; /* mutexes, indexed by ICE_LOCK_STATE and ICE_LOCK_SEND */

static void kick(void* context) {
    (void)context;
    (void)OSSemPost(uav_radioWork);
}

static int waitEvent(void* context, Ice_Int timeoutMs) {
    INT8U error;
    (void)context;
    OSSemPend(endpointEvent, (INT32U)timeoutMs, &error);
    return error == OS_ERR_NONE;
}

static void signalEvent(void* context) {
    (void)context;
    (void)OSSemPost(endpointEvent);
}

static U32 nowMs(void* context) {
    (void)context;
    return OSTimeGet() * (1000U / OS_TICKS_PER_SEC);
}

const XBeeATEndpoint_Port uav_endpointPort = {UAV_lockLink, UAV_unlockLink, kick,
                                              waitEvent,    signalEvent,    nowMs};

void UAV_initEndpointOs(void) {
    endpointEvent = OSSemCreate(0);
}

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
