/* SPDX-License-Identifier: MIT
 *
 * uav_links: the vehicle's peers and their links, for the files of the radio, from the bottom up:
 * uav_state.c, uav_os.c, uav_links.c, uav_fleet.c (observer, other vehicle, calls to all vehicles)
 * and uav_modem.c (radio task). In firmware for one ground station
 * without/without_fleet.c replaces uav_fleet.c.
 */
#pragma once

#include "link.h"
#include "radio.h"
#include "uav_private.h"

#define UAV_BYTE_TIME_US16 1440U /* 111,111 baud */

/* A peer by its role; one that is absent has no link. */
typedef struct UAV_Peer {
    Link* link;
    U16 address;
} UAV_Peer;
extern UAV_Peer uav_peers[];
extern U8 uav_peerCount; /* peers in use: 1, or UAV_PEERS with the fleet package */

extern XBeeATEndpoint uav_endpoint;
extern const Link_Port uav_linkPort; /* its context is the UAV_Peer */
extern U32 uav_now;                  /* time of the radio task's current turn, us */
extern U8 uav_isAnswered;            /* the radio answers for each packet */
extern U8 uav_pollsAll;              /* links other than the first ground's must be polled */

/* ---- uav_state.c ---- */
void UAV_initState(void);
void UAV_lockLink(void* context);
void UAV_unlockLink(void* context);

/* ---- uav_links.c ---- */
/* Forgets all sessions. */
void UAV_resetLinks(void);
/* Sets the limits of the links to the modem's. */
void UAV_limitLinks(void);
/* Passes a packet to the link of its source; other packets are dropped. */
void UAV_onPacketOf(void* context, const U8* bytes, U32 size);
/* Returns 1 if a peer has a session. */
int UAV_isUp(void);

/* ---- uav_fleet.c ---- */
/* Starts the links of the peers besides the first ground. Returns how many there are. */
int UAV_addPeers(void);
/* Makes these peers known to the endpoint. */
void UAV_usePeers(void);
/* Starts or stops connecting to the other vehicle. */
void UAV_seekVehicle(void);
/* Offers a call to all vehicles to IceC. Returns 1 if it waits. */
int UAV_offerCall(void);
/* Returns the receiver of packets in API mode. */
Radio_OnPacket UAV_receiver(void);

/* ---- uav_os.c ---- */
extern const XBeeATEndpoint_Port uav_endpointPort;
void UAV_initEndpointOs(void);
