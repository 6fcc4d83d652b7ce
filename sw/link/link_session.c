/* SPDX-License-Identifier: MIT
 *
 * link_session: makes and ends sessions: handshake, reboots, a peer that has vanished.
 *
 * HELLO carries a nonce; the answer carries the peer's. Both nonces make the session's epoch and
 * the seed of its checksums, so a frame of another session is never taken for one of this. A side
 * that has answered a HELLO stays in its old session until the first frame of the new one arrives:
 * a HELLO that was delayed on the air cannot end a session.
 *
 * All this is proven with a key (link_keyed.c).
 */
#include "link.h"

#include <string.h>

void link_makeCandidate(Link* link, const U8* peerNonce, U32 features) {
    Link_Session* session = &link->handshake.candidate;
    memcpy(session->nonce, link->handshake.nonce, LINK_NONCE_BYTES);
    memset(session->peerNonce, 0, LINK_NONCE_BYTES);
    memcpy(session->peerNonce, peerNonce, link_nonceBytes(link));
    session->key = link_sessionKey(link_get32(session->nonce), link_get32(peerNonce));
    session->features = (U8)(features & LINK_FEATURES);
}

U32 link_nonceBytes(const Link* link) {
    return LINK_IS_SECURE(link) ? LINK_NONCE_BYTES : 4U;
}

void link_drawNonce(Link* link) {
    U32 i;
    for (i = 0; i < link_nonceBytes(link); i += 4U)
        link_put32(link->handshake.nonce + i, link->port->random(link->context));
    link->handshake.isAnswered = 0;
}

void link_sendHandshake(Link* link, const Link_Session* session, Link_Kind kind) {
    U8 frame[LINK_MAX_OVERHEAD + 2U * LINK_NONCE_BYTES];
    U32 bytes = link_nonceBytes(link);
    memcpy(frame + LINK_HEADER, session->nonce, bytes);
    memcpy(frame + LINK_HEADER + bytes, session->peerNonce, bytes);
    (void)link_sendControl(link, frame, kind, LINK_VERSION, 2U * bytes, LINK_FEATURES);
}

void link_sendHello(Link* link, U32 version) {
    U8 frame[LINK_MAX_OVERHEAD + LINK_NONCE_BYTES];
    U32 bytes = link_nonceBytes(link);
    memcpy(frame + LINK_HEADER, link->handshake.nonce, bytes);
    (void)link_sendControl(link, frame, LINK_KIND_HELLO, version, bytes, LINK_FEATURES);
}

void link_call(Link* link) {
    U32 set = link->secrets.set;
    if (LINK_IS_SECURE(link)) {
        if (!set)
            return;
        link->handshake.slot = (U8)(set == 3U ? !link->handshake.slot : set >> 1);
    }
    link_sendHello(link, LINK_VERSION);
}

/* Ends the session, if there is one: clears its state and reports its end. */
void link_endSession(Link* link, Link_State next) {
    int wasUp = link->state == LINK_STATE_UP;
    U32 open = link->open;
    int channel;
    link->state = (U8)next;
    link_drawNonce(link);
    link->handshake.isUnconfirmed = 0;
    link->handshake.helloAt = link->now;
    link->pingAt = link->now - LINK_HELLO_FIRST;
    link->handshake.helloEvery = LINK_HELLO_FIRST;
    link_resetReceiver(link);
    link_resetSender(link);
    link_resetHeads(link);
    memset(&link->session.keys, 0, sizeof link->session.keys);
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
    U8 frame[LINK_MAX_OVERHEAD];
    if (LINK_IS_SECURE(link))
        (void)link_sendControl(link, frame, LINK_KIND_BYE, 0, 0, 0);
    else
        (void)link_sendControl(link, frame, LINK_KIND_RST, 0, 0, LINK_FEATURES);
    link_lose(link);
}

void link_confirmCandidate(Link* link) {
    if (link->state == LINK_STATE_UP)
        link_endSession(link, LINK_STATE_CONNECTING);
    link->session = link->handshake.candidate;
    link->handshake.hasCandidate = 0;
    memset(&link->watch, 0, sizeof link->watch);
    link->watch.provenAt = link->heardAt = link->pingAt = link->now;
    link->paceUntil = link->now; /* after a long silence an old value would read as a future time */
    link->state = LINK_STATE_UP;
    ++link->statistics.sessions;
    link->port->state(link->context, LINK_STATE_UP);
}

static void onHello(Link* link, const U8* peerNonce, U32 features) {
    Link_Session* session = &link->session;
    /* A repeated HELLO means that the answer was lost, and gets the same one. */
    if (link->state != LINK_STATE_UP || link_get32(peerNonce) != link_get32(session->peerNonce)) {
        session = &link->handshake.candidate;
        link_makeCandidate(link, peerNonce, features);
        link->handshake.hasCandidate = 1;
    }
    link_sendHandshake(link, session, LINK_KIND_HELLO_ACK);
}

void link_onHandshake(Link* link, const U8* frame, Link_Kind kind) {
    const U8* payload = frame + LINK_HEADER;
    if (kind == LINK_KIND_RST) {
        if (link->state == LINK_STATE_UP && LINK_EPOCH(frame) == LINK_KEY_EPOCH(link->session.key))
            link_lose(link);
    } else if (frame[1] != LINK_VERSION) {
        return;
    } else if (kind == LINK_KIND_HELLO) {
        onHello(link, payload, frame[2]);
    } else if (link->state == LINK_STATE_CONNECTING &&
               link_get32(payload + 4) == link_get32(link->handshake.nonce)) {
        link_makeCandidate(link, payload, frame[2]);
        link_confirmCandidate(link);
        link->receiver.ackDue = link->receiver.ackNow = 1; /* this first frame confirms it */
    }
}

void link_pollSession(Link* link) {
    U8 frame[LINK_MAX_OVERHEAD];
    Link_Handshake* handshake = &link->handshake;
    U32 now = link->now;
    if (link->state == LINK_STATE_CONNECTING && !LINK_BEFORE(now, handshake->helloAt)) {
        link_call(link);
        handshake->helloAt = now + handshake->helloEvery;
        if (handshake->helloEvery < LINK_HELLO_LAST)
            handshake->helloEvery *= 2U;
    }
    if (LINK_IS_SECURE(link) || link->state != LINK_STATE_UP ||
        now - link->heardAt < LINK_PING_AFTER)
        return;
    if (now - link->heardAt >= LINK_DEAD_AFTER) {
        link_lose(link);
    } else if (!LINK_BEFORE(now, link->pingAt)) {
        (void)link_sendControl(link, frame, LINK_KIND_PING, 0, 0, 0);
        link->pingAt = now + LINK_PING_EVERY;
    }
}
