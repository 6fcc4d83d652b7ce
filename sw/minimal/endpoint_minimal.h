/* SPDX-License-Identifier: MIT
 *
 * endpoint_minimal: IceC's transport over the radio link for a program with one task and one
 * ground. It has the names and the wire format of xbee_endpoint.h; the task that waits for a
 * message polls the link.
 */
#pragma once

#include "icec.h"
#include "link_minimal.h"

#define XBEE_ENDPOINT_TYPE 0x4158
#define XBEE_OWN_CHANNEL 3 /* opened by this side, the UAV; the ground opens 0..2 */

/* The endpoint's port to the program. */
typedef struct XBeeATEndpoint_Port {
    /* Polls the link until `events` of the endpoint is not 0, or for `timeoutMs`. */
    int (*wait)(void* context, Ice_Int timeoutMs);
    U32 (*nowMs)(void* context);
} XBeeATEndpoint_Port;

typedef struct XBeeATEndpoint {
    Link* link;
    const XBeeATEndpoint_Port* port;
    void* context;
    U16 address;  /* address of this side's modem, MY */
    U32 events;   /* events to be delivered, one bit each */
    Ice_Int size; /* bytes of the pending message */
    /* buffer of the waiting task; 0 while no task waits (the link then keeps the message) */
    Ice_Byte* buffer;
    Ice_Byte from;    /* channel of the pending message */
    Ice_Byte ownOpen; /* this side's channel is open */
} XBeeATEndpoint;

/* Registers the transport with the communicator. `name` is always "xbee-at". */
void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char* name, XBeeATEndpoint* self, Link* link,
                         U16 address, const XBeeATEndpoint_Port* port, void* context);

/* Callbacks for Link_Port; `self` is the XBeeATEndpoint. */
int XBeeATEndpoint_onMessage(void* self, int channel, const U8* data, U32 size);
void XBeeATEndpoint_onChannel(void* self, int channel, int isOpen);
