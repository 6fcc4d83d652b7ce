/* SPDX-License-Identifier: MIT
 *
 * xbee_endpoint: IceC's transport over the radio link. Each connection is a channel of a link.
 *
 * The ground opens channels 0..2, this side channel 3. On the wire an endpoint is type 0x4158 with
 * a remote address (short), a channel (byte, 255: any) and a time-out in milliseconds (int). Each
 * peer has a link and LINK_CHANNELS connections, in the order of the peers. A peer is a ground
 * station or another vehicle. Of two vehicles, one has the role of the ground and opens channel 0.
 * A call to a vehicle dials the vehicle: this side tries to begin a session, for at most
 * ICE_TIMEOUT_MS.
 *
 * The small program has another endpoint, with one task: sw/minimal/endpoint_minimal.h.
 */
#pragma once

#include "icec.h"
#include "link.h"

#define XBEE_ENDPOINT_TYPE 0x4158
#define XBEE_OWN_CHANNEL 3 /* channel that this side, the UAV, opens; the ground opens 0..2 */
/* Largest number of peers, three: the events of more peers would not fit into 32 bits. */
#define XBEE_PEERS \
    (ICE_CONNECTIONS < 3 * LINK_CHANNELS ? ICE_CONNECTIONS < 2 * LINK_CHANNELS ? 1 : 2 : 3)
#define XBEE_CONNECTIONS (XBEE_PEERS * LINK_CHANNELS)

/* Functions of the application, which owns the link in its radio task. */
typedef struct XBeeATEndpoint_Port {
    /* acquires the lock, which is held while the link is used and during its callbacks */
    void (*lock)(void* context);
    void (*unlock)(void* context);
    void (*kick)(void* context); /* makes the radio task poll the link soon */
    /* waits for `signal`; returns 1 if it was signalled */
    int (*wait)(void* context, Ice_Int timeoutMs);
    void (*signal)(void* context);
    U32 (*nowMs)(void* context);
} XBeeATEndpoint_Port;

typedef struct XBeeATEndpoint {
    Link* links[XBEE_PEERS]; /* link of each peer; 0 for an absent peer */
    const XBeeATEndpoint_Port* port;
    void* context;
    U16 address;               /* address of this side's modem, MY */
    U16 addresses[XBEE_PEERS]; /* addresses of the peers; the first ground has 0 */
    U32 events;                /* events to be delivered, one bit for each */
    Ice_Int size;              /* size of the pending message, bytes */
    /* buffer of the receiving task; 0 while no task receives (the link then keeps the message) */
    Ice_Byte* buffer;
    Ice_Byte from;    /* connection of the pending message */
    Ice_Byte ownOpen; /* peers to which this side's channel is open, one bit for each */
    Ice_Byte held;    /* 1: the link keeps a message that could not be delivered */
    /* connection of the message that is being sent; another value if the connection has ended */
    Ice_Byte offered;
    /* ---- fields for xbee_peers.c ---- */
    Ice_Byte own[XBEE_PEERS]; /* number of the connection that this side opens to each peer */
    /* vehicles: peers that are vehicles; dialed: vehicles that are dialed now; one bit for each
     * peer */
    Ice_Byte vehicles, dialed;
    U32 dialedAt[XBEE_PEERS]; /* time at which dialing began, ms */
    U32 received[XBEE_PEERS]; /* number of messages received before dialing */
} XBeeATEndpoint;

/* Registers the transport with the communicator. `name` is always "xbee-at". */
void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char* name, XBeeATEndpoint* self, Link* link,
                         U16 address, const XBeeATEndpoint_Port* port, void* context);

/* Makes a two-way proxy to an object of a peer, like stringToProxy with "IDENTITY:xbee-at -a
 * ADDRESS". The adapter must use only this transport. A program that does not call stringToProxy is
 * linked without the parser. */
Ice_Status XBeeATEndpoint_makeProxy(Ice_ObjectAdapterPtr adapter, const char* identity, U16 address,
                                    Ice_ObjectPrxPtr prx);

/* Adds a peer's link (xbee_peers.c). A proxy with the address of no peer cannot be called. */
void XBeeATEndpoint_addPeer(XBeeATEndpoint* self, int peer, Link* link, U16 address);
/* Makes a peer a vehicle (xbee_peers.c). `isGround` is 1 if this side has the role of the
 * ground. */
void XBeeATEndpoint_setVehicle(XBeeATEndpoint* self, int peer, int isGround);
/* Starts a vehicle's link while a call waits for its session, and stops it otherwise. To be called
 * under the lock before each Link_poll. */
void XBeeATEndpoint_dial(XBeeATEndpoint* self, int peer, U32 nowUs);

/* Callbacks for Link_Port, to be called under the lock; `self` is the XBeeATEndpoint. `channel` is
 * the link's channel for the first ground; for peer n, the caller adds n * LINK_CHANNELS to it. */
int XBeeATEndpoint_onMessage(void* self, int channel, const U8* data, U32 size);
void XBeeATEndpoint_onChannel(void* self, int channel, int isOpen);
