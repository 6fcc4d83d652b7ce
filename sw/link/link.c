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
    link->overhead = LINK_OVERHEAD;
    link->longest = LINK_MAX_PAYLOAD;
    link_endSession(link, LINK_STATE_IDLE);
}

void Link_limitFrame(Link* link, U32 bytes) {
    link->longest = (U8)(bytes - link->overhead);
}

#if LINK_SECURE

void Link_setKey(Link* link, int slot, const U8* key) {
    link->longest = (U8)(link->longest + link->overhead - LINK_SECURE_OVERHEAD);
    if (!LINK_IS_SECURE(link)) {
        link->overhead = LINK_SECURE_OVERHEAD;
        link->handshake.slot = 1; /* the first HELLO uses slot 0 */
        link_drawNonce(link);     /* a longer nonce */
    }
    if (Link_keyInUse(link) == slot)
        link_lose(link);
    link_setSecret(&link->secrets, slot, key);
}

int Link_keyInUse(const Link* link) {
    return LINK_IS_SECURE(link) && link->state == LINK_STATE_UP ? link->session.slot : -1;
}

#endif

void Link_start(Link* link, U32 nowUs) {
    link->now = nowUs;
    if (link->wanted)
        return;
    link->wanted = 1;
    link->paceUntil = nowUs;
    if (link->state == LINK_STATE_IDLE) {
        link_endSession(link, LINK_STATE_CONNECTING);
        link->port->state(link->context, LINK_STATE_CONNECTING);
    }
}

void Link_stop(Link* link, U32 nowUs) {
    U8 frame[LINK_MAX_OVERHEAD];
    link->now = nowUs;
    link->wanted = 0;
    link->handshake.hasCandidate = 0;
    if (link->state == LINK_STATE_UP)
        (void)link_sendControl(link, frame, LINK_KIND_BYE, 0, 0, 0);
    link_endSession(link, LINK_STATE_IDLE);
    link->pingAt = nowUs; /* what the peer sent before it heard the BYE asks for no answer */
}

Link_State Link_state(const Link* link) {
    return (Link_State)link->state;
}

void Link_poll(Link* link, U32 nowUs) {
    link->now = nowUs;
    link_pollInput(link);
    link_pollSession(link);
    if (LINK_IS_SECURE(link))
        link_pollKeyed(link);
    if (link->state == LINK_STATE_UP && !link_pollReceiver(link))
        link_abort(link);
    if (link->state != LINK_STATE_UP)
        return;
    link_pollSender(link);
    if (!link->sender.hasWork) /* else the next fragment takes it along */
        link_pollAck(link);
    (void)link_flush(link);
}

/* Return the earlier and the later of two times. */
#define SOONER(a, b) (LINK_BEFORE(a, b) ? (a) : (b))
#define LATER(a, b) (LINK_BEFORE(a, b) ? (b) : (a))

#define FAR 0x7FFFFFFFU

U32 Link_deadline(const Link* link, U32 nowUs) {
    const Link_Sender* sender = &link->sender;
    const Link_Receiver* receiver = &link->receiver;
    U32 soon = nowUs + LINK_POLL_EVERY;
    U32 first = nowUs + FAR;
    U32 at;
    if (link->parser.count)
        first = link->parser.at + LINK_FRAME_GAP;
    if (link->state == LINK_STATE_CONNECTING || link->handshake.isUnconfirmed)
        first = SOONER(link->handshake.helloAt, first);
    at = link->handshake.firstAnswer + LINK_NONCE_LIFE;
    if (link->handshake.isAnswered)
        first = SOONER(at, first);
    if (link->state == LINK_STATE_UP) {
        at = link->heardAt + LINK_PING_AFTER;
        if (LINK_IS_SECURE(link) && LINK_BEFORE(link->watch.provenAt + LINK_PROOF_AFTER, at))
            at = link->watch.provenAt + LINK_PROOF_AFTER;
        at = LATER(at, link->pingAt);
        first = SOONER(at, first);
        if (link->packed)
            first = soon;
        if (sender->base != sender->next)
            first = SOONER(sender->timerAt, first);
        if (sender->hasWork) {
            at = link->paceUntil - link->slack;
            at = LATER(at, soon);
            first = SOONER(at, first);
        }
        if (receiver->ackDue) {
            at = receiver->ackNow ? soon : receiver->ackAt;
            first = SOONER(at, first);
        }
        at = nowUs + LINK_OFFER_EVERY;
        if (receiver->isHeld)
            first = SOONER(at, first);
    }
    if (first == nowUs + FAR)
        return 0xFFFFFFFFU;
    return LINK_BEFORE(first, nowUs) ? 0 : first - nowUs;
}

const Link_Statistics* Link_statistics(const Link* link) {
    return &link->statistics;
}
