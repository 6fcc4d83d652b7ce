/* SPDX-License-Identifier: MIT
 *
 * minimal: the smallest program that has all layers: one loop, no tasks, a server and a client.
 *
 * It is what `make size` measures (docs/icec.md): Slice of the paper's Figure 3, the engine's
 * servant as in its Figure 5, and calls to the ground station, two-way (ice_ping) and one-way
 * (vehicleState), over the xbee-at endpoint, the link, the modem and the FSMC.
 */
#include "Autopilot.h"
#include "fsmc.h"
#include "radio.h"
#include "ucos_ii.h"
#include "xbee_endpoint.h"

#define BYTE_TIME_US16 1440U /* 111,111 baud */
#define ENGINE_SLOT 2U

volatile INT32U minimal_ticks; /* milliseconds, counted by SysTick */

static Ice_Communicator ic;
static Ice_ObjectAdapter adapter;
static Autopilot_HwProcessingEngine servant;
static XBeeATEndpoint endpoint;
static Link radioLink;

/* ---- the processor ---- */

static U8 read8(void *context, U32 address) {
    (void)context;
    return *(volatile U8 *)address;
}

static void write8(void *context, U32 address, U8 value) {
    (void)context;
    *(volatile U8 *)address = value;
}

static U16 read16(void *context, U32 address) {
    (void)context;
    return *(volatile U16 *)address;
}

static void write16(void *context, U32 address, U16 value) {
    (void)context;
    *(volatile U16 *)address = value;
}

static U32 read32(void *context, U32 address) {
    (void)context;
    return *(volatile U32 *)address;
}

static void write32(void *context, U32 address, U32 value) {
    (void)context;
    *(volatile U32 *)address = value;
}

static const Fsmc_Port processor = {read8, write8, read16, write16, read32, write32};

/* What the radio driver asks of an OS. */
void OSTimeDly(INT32U ticks) {
    INT32U begin = minimal_ticks;
    while (minimal_ticks - begin < ticks)
        ;
}

/* ---- the link, polled ---- */

static U32 nowMs(void *context) {
    (void)context;
    return minimal_ticks;
}

static U32 nowUs(void *context) {
    (void)context;
    return minimal_ticks * 1000U;
}

static int work(void *context, Ice_Int timeoutMs) {
    INT32U begin = minimal_ticks;
    (void)context;
    do {
        (void)Radio_receive(&radioLink, nowUs(0));
        Link_poll(&radioLink, nowUs(0));
    } while (endpoint.events == 0 && (Ice_Int)(minimal_ticks - begin) < timeoutMs);
    return 0;
}

static const XBeeATPort endpointPort = {0, 0, 0, work, 0, nowUs, nowMs};

static U32 randomWord(void *context) {
    static U32 state;
    (void)context;
    return state = state * 1664525U + 1013904223U + minimal_ticks;
}

static int onMessage(void *context, int channel, const U8 *data, U32 size) {
    (void)context;
    return XBeeATEndpoint_onMessage(&endpoint, channel, data, size);
}

static void onChannel(void *context, int channel, int isOpen) {
    (void)context;
    XBeeATEndpoint_onChannel(&endpoint, channel, isOpen);
}

static void onState(void *context, Link_State state) {
    (void)context;
    XBeeATEndpoint_onState(&endpoint, state);
}

static const Link_Port linkPort = {Radio_transmit, randomWord, onMessage, onChannel, onState, 0, 0};

/* ---- the servant: registers through the FSMC ---- */

Ice_Status Autopilot_HwProcessingEngine_setParameterA(Autopilot_HwProcessingEnginePtr self,
                                                      Ice_Short value, const Ice_Current *current) {
    (void)self;
    (void)current;
    FSMC_write(ENGINE_SLOT, 4, (U32)value);
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_startProcessing(Autopilot_HwProcessingEnginePtr self,
                                                        const Ice_Current *current) {
    (void)self;
    (void)current;
    FSMC_write(ENGINE_SLOT, 0, 1);
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_getResult(Autopilot_HwProcessingEnginePtr self,
                                                  Autopilot_ResultType *res,
                                                  const Ice_Current *current) {
    (void)self;
    (void)current;
    res->found = (Ice_Int)FSMC_read(ENGINE_SLOT, 5);
    res->cycles = (Ice_Int)FSMC_read(ENGINE_SLOT, 6);
    res->best.size = 0;
    return ICE_OK;
}

/* ---- the program ---- */

int main(void) {
    static const XBeeInitTypeDef xbeeConf = {XBEE_BD_115200, 0x0001, 0x0000, 0, 0, 0, 0};
    static const Radio_Memory rings = {0x00000000U, 0x00001000U};
    static Ice_ObjectPrx station, stationOneway, self;
    Autopilot_ParamSeq params = {0, 0};

    if (FSMC_init(&processor, 0) != FSMC_OK || xbeeInit(&xbeeConf, &rings) != RADIO_OK)
        return 1;
    Link_init(&radioLink, &linkPort, 0, BYTE_TIME_US16);
    Link_start(&radioLink, nowUs(0));

    Ice_initialize(&ic);
    XBeeATEndpoint_init(&ic, "xbee-at", &endpoint, &radioLink, 1, &endpointPort, 0);
    (void)Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "Adapter", "xbee-at", &adapter);
    Ice_ObjectAdapter_activate(&adapter);
    Autopilot_HwProcessingEngine_init(&servant);
    (void)Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&servant, "hwengine1");

    (void)Ice_Communicator_stringToProxy(&ic, "station:xbee-at -a 0x0000", &station);
    (void)Ice_Communicator_stringToProxy(&ic, "station -o:xbee-at -a 0x0000", &stationOneway);
    (void)Ice_ObjectAdapter_createProxy(&adapter, "hwengine1", &self);
    if (Autopilot_StationPrx_vehicleState(&station, &self, &params) == ICE_OK)
        (void)Autopilot_StationPrx_vehicleState(&stationOneway, &self, &params);

    Ice_Communicator_waitForShutdown(&ic);
    return 0;
}
