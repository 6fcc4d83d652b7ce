/* SPDX-License-Identifier: MIT
 *
 * xbee_endpoint: IceC's transport over the radio link: a connection is a channel of the link.
 *
 * The ground opens channels 0..2, this side channel 3. On the wire an endpoint is type 0x4158 with
 * a remote address (short), a channel (byte, 255: any) and a time-out in milliseconds (int). Each
 * peer has a link and LINK_CHANNELS connections, in the order of the peers. A peer is a ground or
 * another vehicle; of two vehicles one has the ground's part and opens channel 0. A call to a
 * vehicle dials it: begins a session, for at most ICE_TIMEOUT_MS.
 *
 * The small program has another endpoint, with one task: sw/minimal/endpoint_minimal.h.
 */
#pragma once

#include "icec.h"
#include "link.h"

#define XBEE_ENDPOINT_TYPE 0x4158
#define XBEE_OWN_CHANNEL 3 /* opened by this side, the UAV; the ground opens 0..2 */
/* Number of peers, at most: with more than three the events would not fit into 32 bits. */
#define XBEE_PEERS \
    (ICE_CONNECTIONS < 3 * LINK_CHANNELS ? ICE_CONNECTIONS < 2 * LINK_CHANNELS ? 1 : 2 : 3)
#define XBEE_CONNECTIONS (XBEE_PEERS * LINK_CHANNELS)

/* Functions of the application, which owns the link in its radio task. */
typedef struct XBeeATEndpoint_Port {
    void (*lock)(void* context); /* is held during each use of the link and its callbacks */
    void (*unlock)(void* context);
    void (*kick)(void* context);                   /* makes the radio task poll the link soon */
    int (*wait)(void* context, Ice_Int timeoutMs); /* waits for signal; 1: signalled */
    void (*signal)(void* context);
    U32 (*nowMs)(void* context);
} XBeeATEndpoint_Port;

typedef struct XBeeATEndpoint {
    Link* links[XBEE_PEERS]; /* 0: absent peer */
    const XBeeATEndpoint_Port* port;
    void* context;
    U16 address;               /* address of this side's modem, MY */
    U16 addresses[XBEE_PEERS]; /* addresses of the peers; the first ground has 0 */
    U32 events;                /* events to be delivered, one bit each */
    Ice_Int size;              /* bytes of the pending message */
    Ice_Byte* buffer;          /* buffer of the receiving task; 0: the link keeps the message */
    Ice_Byte from;             /* connection of the pending message */
    Ice_Byte ownOpen;          /* this side's channel is open, one bit for each peer */
    Ice_Byte held;             /* the link keeps a message that was not taken */
    Ice_Byte offered; /* connection of the message that is being sent, unless it has ended */
    /* For xbee_peers.c */
    Ice_Byte own[XBEE_PEERS];  /* connections that this side opens */
    Ice_Byte vehicles, dialed; /* peers that are vehicles; vehicles that are dialed; one bit each */
    U32 dialedAt[XBEE_PEERS];  /* time of dialing, ms */
    U32 received[XBEE_PEERS];  /* messages received before that */
} XBeeATEndpoint;

/* Makes `name` (always "xbee-at") known to the communicator. */
void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char* name, XBeeATEndpoint* self, Link* link,
                         U16 address, const XBeeATEndpoint_Port* port, void* context);

/* Makes a two-way proxy to an object of a peer, as stringToProxy does from "IDENTITY:xbee-at -a
 * ADDRESS", for an adapter with this transport only. A program that parses no other string is
 * linked without the parser. */
Ice_Status XBeeATEndpoint_makeProxy(Ice_ObjectAdapterPtr adapter, const char* identity, U16 address,
                                    Ice_ObjectPrxPtr prx);

/* Adds a peer's link (xbee_peers.c). A proxy with an unknown address has no endpoint here. */
void XBeeATEndpoint_addPeer(XBeeATEndpoint* self, int peer, Link* link, U16 address);
/* Makes a peer a vehicle (xbee_peers.c); `isGround`: this side has the ground's part. */
void XBeeATEndpoint_setVehicle(XBeeATEndpoint* self, int peer, int isGround);
/* Starts a vehicle's link while a call waits for its session, and stops it otherwise. To be called
 * under the lock before each Link_poll. */
void XBeeATEndpoint_dial(XBeeATEndpoint* self, int peer, U32 nowUs);

/* Callbacks for Link_Port, to be called under the lock; `self` is the XBeeATEndpoint. The first
 * ground passes its channels; peer n adds n * LINK_CHANNELS to each. */
int XBeeATEndpoint_onMessage(void* self, int channel, const U8* data, U32 size);
void XBeeATEndpoint_onChannel(void* self, int channel, int isOpen);
