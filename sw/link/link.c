/* SPDX-License-Identifier: MIT
 *
 * link: the layer's entrance: life cycle and time.
 */
#include "link.h"

#include <string.h>

void Link_init(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16) {
    memset(link, 0, sizeof *link);
    link->port = port;
    link->context = context;
    link->byteTimeUs16 = byteTimeUs16;
    link->longest = LINK_MAX_PAYLOAD;
    Link_endSession(link, LINK_STATE_IDLE);
}

void Link_limitFrame(Link* link, U32 bytes) {
    link->longest = (U8)(bytes - LINK_OVERHEAD);
}

void Link_start(Link* link, U32 nowUs) {
    link->now = nowUs;
    if (link->wanted)
        return;
    link->wanted = 1;
    link->paceUntil = nowUs;
    if (link->state == LINK_STATE_IDLE) {
        Link_endSession(link, LINK_STATE_CONNECTING);
        link->port->state(link->context, LINK_STATE_CONNECTING);
    }
}

void Link_stop(Link* link, U32 nowUs) {
    U8 frame[LINK_OVERHEAD];
    link->now = nowUs;
    link->wanted = 0;
    link->hasCandidate = 0;
    if (link->state == LINK_STATE_UP)
        (void)Link_sendControl(link, frame, LINK_KIND_BYE, 0, 0);
    Link_endSession(link, LINK_STATE_IDLE);
}

Link_State Link_state(const Link* link) {
    return (Link_State)link->state;
}

void Link_poll(Link* link, U32 nowUs) {
    link->now = nowUs;
    Link_pollInput(link);
    Link_pollSession(link);
    if (link->state != LINK_STATE_UP)
        return;
    Link_pollReceive(link);
    Link_pollSend(link);
    Link_pollAck(link);
}

static U32 sooner(U32 wait, U32 at, U32 now) {
    if (LINK_BEFORE(at, now))
        at = now;
    return at - now < wait ? at - now : wait;
}

U32 Link_deadline(const Link* link, U32 nowUs) {
    U32 soon = nowUs + LINK_POLL_EVERY;
    U32 wait = 0xFFFFFFFFU;
    U32 at;
    if (link->inputCount)
        wait = sooner(wait, link->inputAt + LINK_FRAME_GAP, nowUs);
    if (link->state == LINK_STATE_CONNECTING)
        wait = sooner(wait, link->helloAt, nowUs);
    if (link->state != LINK_STATE_UP)
        return wait;
    at = link->heardAt + LINK_PING_AFTER;
    wait = sooner(wait, LINK_BEFORE(at, link->pingAt) ? link->pingAt : at, nowUs);
    if (link->sendBase != link->sendNext)
        wait = sooner(wait, link->timerAt, nowUs);
    if (link->work) {
        at = link->paceUntil - LINK_SLACK(link);
        wait = sooner(wait, LINK_BEFORE(at, soon) ? soon : at, nowUs);
    }
    if (link->ackDue)
        wait = sooner(wait, link->ackNow ? soon : link->ackAt, nowUs);
    if (link->messageHeld)
        wait = sooner(wait, nowUs + LINK_OFFER_EVERY, nowUs);
    return wait;
}

const Link_Statistics* Link_statistics(const Link* link) {
    return &link->statistics;
}
