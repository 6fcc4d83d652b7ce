/* SPDX-License-Identifier: MIT
 *
 * uav_links: manages the links to the vehicle's peers: sends and receives packets, and records
 * which peers have a session.
 */
#pragma once

#include "uav_radio_state.h"

#define UAV_BYTE_TIME_US16 1440U /* 111,111 baud */

/* functions that each link calls; their context is the UAV_Peer of the link */
extern const Link_Port uav_linkPort;

/* Ends all sessions without a message to the peers. */
void UAV_resetLinks(void);

/* Sets the largest frame, and the number of packets without a status, to the limits of the
 * modem. */
void UAV_limitLinks(void);

/* Passes a packet to the link of the peer that sent it. Drops packets from unknown peers. */
void UAV_onPacketOf(void* context, const U8* bytes, U32 size);

/* Returns a number other than 0 if at least one peer has a session. */
int UAV_isUp(void);

/* Returns the role of the peer that called a servant. */
int UAV_peerOf(const Ice_Current* current);

/* Gives a peer its next key (UAV_setNextKey); called by a servant. */
int UAV_nextKey(int role, const U8* key);
