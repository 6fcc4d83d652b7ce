/* SPDX-License-Identifier: MIT
 *
 * uav_radio_state: the state that the files of the radio share: peers, endpoint, and the lock of
 * the links. From the bottom up, these files are uav_radio_state, uav_os, uav_links, uav_fleet
 * (observer, other vehicle, calls to all vehicles) and uav_modem (radio task).
 */
#pragma once

#include "link.h"
#include "ucos_ii.h"
#include "xbee_endpoint.h"

/* Peers by role; `link` is 0 for an absent peer. */
typedef struct UAV_Peer {
    Link* link;
    U16 address;
} UAV_Peer;
extern UAV_Peer uav_peers[];
extern U8 uav_peerCount; /* number of peers in use: 1, or UAV_PEERS with the fleet package */

extern Link uav_link; /* link to the first ground station */
extern XBeeATEndpoint uav_endpoint;
extern OS_EVENT* uav_radioWork; /* signalled when the radio task has work */
extern U32 uav_now;             /* time at which the radio task started its current turn, us */
extern U8 uav_isAnswered;       /* 1 if the modem reports a status for each packet */
/* 1 if other links than the first ground station's must be polled */
extern U8 uav_pollsAll;

void UAV_initState(void);

/* Locks the links and the endpoint; every use of them needs this lock. */
void UAV_lockLink(void* context);
void UAV_unlockLink(void* context);
