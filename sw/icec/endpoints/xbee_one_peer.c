/* SPDX-License-Identifier: MIT
 *
 * xbee_one_peer: replaces xbee_peers.c in a program with only one ground station.
 */
#include "xbee_peers.h"

int XBeePeers_find(const XBeeATEndpoint* self, U16 address) {
    (void)self;
    (void)address;
    return 0;
}

int XBeePeers_setDialed(XBeeATEndpoint* self, int peer, int isDialed) {
    (void)self;
    (void)peer;
    (void)isDialed;
    return 0;
}

int XBeePeers_isDialedOn(const XBeeATEndpoint* self, int peer) {
    (void)self;
    (void)peer;
    return 0;
}
