/* SPDX-License-Identifier: MIT
 *
 * link_session: makes and ends sessions: handshake, reboots, a peer that has vanished.
 */
#include "link.h"

#include <string.h>

void link_makeCandidate(Link* link, const U8* peerNonce, U32 features) {
    Link_Session* session = &link->handshake.candidate;
    memcpy(session->nonce, link->handshake.nonce, LINK_NONCE_BYTES);
    memset(session->peerNonce, 0, LINK_NONCE_BYTES);
    memcpy(session->peerNonce, peerNonce, LINK_CODEC(link)->nonceBytes);
    session->key = link_sessionKey(link_get32(session->nonce), link_get32(peerNonce));
    session->features = (U8)(features & LINK_FEATURES);
}

void link_drawNonce(Link* link) {
    U32 i;
    for (i = 0; i < LINK_CODEC(link)->nonceBytes; i += 4U)
        link_put32(link->handshake.nonce + i, link->port->random(link->context));
    link->handshake.isAnswered = 0;
}

void link_sendHandshake(Link* link, const Link_Session* session, Link_Kind kind, U32 version) {
    U8 frame[LINK_MAX_OVERHEAD + 2U * LINK_NONCE_BYTES];
    U32 bytes = LINK_CODEC(link)->nonceBytes;
    memcpy(frame + LINK_HEADER, session ? session->nonce : link->handshake.nonce, bytes);
    if (session)
        memcpy(frame + LINK_HEADER + bytes, session->peerNonce, bytes);
    (void)link_sendControl(link, frame, kind, version, session ? 2U * bytes : bytes, LINK_FEATURES);
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
    memset(link->heads, 0, sizeof link->heads);
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
    const Link_Codec* codec = LINK_CODEC(link);
    (void)link_sendControl(link, frame, (Link_Kind)codec->endKind, 0, 0, codec->endFlags);
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

void link_pollSession(Link* link) {
    U8 frame[LINK_MAX_OVERHEAD];
    Link_Handshake* handshake = &link->handshake;
    Link_Watch* watch = &link->watch;
    U32 now = link->now;
    U32 silence = now - link->heardAt;
    U32 proof = LINK_SECURE ? now - watch->provenAt : silence;
    if (LINK_SECURE && handshake->isAnswered && now - handshake->firstAnswer >= LINK_NONCE_LIFE)
        link_drawNonce(link);
    if ((link->state == LINK_STATE_CONNECTING || handshake->isUnconfirmed) &&
        !LINK_BEFORE(now, handshake->helloAt)) {
        if (LINK_SECURE && handshake->isUnconfirmed)
            link_sendHandshake(link, &link->session, LINK_KIND_CONFIRM, LINK_VERSION);
        else
            LINK_CODEC(link)->call(link, 0);
        handshake->helloAt = now + handshake->helloEvery;
        if (handshake->helloEvery < LINK_HELLO_LAST)
            handshake->helloEvery *= 2U;
    }
    if (link->state != LINK_STATE_UP)
        return;
    if (LINK_SECURE &&
        (watch->failures >= LINK_MOST_FAILURES || link->sender.next >= LINK_LAST_NUMBER)) {
        link_abort(link);
    } else if (silence >= LINK_DEAD_AFTER || proof >= LINK_PROOF_LAST) {
        link_lose(link);
    } else if ((silence >= LINK_PING_AFTER || proof >= LINK_PROOF_AFTER) &&
               !LINK_BEFORE(now, link->pingAt)) {
        if (LINK_SECURE && watch->pingsAnswered == watch->pingsSent)
            watch->askedAt = now;
        watch->pingsSent += LINK_CODEC(link)->isSure;
        (void)link_sendControl(link, frame, LINK_KIND_PING, watch->pingsSent, 0, 0);
        link->pingAt = now + (silence >= LINK_PING_AFTER ? LINK_PING_EVERY : LINK_PROOF_EVERY);
    }
}
