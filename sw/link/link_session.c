/* SPDX-License-Identifier: MIT
 *
 * link_session: handshake, reboots, and a peer that has vanished.
 *
 * HELLO carries a nonce; the answer carries the peer's. Both nonces make the session's epoch and
 * the seed of its checksums, so a frame of another session is never taken for one of this. Who
 * answered a HELLO stays in its old session until the first frame of the new one arrives: a HELLO
 * that was delayed on the air cannot end a session.
 */
#include "link.h"

/* Both sides compute the same, whoever called first. */
static Link_Session sessionOf(U32 nonce, U32 peerNonce) {
    Link_Session session;
    U8 bytes[4];
    U16 hash;
    Link_put32(bytes, (nonce ^ peerNonce) * 2654435761U + nonce + peerNonce);
    hash = Link_crc(0x1D0FU, bytes, 4);
    session.nonce = nonce;
    session.peerNonce = peerNonce;
    session.seed = hash;
    session.epoch = (U8)(bytes[3] >> 5);
    return session;
}

static void enter(Link* link, Link_Session session, U32 now) {
    link->session = session;
    link->hasCandidate = 0;
    link->heardAt = now;
    link->pingAt = now;
    link->paceUntil = now; /* after a long silence its age would read as a future time */
    Link_resetSend(link);
    Link_resetReceive(link);
    link->state = LINK_STATE_UP;
    ++link->statistics.sessions;
    link->port->state(link->context, LINK_STATE_UP);
}

void Link_endSession(Link* link, Link_State next, U32 now) {
    int wasUp = link->state == LINK_STATE_UP;
    link->state = next;
    link->helloNonce = link->port->random(link->context);
    link->helloAt = now;
    link->helloEvery = LINK_HELLO_FIRST;
    link->pingAt = now;
    if (wasUp) {
        U8 open = link->open;
        int channel;
        Link_resetReceive(link);
        Link_dropQueue(link);
        for (channel = 0; channel < LINK_CHANNELS; ++channel)
            if (open >> channel & 1)
                link->port->channel(link->context, channel, 0);
        link->port->state(link->context, next);
    }
}

void Link_confirmCandidate(Link* link, U32 now) {
    Link_Session session = link->candidate;
    link->hasCandidate = 0;
    if (link->state == LINK_STATE_UP)
        Link_endSession(link, LINK_STATE_CONNECTING, now);
    enter(link, session, now);
}

static void answerHello(Link* link, Link_Session session, U32 now) {
    U8 payload[8];
    Link_put32(payload, session.nonce);
    Link_put32(payload + 4, session.peerNonce);
    (void)Link_sendControl(link, LINK_KIND_HELLO_ACK, LINK_VERSION, payload, 8, now);
}

void Link_onHello(Link* link, const U8* frame, U32 now) {
    U32 peer = Link_get32(frame + 3);
    if (frame[1] != LINK_VERSION)
        return;
    if (link->state == LINK_STATE_UP && peer == link->session.peerNonce) {
        answerHello(link, link->session, now); /* our answer was lost */
        return;
    }
    if (!link->hasCandidate || peer != link->candidate.peerNonce) {
        U32 own = link->state == LINK_STATE_CONNECTING ? link->helloNonce
                                                       : link->port->random(link->context);
        link->candidate = sessionOf(own, peer);
        link->hasCandidate = 1;
    }
    answerHello(link, link->candidate, now);
}

void Link_onHelloAck(Link* link, const U8* frame, U32 now) {
    if (frame[1] != LINK_VERSION || link->state != LINK_STATE_CONNECTING ||
        Link_get32(frame + 7) != link->helloNonce)
        return;
    enter(link, sessionOf(link->helloNonce, Link_get32(frame + 3)), now);
    link->ackDue = link->ackNow = 1; /* the first frame of the session confirms it */
}

void Link_onReset(Link* link, U8 epoch, U32 now) {
    if (link->state == LINK_STATE_UP && epoch == link->session.epoch)
        Link_endSession(link, link->wanted ? LINK_STATE_CONNECTING : LINK_STATE_IDLE, now);
}

void Link_pollSession(Link* link, U32 now) {
    U8 nonce[4];
    if (link->state == LINK_STATE_CONNECTING && !Link_isBefore(now, link->helloAt)) {
        Link_put32(nonce, link->helloNonce);
        (void)Link_sendControl(link, LINK_KIND_HELLO, LINK_VERSION, nonce, 4, now);
        link->helloAt = now + link->helloEvery;
        if (link->helloEvery < LINK_HELLO_LAST)
            link->helloEvery *= 2U;
    }
    if (link->state != LINK_STATE_UP || Link_isBefore(now, link->heardAt + LINK_PING_AFTER))
        return;
    if (!Link_isBefore(now, link->heardAt + LINK_DEAD_AFTER)) {
        Link_endSession(link, link->wanted ? LINK_STATE_CONNECTING : LINK_STATE_IDLE, now);
    } else if (!Link_isBefore(now, link->pingAt)) {
        (void)Link_sendControl(link, LINK_KIND_PING, 0, 0, 0, now);
        link->pingAt = now + LINK_PING_EVERY;
    }
}

U32 Link_sessionDeadline(const Link* link, U32 now) {
    U32 at;
    if (link->state == LINK_STATE_IDLE)
        return 0xFFFFFFFFU;
    if (link->state == LINK_STATE_CONNECTING) {
        at = link->helloAt;
    } else {
        at = link->heardAt + LINK_PING_AFTER;
        if (Link_isBefore(at, link->pingAt))
            at = link->pingAt;
    }
    return Link_isBefore(at, now) ? 0 : at - now;
}
