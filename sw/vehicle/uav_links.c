/* SPDX-License-Identifier: MIT
 *
 * uav_links: the links to the vehicle's peers: sending, receiving, and changes of the links'
 * states.
 */
#include "uav_links.h"
#include "radio.h"
#include "uav.h"
#include "uav_keys.h"

/* limit of the packets that were sent and have no status yet */
#define MOST_UNANSWERED 2U

static U8 areUp; /* peers with a session, one bit each */

/* Sends a packet. Transparent mode only serves the first ground station. In this mode, at most one
 * packet waits for the line, so that the link layer notices how fast the modem is, and chooses the
 * next packet as late as possible. */
static int transmit(void* peer, const U8* frame, U32 size) {
    U32 wait, i;
    if (!uav_isAnswered)
        return Radio_waiting() > 1U || Radio_transmit(0, frame, size);
    wait = Link_randomWait(&uav_link);
    for (i = 1; areUp >> i; ++i)
        if (areUp >> i & 1) {
            const U32 other = Link_randomWait(uav_peers[i].link);
            wait = other > wait ? other : wait;
        }
    Radio_setWait(wait);
    Radio_setTarget(((const UAV_Peer*)peer)->address);
    return Radio_transmit(0, frame, size);
}

static int roleOf(const void* peer) {
    return (int)((const UAV_Peer*)peer - uav_peers);
}

static int onMessage(void* peer, int channel, const U8* data, U32 size) {
    return XBeeATEndpoint_onMessage(&uav_endpoint, roleOf(peer) * LINK_CHANNELS + channel, data,
                                    size);
}

static void onChannel(void* peer, int channel, int isOpen) {
    XBeeATEndpoint_onChannel(&uav_endpoint, roleOf(peer) * LINK_CHANNELS + channel, isOpen);
}

static void onState(void* peer, Link_State state) {
    const U32 role = (U32)roleOf(peer);
    areUp = (U8)((areUp & ~(1U << role)) | (U32)(state == LINK_STATE_UP) << role);
    /* polls all peers, because a key may have to be confirmed after the session has begun */
    uav_pollsAll = 1;
}

const Link_Port uav_linkPort = {transmit, UAV_random, onMessage, onChannel, onState, 0, 0};

int UAV_peerOf(const Ice_Current* current) {
    return current->connection / LINK_CHANNELS;
}

int UAV_nextKey(int role, const U8* key) {
    int isSet;
    UAV_lockLink(0);
    isSet = UAV_setNextKey(role, uav_peers[role].link, key);
    UAV_unlockLink(0);
    return isSet;
}

void UAV_limitLinks(void) {
    const UAV_Peer* peer;
    for (peer = uav_peers; peer < uav_peers + uav_peerCount; ++peer)
        if (peer->link) {
            Link_limitFrame(peer->link, uav_modemKey ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME);
            Link_expectAnswers(peer->link, uav_isAnswered ? MOST_UNANSWERED : 0U);
        }
}

void UAV_onPacketOf(void* context, const U8* bytes, U32 size) {
    const U32 source = Radio_source();
    const UAV_Peer* peer = uav_peers;
    (void)context;
    while (peer->address != source || !peer->link)
        if (++peer == uav_peers + uav_peerCount)
            return;
    Link_receive(peer->link, bytes, size, uav_now);
}

void UAV_resetLinks(void) {
    areUp = 0;
}

int UAV_isUp(void) {
    return areUp;
}
