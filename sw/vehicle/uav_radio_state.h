/* SPDX-License-Identifier: MIT
 *
 * uav_radio_state: the state that the files of the radio share: peers, endpoint, and the lock of
 * the links. The files are listed in an order in which each file depends only on earlier files:
 * uav_radio_state, uav_os, uav_links, uav_fleet (observer, other vehicle, calls to all vehicles),
 * uav_modem (radio task).
 */
#pragma once

#include "link.h"
#include "ucos_ii.h"
#include "xbee_endpoint.h"

/* A peer, indexed by its role; `link` is 0 if the peer is absent. */
typedef struct UAV_Peer {
    Link* link;
    U16 address;
} UAV_Peer;
extern UAV_Peer uav_peers[];
extern U8 uav_peerCount; /* number of peers in use: 1, or UAV_PEERS with the fleet package */

extern Link uav_link; /* link to the first ground station */
extern XBeeATEndpoint uav_endpoint;
extern OS_EVENT* uav_radioWork; /* semaphore that is posted when there is work for the radio task */
extern U32 uav_now;             /* time at which the radio task began its current pass, us */
extern U8 uav_isAnswered;       /* 1 if the modem reports a status for each packet */
/* 1 if all links must be polled, not only the link to the first ground station */
extern U8 uav_pollsAll;

void UAV_initState(void);

/* Locks the links and the endpoint. This lock must be held whenever they are used. */
void UAV_lockLink(void* context);
void UAV_unlockLink(void* context);
