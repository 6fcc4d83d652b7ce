/* SPDX-License-Identifier: MIT
 *
 * endpoint_minimal: IceC's transport over the radio link, for a program with one task and one
 * ground station. It has the same names and wire format as xbee_endpoint.h. The task that waits for
 * a message polls the link.
 */
#pragma once

#include "icec.h"
#include "link_minimal.h"

#define XBEE_ENDPOINT_TYPE 0x4158
/* channel that this side, the UAV, opens; the ground station opens 0..2 */
#define XBEE_OWN_CHANNEL 3

/* The endpoint's port to the program. */
typedef struct XBeeATEndpoint_Port {
    /* Polls the link until the endpoint's `events` is not 0, but for at most `timeoutMs`. */
    int (*wait)(void* context, Ice_Int timeoutMs);
    U32 (*nowMs)(void* context);
} XBeeATEndpoint_Port;

typedef struct XBeeATEndpoint {
    Link* link;
    const XBeeATEndpoint_Port* port;
    void* context;
    U16 address;  /* address of this side's modem, MY */
    U32 events;   /* pending events, one bit each */
    Ice_Int size; /* size of the pending message, bytes */
    /* buffer of the waiting task; 0 while no task waits, so that the link keeps messages */
    Ice_Byte* buffer;
    Ice_Byte from;    /* channel of the pending message */
    Ice_Byte ownOpen; /* 1: this side's channel is open */
} XBeeATEndpoint;

/* Registers the transport with the communicator. `name` must be "xbee-at". */
void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char* name, XBeeATEndpoint* self, Link* link,
                         U16 address, const XBeeATEndpoint_Port* port, void* context);

/* Callbacks for Link_Port; `self` is the XBeeATEndpoint. */
int XBeeATEndpoint_onMessage(void* self, int channel, const U8* data, U32 size);
void XBeeATEndpoint_onChannel(void* self, int channel, int isOpen);
