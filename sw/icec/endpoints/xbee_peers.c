/* SPDX-License-Identifier: MIT
 *
 * xbee_peers: manages several peers, and dials other vehicles.
 */
#include "xbee_peers.h"

void XBeeATEndpoint_addPeer(XBeeATEndpoint* self, int peer, Link* link, U16 address) {
    self->links[peer] = link;
    self->addresses[peer] = address;
    self->own[peer] = (Ice_Byte)(peer * LINK_CHANNELS + XBEE_OWN_CHANNEL);
}

void XBeeATEndpoint_setVehicle(XBeeATEndpoint* self, int peer, int isGround) {
    self->vehicles = (Ice_Byte)(self->vehicles | 1 << peer);
    if (isGround)
        self->own[peer] = (Ice_Byte)(peer * LINK_CHANNELS);
}

int XBeePeers_find(const XBeeATEndpoint* self, U16 address) {
    int peer = XBEE_PEERS - 1;
    while (peer >= 0 && (!self->links[peer] || self->addresses[peer] != address))
        --peer;
    return peer;
}

int XBeePeers_setDialed(XBeeATEndpoint* self, int peer, int isDialed) {
    const int bit = isDialed ? self->vehicles & 1 << peer : 0;
    self->dialed = (Ice_Byte)((self->dialed & ~(1 << peer)) | bit);
    self->dialedAt[peer] = self->port->nowMs(self->context);
    self->received[peer] = Link_statistics(self->links[peer])->messagesReceived;
    return bit != 0;
}

int XBeePeers_isDialedOn(const XBeeATEndpoint* self, int peer) {
    const Link* link = self->links[peer];
    return (self->dialed >> peer & 1) && Link_state(link) != LINK_STATE_UP &&
           Link_statistics(link)->messagesReceived == self->received[peer];
}
