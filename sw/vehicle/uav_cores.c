/* SPDX-License-Identifier: MIT
 *
 * uav_cores: starts the servants of the cores in ip/cores.list, and handles the interrupts and bus
 * errors of the cores. Its task completes calls that take time.
 */
#include "uav_cores.h"
#include "Autopilot.h"
#include "hw_instance.h"
#include "hw_registers.h"
#include "system_regs.h"
#include "uav.h"
#include "uav_tasks.h"
#include "ucos_ii.h"

#define MS_PER_TICK (1000U / OS_TICKS_PER_SEC)

typedef char UAV_RoomForEveryServant[ICE_SERVANTS >= UAV_SERVANTS + MAP_CORES ? 1 : -1];

/* semaphores: `waiter` wakes the task that waits for an event, `work` wakes coresTask, `frameDone`
 * wakes UAV_waitFrame */
static OS_EVENT *waiter, *work, *frameDone;
static U32 framesDone, cornersFound;
/* Number of accesses that got no response; slot and word of the last such access, as from
 * FSMC_checkError, for a debugger. An access gets no response if the register does not exist, or if
 * the core hangs until the bridge times out. Only the interrupt routine writes these variables. */
static U32 busErrors, busErrorPlace;
static U8 isStarted[MAP_CORES];
static Hw_Contract contracts[MAP_CONTRACTS];
static Hw_Chip chip;

/* Waits for an event of a core. Only the task that serves calls waits here. After the wait,
 * the task checks whether the event belongs to its operation. */
static int waitEvent(void* context, U32 operation, U32 ms) {
    INT8U error;
    (void)context;
    (void)operation;
    OSSemPend(waiter, (INT32U)(ms / MS_PER_TICK + 1U), &error);
    return error == OS_ERR_NONE;
}

static void postEvent(void* context, U32 operation) {
    (void)context;
    (void)operation;
    (void)OSSemPost(waiter);
    (void)OSSemPost(work);
}

static U32 nowMs(void* context) {
    (void)context;
    return OSTimeGet() * MS_PER_TICK;
}

static U32 errorsOnTheBus(void* context) {
    (void)context;
    return busErrors;
}

static void countFrame(U32 corners) {
    ++framesDone;
    cornersFound += corners;
    (void)OSSemPost(frameDone);
}

U32 UAV_waitFrame(U32* corners) {
    INT8U error;
    OSSemPend(frameDone, 0, &error);
    *corners = cornersFound;
    return framesDone;
}

static Hw_Frames frames = {0, 0, 0, 0, UAV_FRAME, UAV_FRAME_HEADER, countFrame};
static const Hw_Port port = {waitEvent, postEvent, nowMs, errorsOnTheBus, &frames};

void UAV_initCores(void) {
    FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_MASK, SYSTEM_MASK_BUS_ERROR_MASK);
    waiter = OSSemCreate(0);
    work = OSSemCreate(0);
    frameDone = OSSemCreate(0);
    busErrors = 0;
    framesDone = 0;
    cornersFound = 0;
    frames.width = 0;
}

Ice_Status Hw_Chip_contracts(Hw_ChipPtr self, Hw_ContractSeq* result, const Ice_Current* current) {
    (void)self;
    (void)current;
    result->size = MAP_CONTRACTS;
    result->data = contracts;
    return ICE_OK;
}

void UAV_startCores(Ice_ObjectAdapterPtr adapter) {
    U32 i;
    Hw_Contracts_read(contracts, hw_contracts, MAP_CONTRACTS);
    Hw_Chip_init(&chip);
    (void)Ice_ObjectAdapter_add(adapter, (Ice_ObjectPtr)&chip, "chip");
    for (i = 0; hw_instances[i].identity; ++i) {
        const Hw_Instance* core = &hw_instances[i];
        isStarted[i] = Hw_Contracts_hold(contracts, MAP_CONTRACTS, core->slot) &&
                       core->start(&port, 0) == HW_OK;
        /* a core that is not started has no servant, so calls to it get ObjectNotExistException */
        if (isStarted[i])
            (void)Ice_ObjectAdapter_add(adapter, core->servant, core->identity);
    }
}

void UAV_coresInterrupt(const U32 lines[2]) {
    U32 i;
    if ((lines[0] >> MAP_SLOT_SYSTEM & 1U) && FSMC_checkError(&busErrorPlace) == FSMC_BUS_ERROR)
        ++busErrors;
    for (i = 0; hw_instances[i].identity; ++i)
        if (isStarted[i] && (lines[hw_instances[i].slot >> 5] >> (hw_instances[i].slot & 31U) & 1U))
            hw_instances[i].interrupt();
}

void UAV_coresTask(void* argument) {
    INT8U error;
    (void)argument;
    for (;;) {
        U32 next = HW_NEVER, i;
        for (i = 0; hw_instances[i].identity; ++i)
            if (isStarted[i]) {
                U32 ms = hw_instances[i].poll(nowMs(0));
                next = ms < next ? ms : next;
            }
        /* A time-out of 0 means no limit for OSSemPend. */
        OSSemPend(work, next == HW_NEVER ? 0 : (INT32U)(next / MS_PER_TICK + 1U), &error);
    }
}
