/* SPDX-License-Identifier: MIT
 *
 * link_session: makes and ends sessions: handshake, reboots, a peer that has vanished.
 */
#include "link_session.h"

#include <string.h>

void link_makeCandidate(Link_Session* session, const U8* peerNonce, U32 features) {
    Link_Identity* candidate = &session->candidate;
    memcpy(candidate->nonce, session->nonce, LINK_NONCE_BYTES);
    memset(candidate->peerNonce, 0, LINK_NONCE_BYTES);
    memcpy(candidate->peerNonce, peerNonce, session->output->codec->nonceBytes);
    candidate->key = link_sessionKey(link_get32(candidate->nonce), link_get32(peerNonce));
    candidate->features = (U8)(features & LINK_FEATURES);
}

void link_drawNonce(Link_Session* session) {
    const Link_Output* output = session->output;
    U32 i;
    for (i = 0; i < output->codec->nonceBytes; i += 4U)
        link_put32(session->nonce + i, output->port->random(output->context));
    session->isAnswered = 0;
}

void link_sendHandshake(Link_Session* session, const Link_Identity* of, Link_Kind kind,
                        U32 version) {
    Link_Output* output = session->output;
    U8 frame[LINK_MAX_OVERHEAD + LINK_ANSWER_BYTES];
    U32 bytes = output->codec->nonceBytes;
    memcpy(frame + LINK_HEADER, of ? of->nonce : session->nonce, bytes);
    if (of)
        memcpy(frame + LINK_HEADER + bytes, of->peerNonce, bytes);
    if (of)
        memcpy(frame + LINK_OPEN_AT, of->open, LINK_OPEN_BYTES);
    output->call = of ? of->shake.send : session->secrets.hello[session->slot];
    (void)link_sendControl(output, frame, LINK_KIND_BITS(kind) | LINK_FEATURES, version,
                           of ? output->codec->sizes[LINK_KIND_HELLO_ACK] : bytes);
}

void link_endSession(Link_Session* session, Link_State next) {
    Link_Output* output = session->output;
    int wasUp = session->state == LINK_STATE_UP;
    U32 open = output->open;
    int channel;
    session->state = (U8)next;
    link_drawNonce(session);
    session->isUnconfirmed = 0;
    session->helloAt = output->now;
    session->pingAt = output->now - LINK_HELLO_FIRST;
    session->helloEvery = LINK_HELLO_FIRST;
    link_resetReceiver(session->receiver);
    link_resetSender(session->sender);
    memset(&output->present.keys, 0, sizeof output->present.keys);
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if (open >> channel & 1U)
            output->port->channel(output->context, channel, 0);
    if (wasUp)
        output->port->state(output->context, next);
}

void link_lose(Link_Session* session) {
    link_endSession(session, session->wanted ? LINK_STATE_CONNECTING : LINK_STATE_IDLE);
}

void link_abort(Link_Session* session) {
    U8 frame[LINK_MAX_OVERHEAD];
    if (session->state == LINK_STATE_UP)
        (void)link_sendControl(session->output, frame, LINK_KIND_BITS(LINK_KIND_BYE), 0, 0);
    link_lose(session);
}

void link_confirmCandidate(Link_Session* session) {
    Link_Output* output = session->output;
    if (session->state == LINK_STATE_UP)
        link_endSession(session, LINK_STATE_CONNECTING);
    output->present = session->candidate;
    session->hasCandidate = 0;
    memset(&session->watch, 0, sizeof session->watch);
    session->watch.provenAt = output->heardAt = session->pingAt = output->now;
    output->paceUntil =
        output->now; /* after a long silence an old value would read as a future time */
    session->state = LINK_STATE_UP;
    ++output->statistics.sessions;
    output->port->state(output->context, LINK_STATE_UP);
}

int link_pollSession(Link_Session* session) {
    Link_Output* output = session->output;
    U8 frame[LINK_MAX_OVERHEAD];
    Link_Watch* watch = &session->watch;
    U32 now = output->now;
    U32 silence = now - output->heardAt;
    U32 proof = now - watch->provenAt;
    if (session->isAnswered && now - session->firstAnswer >= LINK_NONCE_LIFE)
        link_drawNonce(session);
    if ((session->state == LINK_STATE_CONNECTING || session->isUnconfirmed) &&
        !LINK_BEFORE(now, session->helloAt)) {
        if (session->isUnconfirmed)
            link_sendHandshake(session, &output->present, LINK_KIND_CONFIRM, LINK_VERSION);
        else
            output->codec->call(session, 0);
        session->helloAt = now + session->helloEvery;
        if (session->helloEvery < LINK_HELLO_LAST)
            session->helloEvery *= 2U;
    }
    if (session->state != LINK_STATE_UP)
        return 0;
    if (watch->failures >= LINK_MOST_FAILURES || session->sender->next >= LINK_LAST_NUMBER) {
        link_abort(session);
    } else if (silence >= LINK_DEAD_AFTER || proof >= LINK_PROOF_LAST) {
        link_lose(session);
    } else if ((silence >= LINK_PING_AFTER || proof >= LINK_PROOF_AFTER) &&
               !LINK_BEFORE(now, session->pingAt)) {
        if (watch->pingsAnswered == watch->pingsSent)
            watch->askedAt = now;
        watch->pingsSent += output->codec->isSure;
        (void)link_sendControl(output, frame, LINK_KIND_BITS(LINK_KIND_PING), watch->pingsSent, 0);
        session->pingAt = now + (silence >= LINK_PING_AFTER ? LINK_PING_EVERY : LINK_PROOF_EVERY);
    }
    return session->state == LINK_STATE_UP;
}
