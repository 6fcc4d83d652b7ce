/* SPDX-License-Identifier: MIT
 *
 * uav: the tasks of the application: server and client. It also starts the radio task.
 */
#include "uav.h"
#include "Autopilot.h"
#include "radio.h"
#include "uav_backup.h"
#include "uav_cores.h"
#include "uav_fleet.h"
#include "uav_keyring.h"
#include "uav_modem.h"
#include "uav_os.h"
#include "uav_peers.h"
#include "uav_tasks.h"
#include "uav_update.h"
#include "ucos_ii.h"

#define STACK_WORDS 512

static Ice_Communicator uav_ic;

static OS_STK serverStack[STACK_WORDS], clientStack[STACK_WORDS], radioStack[STACK_WORDS],
    coresStack[STACK_WORDS];
static Ice_ObjectAdapter adapter;
static Autopilot_Vehicle vehicle;
static U8 irqEnabled;

Ice_Status Autopilot_Vehicle_isAlive(Autopilot_VehiclePtr self, Ice_Short sessionId,
                                     Ice_Bool* result, const Ice_Current* current) {
    (void)self;
    (void)sessionId;
    (void)current;
    *result = 1;
    return ICE_OK;
}

Ice_Status Autopilot_Vehicle_setFlightState(Autopilot_VehiclePtr self, Autopilot_FlightState value,
                                            const Ice_Current* current) {
    (void)self;
    (void)current;
    UAV_setFlying(value == Autopilot_flying);
    return ICE_OK;
}

Ice_Status Autopilot_Vehicle_getFlightState(Autopilot_VehiclePtr self,
                                            Autopilot_FlightState* result,
                                            const Ice_Current* current) {
    (void)self;
    (void)current;
    *result = UAV_isFlying() ? Autopilot_flying : Autopilot_onGround;
    return ICE_OK;
}

static void setParam(Autopilot_Param* param, Ice_Byte* data, Autopilot_ParamId id, U32 value) {
    int i;
    for (i = 0; i < 4; ++i)
        data[i] = (Ice_Byte)(value >> (8 * i));
    param->id = id;
    param->type = Autopilot_uintT;
    param->data.size = 4;
    param->data.data = data;
}

/* Reports the vehicle's state to the ground station after each frame. If another vehicle is
 * configured and replies, the report includes that vehicle's state. */
static void clientTask(void* argument) {
    static Ice_ObjectPrx station, self, fellow;
    Autopilot_Param params[6];
    Ice_Byte data[6][4];
    Autopilot_ParamSeq list;
    Autopilot_FlightState state;
    const int hasFellow = UAV_makeVehicleProxy(&adapter, &fellow);
    (void)argument;
    (void)XBeeATEndpoint_makeProxy(&adapter, "station", UAV_GROUND_ADDRESS, &station);
    (void)Ice_ObjectAdapter_createProxy(&adapter, "uav", &self);
    list.data = params;
    for (;;) {
        U32 corners, frames = UAV_waitFrame(&corners);
        const Radio_Counters* radio = Radio_counters();
        setParam(&params[0], data[0], Autopilot_uptimeMs, OSTimeGet() * (1000U / OS_TICKS_PER_SEC));
        setParam(&params[1], data[1], Autopilot_framesProcessed, frames);
        setParam(&params[2], data[2], Autopilot_cornersFound, corners);
        setParam(&params[3], data[3], Autopilot_radioBytesSent, radio->bytesCopiedOut);
        setParam(&params[4], data[4], Autopilot_radioBytesReceived, radio->bytesCopiedIn);
        list.size = 5;
        if (hasFellow && Autopilot_VehiclePrx_getFlightState(&fellow, &state) == ICE_OK)
            setParam(&params[list.size++], data[5], Autopilot_fellowState, (U32)state);
        /* The result is ignored: if the ground station does not listen yet, it gets the next
         * report. */
        (void)Autopilot_StationPrx_vehicleState(&station, &self, &list);
    }
}

/* Creates a task with the bounds of its stack. The end of the stack can then be guarded, and the
 * use of the stack measured. */
static void createTask(void (*task)(void*), OS_STK* stack, INT8U priority) {
    (void)OSTaskCreateExt(task, 0, &stack[STACK_WORDS - 1], priority, priority, stack, STACK_WORDS,
                          0, OS_TASK_OPT_STK_CHK | OS_TASK_OPT_STK_CLR);
}

static void appMainTask(void* argument) {
    (void)argument;
    irqEnabled = 1;

    Ice_initialize(&uav_ic);
    Ice_Communicator_setOs(&uav_ic, &uav_iceOs, 0);
    UAV_useRadio(&uav_ic);
    (void)Ice_Communicator_createObjectAdapterWithEndpoints(&uav_ic, "Adapter", "xbee-at",
                                                            &adapter);
    Ice_ObjectAdapter_activate(&adapter);
    UAV_startCores(&adapter);
    Autopilot_Vehicle_init(&vehicle);
    (void)Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&vehicle, "uav");
    UAV_startUpdate(&adapter);
    UAV_startKeyRing(&adapter);

    createTask(UAV_radioTask, radioStack, PRIO_RADIO);
    createTask(UAV_coresTask, coresStack, PRIO_CORES);
    createTask(clientTask, clientStack, PRIO_CLIENT);
    Ice_Communicator_waitForShutdown(&uav_ic);
    for (;;)
        OSTimeDly(OS_TICKS_PER_SEC);
}

int UAV_irqEnabled(void) {
    return irqEnabled;
}

UAV_Status UAV_start(const FSMC_Port* port, void* context) {
    irqEnabled = 0;
    if (FSMC_init(port, context) != FSMC_OK)
        return UAV_NO_FPGA;
    if (!UAV_initRadio())
        return UAV_NO_KEY;
    UAV_initIceOs();
    UAV_initCores();
    createTask(appMainTask, serverStack, PRIO_SERVER);
    return UAV_OK;
}
