/* SPDX-License-Identifier: MIT
 *
 * xbee_peers: the peers of the endpoint besides the first ground: their addresses, and calls to
 * other vehicles, for which this side begins a session. For xbee_endpoint.c.
 *
 * xbee_peers.c serves several peers; a program with one ground links xbee_one_peer.c instead.
 */
#pragma once

#include "xbee_endpoint.h"

/* Returns the peer with this address; -1: unknown. */
int XBeePeers_find(const XBeeATEndpoint* self, U16 address);

/* Starts or stops dialing a vehicle; dialing ends by itself after the time of one call. Returns 1
 * if the peer is dialed; ground stations are not. */
int XBeePeers_setDialed(XBeeATEndpoint* self, int peer, int isDialed);

/* Returns 1 if a session ended before anything arrived in it, and dialing continues. This happens
 * if both sides have begun a session. Callers are not informed. */
int XBeePeers_isDialedOn(const XBeeATEndpoint* self, int peer);
