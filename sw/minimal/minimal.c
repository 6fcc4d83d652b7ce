/* SPDX-License-Identifier: MIT
 *
 * minimal: the smallest program that uses all layers: a server and a client in one loop, without
 * tasks.
 *
 * `./icesoc build size` measures this program (docs/icec.md), and `make run CPU=m3 APP=minimal`
 * runs it in a simulated flight. It implements the Slice interfaces of the paper's Figure 3, with
 * the engine's servant of Figure 5. It calls the ground station, two-way and one-way, over the
 * xbee-at endpoint, the link, the modem and the FSMC. Its only interrupt is a tick of 1 kHz;
 * everything else is polled.
 */
#include "Autopilot.h"
#include "board.h"
#include "endpoint_minimal.h"
#include "map_regs.h"
#include "program_memory.h"
#include "radio.h"
#include "stm32f2.h"
#include "uav.h"
#include "ucos_ii.h"
#include "vision_regs.h"

#define BYTE_TIME_US16 1440U /* 111,111 baud */

static Ice_Communicator ic;
static Ice_ObjectAdapter adapter;
static Autopilot_HwProcessingEngine servant;
static XBeeATEndpoint endpoint;
static Link radioLink;
static volatile U32 now; /* time since the start, ms */

/* Sleeps until the next interrupt, which is the tick. */
static void sleep(void) {
    __asm__ volatile("wfi");
}

/* Replaces the kernel's function. The radio driver calls no other function of a kernel. */
void OSTimeDly(INT32U ticks) {
    INT32U begin = now;
    while (now - begin < ticks)
        sleep();
}

static U32 nowMs(void* context) {
    (void)context;
    return now;
}

static U32 nowUs(void* context) {
    (void)context;
    return now * 1000U;
}

static void onPacket(void* context, const U8* bytes, U32 size) {
    Link_receive(&radioLink, bytes, size, nowUs(context));
}

static void pollLink(void) {
    (void)Radio_receive(onPacket, 0);
    Link_poll(&radioLink, nowUs(0));
}

static int work(void* context, Ice_Int timeoutMs) {
    INT32U begin = now;
    (void)context;
    pollLink();
    while (endpoint.events == 0 && (Ice_Int)(now - begin) < timeoutMs) {
        sleep();
        pollLink();
    }
    return 0;
}

static const XBeeATEndpoint_Port endpointPort = {work, nowMs};

static U32 randomWord(void* context) {
    static U32 state;
    (void)context;
    return state = state * 1664525U + 1013904223U + now;
}

static void onState(void* context, Link_State state) {
    (void)context;
    /* not needed, because the link has already reported each channel to the endpoint */
    (void)state;
}

static const Link_Port linkPort = {
    Radio_transmit, randomWord, XBeeATEndpoint_onMessage, XBeeATEndpoint_onChannel, onState, 0, 0};
static const Link_Config linkConfig = {&linkPort, &endpoint, BYTE_TIME_US16};

Ice_Status Autopilot_HwProcessingEngine_setParameterA(Autopilot_HwProcessingEnginePtr self,
                                                      Ice_Short value, const Ice_Current* current) {
    (void)self;
    (void)current;
    FSMC_write(MAP_SLOT_VISION, VISION_THRESHOLD, (U32)value);
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_startProcessing(Autopilot_HwProcessingEnginePtr self,
                                                        const Ice_Current* current) {
    U8 size[8]; /* width and height of the frame, which the camera has written to memory */
    (void)self;
    (void)current;
    FSMC_readMemory(UAV_FRAME_HEADER, size, 8);
    FSMC_write(MAP_SLOT_VISION, VISION_FRAME_BASE, UAV_FRAME);
    FSMC_write(MAP_SLOT_VISION, VISION_FRAME_SIZE,
               (U32)size[0] | (U32)size[1] << 8 | (U32)size[4] << 16 | (U32)size[5] << 24);
    FSMC_write(MAP_SLOT_VISION, VISION_RESULT_BASE, MAP_MEMORY_VISION);
    FSMC_write(MAP_SLOT_VISION, VISION_RESULT_MAX, 0);
    FSMC_write(MAP_SLOT_VISION, VISION_CONTROL, VISION_CONTROL_START_MASK);
    return ICE_OK;
}

/* Returns the result of the last frame; `cycles` is 0 while the core is still working. */
Ice_Status Autopilot_HwProcessingEngine_getResult(Autopilot_HwProcessingEnginePtr self,
                                                  Autopilot_ResultType* res,
                                                  const Ice_Current* current) {
    (void)self;
    (void)current;
    res->found = res->cycles = 0;
    res->best.size = 0;
    if (FSMC_read(MAP_SLOT_VISION, VISION_STATUS) & VISION_STATUS_BUSY_MASK)
        return ICE_OK;
    res->found = (Ice_Int)FSMC_read(MAP_SLOT_VISION, VISION_FOUND);
    res->cycles = (Ice_Int)FSMC_read(MAP_SLOT_VISION, VISION_CYCLES);
    return ICE_OK;
}

/* Runs the program; returns only if the FPGA or the modem does not respond. */
int main(void) {
    static const XBeeInitTypeDef xbeeConf = {XBEE_BD_115200, 0x0001, 0x0000, 0, 0, 0, 0, 0};
    static const Radio_Memory rings = {0x00000000U, 0x00001000U};
    static Ice_ObjectPrx station, stationOneway, self;
    Autopilot_ParamSeq params = {0, 0};

    if (FSMC_init(&board_fsmc, 0) != FSMC_OK || xbeeInit(&xbeeConf, &rings) != RADIO_OK)
        return 1;
    Link_init(&radioLink, &linkConfig);
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
    /* Serves calls until the link is up and the ground station's object Station replies. */
    while (Autopilot_StationPrx_vehicleState(&station, &self, &params) != ICE_OK)
        (void)Ice_Communicator_poll(&ic, 1000);
    (void)Autopilot_StationPrx_vehicleState(&stationOneway, &self, &params);

    Ice_Communicator_waitForShutdown(&ic);
    return 0;
}

void Reset_Handler(void);

static void countTick(void) {
    ++now;
}

static void halt(void) {
    for (;;)
        sleep();
}

__attribute__((section(".vectors"), used)) static const Vector vectors[16] = {
    stack_top, /* initial stack pointer, not a function */
    Reset_Handler, halt, halt, halt, halt, halt, 0, 0, 0, 0, halt, halt, 0, halt, countTick};

void Reset_Handler(void) {
    Board_start();
    startMemory();
    SYST_RVR = SYST_MS - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_ON;
    (void)main();
    halt();
}
