/* SPDX-License-Identifier: MIT
 *
 * link_session: handshake, reboots, and a peer that has vanished.
 *
 * HELLO carries a nonce; the answer carries the peer's. Both nonces make the session's epoch and
 * the seed of its checksums, so a frame of another session is never taken for one of this. Who
 * answered a HELLO stays in its old session until the first frame of the new one arrives: a HELLO
 * that was delayed on the air cannot end a session. `helloNonce` is the own nonce of the next
 * session.
 */
#include "link.h"

static void makeSession(Link* link, Link_Session* session, const U8* peer, U32 features) {
    session->nonce = link->helloNonce;
    session->peerNonce = Link_get32(peer);
    session->epoch = (U8)Link_mixNonces(session->nonce, session->peerNonce, &session->seed);
    session->features = (U8)(features & LINK_FEATURES);
}

static void enter(Link* link) {
    link->hasCandidate = 0;
    link->heardAt = link->pingAt = link->now;
    link->paceUntil = link->now; /* after a long silence its age would read as a future time */
    link->state = LINK_STATE_UP;
    LINK_COUNT(link, sessions, 1U);
    link->port->state(link->context, LINK_STATE_UP);
}

/* Leaves the session, if there is one; what it was is forgotten, and reported. */
void Link_endSession(Link* link, Link_State next) {
    int wasUp = link->state == LINK_STATE_UP;
    U32 open = link->open;
    int channel;
    link->state = (U8)next;
    link->helloNonce = link->port->random(link->context);
    link->helloAt = link->pingAt = link->now;
    link->helloEvery = LINK_HELLO_FIRST;
    Link_resetReceive(link);
    Link_resetSend(link);
    if (LINK_HEADS)
        Link_resetHeads(link);
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if (open >> channel & 1U)
            link->port->channel(link->context, channel, 0);
    if (wasUp)
        link->port->state(link->context, next);
}

/* The session is over, by the peer's wish or silence. */
void Link_lose(Link* link) {
    Link_endSession(link, link->wanted ? LINK_STATE_CONNECTING : LINK_STATE_IDLE);
}

/* The peer broke the rules: nothing it sent can be trusted, so both sides start afresh. */
void Link_abort(Link* link) {
    U8 frame[LINK_OVERHEAD];
    (void)Link_sendControl(link, frame, LINK_KIND_RST, 0, 0);
    Link_lose(link);
}

void Link_confirmCandidate(Link* link) {
    if (link->state == LINK_STATE_UP)
        Link_endSession(link, LINK_STATE_CONNECTING);
    link->session = link->candidate;
    enter(link);
}

void Link_onHandshake(Link* link, const U8* frame, Link_Kind kind) {
    int isUp = link->state == LINK_STATE_UP;
    if (kind == LINK_KIND_RST) {
        if (isUp && (frame[2] >> 2 & 7U) == link->session.epoch)
            Link_lose(link);
    } else if (frame[1] != LINK_VERSION) {
        return;
    } else if (kind == LINK_KIND_HELLO) {
        U8 answer[LINK_OVERHEAD + 8U];
        Link_Session* session = &link->session;
        /* The same HELLO once more: our answer was lost. */
        if (!isUp || Link_get32(frame + 3) != session->peerNonce) {
            session = &link->candidate;
            makeSession(link, session, frame + 3, frame[2]);
            link->hasCandidate = 1;
        }
        Link_put32(answer + 3, session->nonce);
        Link_put32(answer + 7, session->peerNonce);
        (void)Link_sendControl(link, answer, LINK_KIND_HELLO_ACK, LINK_VERSION, 8);
    } else if (link->state == LINK_STATE_CONNECTING && Link_get32(frame + 7) == link->helloNonce) {
        makeSession(link, &link->session, frame + 3, frame[2]);
        enter(link);
        link->ackDue = link->ackNow = 1; /* the first frame of the session confirms it */
    }
}

void Link_pollSession(Link* link) {
    U8 frame[LINK_OVERHEAD + 4U];
    U32 now = link->now;
    if (link->state == LINK_STATE_CONNECTING && !LINK_BEFORE(now, link->helloAt)) {
        Link_put32(frame + 3, link->helloNonce);
        (void)Link_sendControl(link, frame, LINK_KIND_HELLO, LINK_VERSION, 4);
        link->helloAt = now + link->helloEvery;
        if (link->helloEvery < LINK_HELLO_LAST)
            link->helloEvery *= 2U;
    }
    if (link->state != LINK_STATE_UP || now - link->heardAt < LINK_PING_AFTER)
        return;
    if (now - link->heardAt >= LINK_DEAD_AFTER) {
        Link_lose(link);
    } else if (!LINK_BEFORE(now, link->pingAt)) {
        (void)Link_sendControl(link, frame, LINK_KIND_PING, 0, 0);
        link->pingAt = now + LINK_PING_EVERY;
    }
}
