/* SPDX-License-Identifier: MIT
 *
 * Figure 5 of the paper, upper half: the server on the UAV. The text is that of the figure, except
 * for the marked lines:
 *
 *   [1] A servant's function gets two more parameters: `self`, so that it can distinguish two cores
 *       of one kind, and `current`. It returns a status. The operation is setParameterA, as in
 *       Figure 3.
 *   [2] The figure leaves the arguments of FSMC_write(...) open. Here it writes word 1 of the
 *       vision core's slot, the threshold.
 *   [3] xbeeInit is called by the radio task (uav_modem.c, with the same xbeeConf), which repeats
 *       the call when the modem has lost its settings.
 *   [4] XBeeATEndpoint_init(&ic, "xbee-at") also starts the link below the endpoint, and its task.
 *   [5] The Vehicle of Figure 3 is served as well.
 *
 * The figure omits getResult ("[...]"); here it is written in the same way as the other functions.
 * Figure 3 is Figure3.ice, and its client is figure5.py; `make test NAME=paper_figures` runs them
 * all over the simulated radio. Figure 4 calls an operation of Station by the name
 * Autopilot_Vehicle_vehicleState. Here its name is Autopilot_StationPrx_vehicleState
 * (build/main/gen/slice/Figure3/Figure3_client.c), because the name without Prx belongs to the
 * servant's function. It returns a status. The code that Figure 4 repeats in every function is part
 * of the run time here.
 */
#include "Figure3.h"
#include "fsmc.h"
#include "map_regs.h"
#include "paper.h"
#include "uav.h"
#include "ucos_ii.h"
#include "vision_regs.h"

Ice_Status
Autopilot_HwProcessingEngine_setParameterA(Autopilot_HwProcessingEnginePtr self, /* [1] */
                                           Ice_Short value, const Ice_Current* current) {
    (void)self, (void)current;
    FSMC_write(MAP_SLOT_VISION, VISION_THRESHOLD, (U32)value); /* [2] */
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_startProcessing(Autopilot_HwProcessingEnginePtr self,
                                                        const Ice_Current* current) {
    (void)self, (void)current;
    FSMC_write(MAP_SLOT_VISION, VISION_FRAME_BASE, UAV_FRAME);
    FSMC_write(MAP_SLOT_VISION, VISION_FRAME_SIZE, 96U | 64U << 16);
    FSMC_write(MAP_SLOT_VISION, VISION_RESULT_BASE, MAP_MEMORY_VISION);
    FSMC_write(MAP_SLOT_VISION, VISION_RESULT_MAX, VISION_RECORDS);
    FSMC_write(MAP_SLOT_VISION, VISION_CONTROL, VISION_CONTROL_START_MASK);
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_getResult(Autopilot_HwProcessingEnginePtr self,
                                                  Autopilot_ResultType* res,
                                                  const Ice_Current* current) {
    (void)self, (void)current;
    res->found = (Ice_Int)FSMC_read(MAP_SLOT_VISION, VISION_FOUND);
    return ICE_OK;
}

Ice_Status Autopilot_Vehicle_isAlive(Autopilot_VehiclePtr self, Ice_Short sessionId,
                                     Ice_Bool* result, const Ice_Current* current) {
    (void)self, (void)sessionId, (void)current;
    *result = 1;
    return ICE_OK;
}

void appMainTask(void* argument) {
    static Ice_Communicator ic;
    static Ice_ObjectAdapter adapter;
    static Autopilot_HwProcessingEngine servant;
    static Autopilot_Vehicle vehicle;
    (void)argument;

    /* [3]: xbeeInit(&xbeeConf); */
    Ice_initialize(&ic);
    PAPER_useRadio(&ic); /* [4] */

    Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "Adapter", "xbee-at", &adapter);

    Ice_ObjectAdapter_activate(&adapter);
    Autopilot_HwProcessingEngine_init(&servant);
    Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&servant, "hwengine1");
    Autopilot_Vehicle_init(&vehicle); /* [5] */
    Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&vehicle, "uav");

    Ice_Communicator_waitForShutdown(&ic);
    for (;;)
        OSTimeDly(OS_TICKS_PER_SEC);
}
