/* SPDX-License-Identifier: MIT
 *
 * xbee_endpoint: IceC's transport over the radio link. Each connection is a channel of a link.
 *
 * The ground station opens channels 0..2, this side opens channel 3. An encoded endpoint has type
 * 0x4158, the address of the remote side (short), a channel (byte, 255 means any) and a time-out in
 * milliseconds (int). Each peer has a link and LINK_CHANNELS connections; connections are numbered
 * in the order of the peers. A peer is a ground station or another vehicle. Of two vehicles, one
 * acts as the ground station and opens channel 0. Before a call to a vehicle without a session,
 * this side dials the vehicle: it tries to begin a session, for at most ICE_TIMEOUT_MS.
 *
 * The small program has a simpler endpoint, for a single task: sw/minimal/endpoint_minimal.h.
 */
#pragma once

#include "icec.h"
#include "link.h"

#define XBEE_ENDPOINT_TYPE 0x4158
#define XBEE_OWN_CHANNEL 3 /* channel that this side, the UAV, opens; the ground opens 0..2 */
/* Largest number of peers: three. With more peers, their events would not fit into 32 bits. */
#define XBEE_PEERS \
    (ICE_CONNECTIONS < 3 * LINK_CHANNELS ? ICE_CONNECTIONS < 2 * LINK_CHANNELS ? 1 : 2 : 3)
#define XBEE_CONNECTIONS (XBEE_PEERS * LINK_CHANNELS)

/* Functions of the application. The application owns the link and polls it in its radio task. */
typedef struct XBeeATEndpoint_Port {
    /* acquires the lock that protects the link; held while the link is used and during its
     * callbacks */
    void (*lock)(void* context);
    void (*unlock)(void* context);
    void (*kick)(void* context); /* makes the radio task poll the link soon */
    /* waits for `signal` or the time-out; returns 1 after a signal */
    int (*wait)(void* context, Ice_Int timeoutMs);
    void (*signal)(void* context);
    U32 (*nowMs)(void* context);
} XBeeATEndpoint_Port;

typedef struct XBeeATEndpoint {
    Link* links[XBEE_PEERS]; /* link of each peer; 0 for an absent peer */
    const XBeeATEndpoint_Port* port;
    void* context;
    U16 address; /* address of this side's modem, MY */
    /* addresses of the peers' modems; the first ground station has address 0 */
    U16 addresses[XBEE_PEERS];
    U32 events;   /* pending events, one bit each */
    Ice_Int size; /* size of the pending message, bytes */
    /* buffer of the receiving task; 0 while no task receives, so that the link keeps messages */
    Ice_Byte* buffer;
    Ice_Byte from;    /* connection of the pending message */
    Ice_Byte ownOpen; /* peers with an open channel of this side, one bit each */
    Ice_Byte held;    /* 1: the link keeps a message that could not be delivered */
    /* connection of the message that is being sent; NOBODY if this connection has ended */
    Ice_Byte offered;
    /* ---- fields for xbee_peers.c ---- */
    Ice_Byte own[XBEE_PEERS]; /* number of the connection that this side opens to each peer */
    /* vehicles: peers that are vehicles. dialed: vehicles that this side dials now. One bit for
     * each peer. */
    Ice_Byte vehicles, dialed;
    U32 dialedAt[XBEE_PEERS]; /* time at which dialing began, ms */
    U32 received[XBEE_PEERS]; /* number of messages that had been received when dialing began */
} XBeeATEndpoint;

/* Registers the transport with the communicator. `name` must be "xbee-at". */
void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char* name, XBeeATEndpoint* self, Link* link,
                         U16 address, const XBeeATEndpoint_Port* port, void* context);

/* Makes a two-way proxy to an object of a peer, like stringToProxy for "IDENTITY:xbee-at -a
 * ADDRESS". The adapter must have no other transport. A program that uses this function instead of
 * stringToProxy is linked without the parser of proxies. */
Ice_Status XBeeATEndpoint_makeProxy(Ice_ObjectAdapterPtr adapter, const char* identity, U16 address,
                                    Ice_ObjectPrxPtr prx);

/* Adds the link of a peer (xbee_peers.c). Calls to any address that belongs to no peer fail. */
void XBeeATEndpoint_addPeer(XBeeATEndpoint* self, int peer, Link* link, U16 address);
/* Declares that a peer is a vehicle (xbee_peers.c). `isGround` is 1 if this side acts as the ground
 * station on the link. */
void XBeeATEndpoint_setVehicle(XBeeATEndpoint* self, int peer, int isGround);
/* Starts a vehicle's link while a call waits for a session with the vehicle; stops the link
 * otherwise. Must be called before each Link_poll, with the lock held. */
void XBeeATEndpoint_dial(XBeeATEndpoint* self, int peer, U32 nowUs);

/* Callbacks for Link_Port, which must be called with the lock held; `self` is the XBeeATEndpoint.
 * `channel` is the channel on the link of the first ground station; for peer n, the caller must add
 * n * LINK_CHANNELS. */
int XBeeATEndpoint_onMessage(void* self, int channel, const U8* data, U32 size);
void XBeeATEndpoint_onChannel(void* self, int channel, int isOpen);
