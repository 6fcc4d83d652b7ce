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
    link->state = LINK_STATE_IDLE;
    Link_resetSend(link);
    Link_resetReceive(link);
}

void Link_start(Link* link, U32 nowUs) {
    if (link->wanted)
        return;
    link->wanted = 1;
    link->paceUntil = nowUs;
    if (link->state == LINK_STATE_IDLE) {
        Link_endSession(link, LINK_STATE_CONNECTING, nowUs);
        link->port->state(link->context, LINK_STATE_CONNECTING);
    }
}

void Link_stop(Link* link, U32 nowUs) {
    link->wanted = 0;
    link->hasCandidate = 0;
    if (link->state == LINK_STATE_UP)
        (void)Link_sendControl(link, LINK_KIND_BYE, 0, 0, 0, nowUs);
    Link_endSession(link, LINK_STATE_IDLE, nowUs);
}

Link_State Link_state(const Link* link) {
    return link->state;
}

void Link_poll(Link* link, U32 nowUs) {
    Link_pollReceive(link, nowUs);
    Link_pollSession(link, nowUs);
    Link_pollSend(link, nowUs);
}

U32 Link_deadline(const Link* link, U32 nowUs) {
    U32 wait = Link_sessionDeadline(link, nowUs);
    U32 other = Link_sendDeadline(link, nowUs);
    if (other < wait)
        wait = other;
    other = Link_receiveDeadline(link, nowUs);
    return other < wait ? other : wait;
}

const Link_Statistics* Link_statistics(const Link* link) {
    return &link->statistics;
}
