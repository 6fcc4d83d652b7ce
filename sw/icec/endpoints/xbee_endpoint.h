/* SPDX-License-Identifier: MIT
 *
 * xbee_endpoint: IceC's transport over the radio link: a connection is a channel of the link.
 *
 * The ground station opens channels 0..2, this side channel 3. On the wire an endpoint is type
 * 0x4158 with a remote address (short), a channel (byte, 255: any) and a time-out in milliseconds
 * (int). With several ground stations each has a link and LINK_CHANNELS connections, numbered one
 * after the other. Another vehicle may take the place of a ground station: one of the two vehicles
 * then acts as the ground station, and opens channel 0. A call starts their session, and dials for
 * at most ICE_TIMEOUT_MS.
 */
#pragma once

#include "icec.h"
#include "link.h"

#define XBEE_ENDPOINT_TYPE 0x4158
#define XBEE_OWN_CHANNEL 3 /* opened by this side, the UAV; the ground opens 0..2 */
/* Peers at most: grounds, and vehicles in a ground's place. The events of more than three do not
 * fit into 32 bits. */
#define XBEE_PEERS \
    (ICE_CONNECTIONS < 3 * LINK_CHANNELS ? ICE_CONNECTIONS < 2 * LINK_CHANNELS ? 1 : 2 : 3)
#define XBEE_CONNECTIONS (XBEE_PEERS * LINK_CHANNELS)

/* Port to the application, whose radio task owns the link. The minimal run time has one task, which
 * polls the link in `wait`; lock, unlock, kick and signal are not called, and may be 0. */
typedef struct XBeeATEndpoint_Port {
    void (*lock)(void* context); /* around every use of the link, with its callbacks */
    void (*unlock)(void* context);
    void (*kick)(void* context);                   /* makes the radio task poll the link soon */
    int (*wait)(void* context, Ice_Int timeoutMs); /* for signal; returns 1 if signalled */
    void (*signal)(void* context);
    U32 (*nowMs)(void* context);
} XBeeATEndpoint_Port;

typedef struct XBeeATEndpoint {
    Link* links[XBEE_PEERS]; /* 0 for absent ground stations */
    const XBeeATEndpoint_Port* port;
    void* context;
    U16 address;             /* own, MY */
    U16 grounds[XBEE_PEERS]; /* the grounds' addresses, the first one's is 0 */
    U32 events;              /* events to deliver; 0 if none */
    Ice_Int size;            /* size of the pending message */
    Ice_Byte* buffer; /* buffer of the receiving task; 0: no task receives, the link keeps the
                       * message */
    Ice_Byte from;    /* connection of the pending message */
    Ice_Byte ownOpen; /* open channels of this side, one bit per ground station */
    Ice_Byte held;    /* the link keeps a message that was not taken */
    Ice_Byte offered; /* connection of the message being sent, unless it has ended */
#if XBEE_PEERS > 1
    Ice_Byte own[XBEE_PEERS];  /* connections that this side opens */
    Ice_Byte vehicles, sought; /* ground stations that are vehicles; those being dialled; one bit
                                * each */
    U32 soughtAt[XBEE_PEERS];  /* start of dialling, ms */
    U32 seen[XBEE_PEERS];      /* number of messages received before */
#endif
} XBeeATEndpoint;

/* Makes `name` (always "xbee-at") known to the communicator. */
void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char* name, XBeeATEndpoint* self, Link* link,
                         U16 address, const XBeeATEndpoint_Port* port, void* context);

#if XBEE_PEERS > 1
/* Adds another peer's link, in the place of ground `ground`. A proxy whose address is not a peer's
 * has no endpoint here. */
void XBeeATEndpoint_addPeer(XBeeATEndpoint* self, int ground, Link* link, U16 address);
/* Makes that ground a vehicle; `isGround`: this side has the ground's part. */
void XBeeATEndpoint_setVehicle(XBeeATEndpoint* self, int ground, int isGround);
/* Starts a vehicle's link while a call waits for its session, and stops it otherwise; call it under
 * the lock before each Link_poll. */
void XBeeATEndpoint_seek(XBeeATEndpoint* self, int ground, U32 nowUs);
#endif

/* Callbacks for Link_Port, to be called under the lock; `self` is the XBeeATEndpoint. These are the
 * first ground's: another one's add LINK_CHANNELS for each ground to the channel. */
int XBeeATEndpoint_onMessage(void* self, int channel, const U8* data, U32 size);
void XBeeATEndpoint_onChannel(void* self, int channel, int isOpen);
