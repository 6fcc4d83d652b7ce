/* SPDX-License-Identifier: MIT
 *
 * link_session: makes and ends sessions: handshake, reboots, and a peer that has vanished.
 *
 * HELLO carries a nonce; the answer carries the peer's. Both nonces make the session's epoch and
 * the seed of its checksums, so a frame of another session is never taken for one of this. A side
 * that has answered a HELLO stays in its old session until the first frame of the new one arrives:
 * a HELLO that was delayed on the air cannot end a session.
 */
#include "link.h"

/* Prepares the session that the peer's nonce and the own one make. */
static void makeCandidate(Link* link, U32 peerNonce, U32 features) {
    Link_Session* session = &link->handshake.candidate;
    session->nonce = link->handshake.nonce;
    session->peerNonce = peerNonce;
    session->key = link_sessionKey(session->nonce, peerNonce);
    session->features = (U8)(features & LINK_FEATURES);
    link->handshake.hasCandidate = 1;
}

/* Ends the session, if there is one: clears its state and reports its end. */
void link_endSession(Link* link, Link_State next) {
    int wasUp = link->state == LINK_STATE_UP;
    U32 open = link->open;
    int channel;
    link->state = (U8)next;
    link->handshake.nonce = link->port->random(link->context);
    link->handshake.helloAt = link->pingAt = link->now;
    link->handshake.helloEvery = LINK_HELLO_FIRST;
    link_resetReceiver(link);
    link_resetSender(link);
    link_resetHeads(link);
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if (open >> channel & 1U)
            link->port->channel(link->context, channel, 0);
    if (wasUp)
        link->port->state(link->context, next);
}

void link_lose(Link* link) {
    link_endSession(link, link->wanted ? LINK_STATE_CONNECTING : LINK_STATE_IDLE);
}

void link_abort(Link* link) {
    U8 frame[LINK_OVERHEAD];
    (void)link_sendControl(link, frame, LINK_KIND_RST, 0, 0);
    link_lose(link);
}

void link_confirmCandidate(Link* link) {
    if (link->state == LINK_STATE_UP)
        link_endSession(link, LINK_STATE_CONNECTING);
    link->session = link->handshake.candidate;
    link->handshake.hasCandidate = 0;
    link->heardAt = link->pingAt = link->now;
    link->paceUntil = link->now; /* after a long silence its age would read as a future time */
    link->state = LINK_STATE_UP;
    ++link->statistics.sessions;
    link->port->state(link->context, LINK_STATE_UP);
}

static void onHello(Link* link, U32 peerNonce, U32 features) {
    U8 answer[LINK_OVERHEAD + 8U];
    Link_Session* session = &link->session;
    /* A HELLO that comes again means that the answer was lost, and gets the same one. */
    if (link->state != LINK_STATE_UP || peerNonce != session->peerNonce) {
        session = &link->handshake.candidate;
        makeCandidate(link, peerNonce, features);
    }
    link_put32(answer + LINK_HEADER, session->nonce);
    link_put32(answer + LINK_HEADER + 4U, session->peerNonce);
    (void)link_sendControl(link, answer, LINK_KIND_HELLO_ACK, LINK_VERSION, 8);
}

void link_onHandshake(Link* link, const U8* frame, Link_Kind kind) {
    const U8* payload = frame + LINK_HEADER;
    if (kind == LINK_KIND_RST) {
        if (link->state == LINK_STATE_UP && LINK_EPOCH(frame) == LINK_KEY_EPOCH(link->session.key))
            link_lose(link);
    } else if (frame[1] != LINK_VERSION) {
        return;
    } else if (kind == LINK_KIND_HELLO) {
        onHello(link, link_get32(payload), frame[2]);
    } else if (link->state == LINK_STATE_CONNECTING &&
               link_get32(payload + 4) == link->handshake.nonce) {
        makeCandidate(link, link_get32(payload), frame[2]);
        link_confirmCandidate(link);
        link->receiver.ackDue = link->receiver.ackNow = 1; /* this first frame confirms it */
    }
}

void link_pollSession(Link* link) {
    U8 frame[LINK_OVERHEAD + 4U];
    Link_Handshake* handshake = &link->handshake;
    U32 now = link->now;
    if (link->state == LINK_STATE_CONNECTING && !LINK_BEFORE(now, handshake->helloAt)) {
        link_put32(frame + LINK_HEADER, handshake->nonce);
        (void)link_sendControl(link, frame, LINK_KIND_HELLO, LINK_VERSION, 4);
        handshake->helloAt = now + handshake->helloEvery;
        if (handshake->helloEvery < LINK_HELLO_LAST)
            handshake->helloEvery *= 2U;
    }
    if (link->state != LINK_STATE_UP || now - link->heardAt < LINK_PING_AFTER)
        return;
    if (now - link->heardAt >= LINK_DEAD_AFTER) {
        link_lose(link);
    } else if (!LINK_BEFORE(now, link->pingAt)) {
        (void)link_sendControl(link, frame, LINK_KIND_PING, 0, 0);
        link->pingAt = now + LINK_PING_EVERY;
    }
}
