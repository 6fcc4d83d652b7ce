/* SPDX-License-Identifier: MIT
 *
 * uav_radio_state: the state that the files of the radio share: peers, endpoint, the link's lock.
 * Those files are, from the bottom up: uav_radio_state, uav_os, uav_links, uav_fleet (observer,
 * other vehicle, calls to all vehicles) and uav_modem (radio task).
 */
#pragma once

#include "link.h"
#include "ucos_ii.h"
#include "xbee_endpoint.h"

/* A peer by its role; one that is absent has no link. */
typedef struct UAV_Peer {
    Link* link;
    U16 address;
} UAV_Peer;
extern UAV_Peer uav_peers[];
extern U8 uav_peerCount; /* peers in use: 1, or UAV_PEERS with the fleet package */

extern Link uav_link; /* link of the first ground */
extern XBeeATEndpoint uav_endpoint;
extern OS_EVENT* uav_radioWork; /* the radio task has something to do */
extern U32 uav_now;             /* time of the radio task's current turn, us */
extern U8 uav_isAnswered;       /* the modem answers for each packet */
extern U8 uav_pollsAll;         /* not only the first ground's link must be polled */

void UAV_initState(void);

/* Lock around every use of the links and the endpoint. */
void UAV_lockLink(void* context);
void UAV_unlockLink(void* context);
