/* SPDX-License-Identifier: MIT
 *
 * uav_links: the links with the vehicle's peers: what they send, receive and report.
 */
#pragma once

#include "uav_radio_state.h"

#define UAV_BYTE_TIME_US16 1440U /* 111,111 baud */

extern const Link_Port uav_linkPort; /* its context is the UAV_Peer */

/* Forgets all sessions. */
void UAV_resetLinks(void);

/* Sets the limits of the links to the limits of the modem. */
void UAV_limitLinks(void);

/* Gives a packet to the link of the peer that sent it; packets of others are dropped. */
void UAV_onPacketOf(void* context, const U8* bytes, U32 size);

/* Returns 1 if a peer has a session. */
int UAV_isUp(void);

/* Returns the role of the peer that called a servant. */
int UAV_peerOf(const Ice_Current* current);

/* Gives a peer its next key (UAV_setNextKey), for a servant. */
int UAV_nextKey(int role, const U8* key);
