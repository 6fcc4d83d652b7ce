/* SPDX-License-Identifier: MIT
 *
 * bare_metal: serves and calls Ice objects without an operating system. Messages pass through the
 * link layer on a serial port.
 *
 * Two structs of functions adapt the libraries to this program: Link_Port for the radio (here the
 * serial port), and XBeeATEndpoint_Port for the transport. Ice_Os is not set, because there is only
 * one task.
 */
#include "icec_radio.h"
#include "meter.h"
#include "mps2.h"

#define BYTE_TIME_US16 1440U /* 111,111 baud */
#define OWN_ADDRESS 1

static Ice_Communicator ic; /* large: not on a stack */
static Link radio;
static Link_Buffers buffers;
static XBeeATEndpoint endpoint;

static U32 nowUs(void) {
    return Mps2_nowMs() * 1000U;
}

/* ---- Link_Port ---- */

static int transmit(void* context, const U8* frame, U32 size) {
    (void)context;
    return Mps2_send(frame, size);
}

/* Returns a pseudo-random number, which is sufficient for an example. A link with keys needs a true
 * random source here. */
static U32 randomWord(void* context) {
    static U32 state = 0x2545F491U;
    (void)context;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state + Mps2_nowMs();
}

static void onState(void* context, Link_State state) {
    (void)context;
    (void)state;
}

static const Link_Port linkPort = {
    transmit, randomWord, XBeeATEndpoint_onMessage, XBeeATEndpoint_onChannel, onState, 0, 0};
static const Link_Config linkConfig = {&linkPort, &endpoint, BYTE_TIME_US16, LINK_USE(buffers)};

static void pollLink(void) {
    U8 bytes[64];
    U32 size = Mps2_read(bytes, sizeof(bytes));
    if (size)
        Link_receive(&radio, bytes, size, nowUs());
    Link_poll(&radio, nowUs());
    (void)Mps2_pump();
}

/* ---- XBeeATEndpoint_Port ---- */

/* Does nothing: there is only one task, so the link needs no lock and no wake-up. */
static void nothing(void* context) {
    (void)context;
}

/* Polls the link until the transport has an event, or until `timeoutMs` have passed. */
static int work(void* context, Ice_Int timeoutMs) {
    U32 begin = Mps2_nowMs();
    (void)context;
    pollLink();
    while (!endpoint.events && (Ice_Int)(Mps2_nowMs() - begin) < timeoutMs) {
        Mps2_sleep();
        pollLink();
    }
    return endpoint.events != 0;
}

static U32 nowMs(void* context) {
    (void)context;
    return Mps2_nowMs();
}

static const XBeeATEndpoint_Port endpointPort = {nothing, nothing, nothing, work, nothing, nowMs};

void Mps2_onReceive(void) {}

int main(void) {
    Mps2_start();
    Mps2_startClock();
    Link_init(&radio, &linkConfig);
    Link_start(&radio, nowUs());
    Ice_initialize(&ic);
    XBeeATEndpoint_init(&ic, "xbee-at", &endpoint, &radio, OWN_ADDRESS, &endpointPort, 0);
    if (Meter_serve(&ic, "xbee-at", "bare metal") != ICE_OK)
        return 1;
    /* While this call waits for its reply, incoming calls are served. */
    while (Meter_report(&ic, "station:xbee-at -a 0x0000") != ICE_OK)
        (void)Ice_Communicator_poll(&ic, 1000);
    Ice_Communicator_waitForShutdown(&ic);
    return 0;
}
