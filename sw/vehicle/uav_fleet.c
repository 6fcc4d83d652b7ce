/* SPDX-License-Identifier: MIT
 *
 * uav_fleet: all peers except the first ground station (an observer, another vehicle), and calls to
 * all vehicles. They require API mode, in which each packet has a source address. An observer
 * connects by itself. Another vehicle is dialed when this vehicle calls it.
 */
#include "uav_fleet.h"
#include "link_broadcast.h"
#include "uav.h"
#include "uav_keys.h"
#include "uav_links.h"

#include <string.h>

/* Sizes of the links to these peers, which have smaller buffers: send queue, bytes; received
 * message, bytes; fragments in flight. */
#define OBSERVER_SENDS 8192U
#define OBSERVER_TAKES 1024U
#define OBSERVER_WINDOW 16U
#define VEHICLE_SENDS 1024U
#define VEHICLE_TAKES 512U
#define VEHICLE_WINDOW 4U
#define VEHICLE_MS 3000 /* time for which a report waits for the other vehicle's reply, ms */

static Link observerLink, vehicleLink;
static LINK_BUFFERS(OBSERVER_SENDS, OBSERVER_TAKES, OBSERVER_WINDOW) observerBuffers;
static LINK_BUFFERS(VEHICLE_SENDS, VEHICLE_TAKES, VEHICLE_WINDOW) vehicleBuffers;
static const Link_Config observerConfig = {&uav_linkPort, &uav_peers[UAV_OBSERVER],
                                           UAV_BYTE_TIME_US16, LINK_USE(observerBuffers)};
static const Link_Config vehicleConfig = {&uav_linkPort, &uav_peers[UAV_VEHICLE],
                                          UAV_BYTE_TIME_US16, LINK_USE(vehicleBuffers)};

static U8 toAll[LINK_MAX_FRAME]; /* call to all vehicles that IceC has not accepted yet */
static U8 toAllSize;

/* Adds the peer in this role if the vehicle has one. Returns 1 if a peer was added. */
static int addPeer(int role, Link* link, const Link_Config* config) {
    UAV_Peer* peer = &uav_peers[role];
    const U32 address = UAV_addressOf(role);
    peer->link = 0;
    if (address == UAV_NO_PEER)
        return 0;
    peer->link = link;
    peer->address = (U16)address;
    Link_init(link, config);
    Link_shareRadio(link, &uav_link);
    (void)UAV_giveKeys(role, link);
    return 1;
}

int UAV_addPeers(void) {
    toAllSize = 0;
    uav_peerCount = UAV_PEERS;
    return addPeer(UAV_OBSERVER, &observerLink, &observerConfig) |
           addPeer(UAV_VEHICLE, &vehicleLink, &vehicleConfig);
}

void UAV_usePeers(void) {
    int role;
    for (role = UAV_OBSERVER; role < UAV_PEERS; ++role)
        if (uav_peers[role].link)
            XBeeATEndpoint_addPeer(&uav_endpoint, role, uav_peers[role].link,
                                   uav_peers[role].address);
    if (uav_peers[UAV_VEHICLE].link)
        XBeeATEndpoint_setVehicle(&uav_endpoint, UAV_VEHICLE, UAV_hasGroundsPart());
}

void UAV_dialVehicle(void) {
    if (uav_peers[UAV_VEHICLE].link)
        XBeeATEndpoint_dial(&uav_endpoint, UAV_VEHICLE, uav_now);
}

/* Handles a packet from an unknown source, which may be a call to all vehicles; the same call is
 * accepted only once. While a call waits for IceC, further calls are dropped; later copies of a
 * dropped call may still be accepted. */
static void onAnyPacket(void* context, const U8* bytes, U32 size) {
    if (*bytes != LINK_BROADCAST) {
        UAV_onPacketOf(context, bytes, size);
    } else if (!toAllSize && size <= sizeof toAll) {
        memcpy(toAll, bytes, size);
        size = UAV_openBroadcast(toAll, size);
        if (size && Ice_markBroadcast(toAll + LINK_BROADCAST_HEAD, (Ice_Int)size))
            toAllSize = uav_pollsAll = (U8)size;
    }
}

Radio_OnPacket UAV_receiver(void) {
    return UAV_isOfGroup() ? onAnyPacket : UAV_onPacketOf;
}

int UAV_offerCall(void) {
    if (toAllSize && XBeeATEndpoint_onMessage(&uav_endpoint, XBEE_OWN_CHANNEL,
                                              toAll + LINK_BROADCAST_HEAD, toAllSize) == 0)
        toAllSize = 0;
    return toAllSize != 0; /* the endpoint wakes the radio task when it can accept the call */
}

int UAV_makeVehicleProxy(Ice_ObjectAdapterPtr adapter, Ice_ObjectPrxPtr other) {
    const U32 address = UAV_addressOf(UAV_VEHICLE);
    (void)XBeeATEndpoint_makeProxy(adapter, "uav", (U16)address, other);
    Ice_ObjectPrx_ice_invocationTimeout(other, VEHICLE_MS);
    return address != UAV_NO_PEER;
}
