/* SPDX-License-Identifier: MIT
 *
 * xbee_peers: all peers of the endpoint except the first ground station. It stores their addresses
 * and manages calls to other vehicles, for which this side starts the session. Only xbee_endpoint.c
 * uses these functions.
 *
 * A program with a single ground station is linked with xbee_one_peer.c instead of xbee_peers.c.
 */
#pragma once

#include "xbee_endpoint.h"

/* Returns the peer with this address; -1 if it is unknown. */
int XBeePeers_find(const XBeeATEndpoint* self, U16 address);

/* Starts or stops dialing a vehicle; dialing also stops after the time-out of one call. Returns 1
 * if the peer is a vehicle that is being dialed. Ground stations are never dialed. */
int XBeePeers_setDialed(XBeeATEndpoint* self, int peer, int isDialed);

/* Returns 1 if this side still dials the vehicle, no session exists, and no message has arrived
 * since dialing began. A session can end without a message if both sides start a session at the
 * same time. The callers then continue to wait. */
int XBeePeers_isDialedOn(const XBeeATEndpoint* self, int peer);
