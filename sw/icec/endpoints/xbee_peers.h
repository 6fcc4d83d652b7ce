/* SPDX-License-Identifier: MIT
 *
 * xbee_peers: the endpoint's peers besides the first ground station: their addresses, and calls to
 * other vehicles, for which this side starts the session. Only xbee_endpoint.c uses it. * A program
 * with one ground station links xbee_one_peer.c instead of xbee_peers.c.
 */
#pragma once

#include "xbee_endpoint.h"

/* Returns the peer with this address; -1 if it is unknown. */
int XBeePeers_find(const XBeeATEndpoint* self, U16 address);

/* Starts or stops dialing a vehicle; dialing also ends after the time of one call. Returns 1 if the
 * peer is a vehicle that is dialed now. Ground stations are never dialed. */
int XBeePeers_setDialed(XBeeATEndpoint* self, int peer, int isDialed);

/* Returns 1 if a session ended before anything arrived in it, and dialing continues. This happens
 * if both sides start a session at the same time. Callers are not informed. */
int XBeePeers_isDialedOn(const XBeeATEndpoint* self, int peer);
