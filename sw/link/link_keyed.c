/* SPDX-License-Identifier: MIT
 *
 * link_keyed: makes sessions with a peer that has the key, and sees that it is alive.
 *
 *     A                        B
 *     HELLO(a)            ->             proves the key, and may be a recording: so it changes
 *                         <-   HELLO-ACK(b, a)     nothing here, and costs an answer only
 *     CONFIRM(a, b)       ->             proves that A lives, and begins the session here
 *
 * Where B is in a session it answers by a HELLO of its own, marked as such: one answers all HELLOs
 * that come within LINK_ANSWER_EVERY, so that recordings do not keep A's from being answered. A,
 * if it is in no session, goes on from there in B's place.
 *
 * a and b are nonces of 64 bits; those of a session give its two keys, and HELLO-ACK and CONFIRM
 * are frames under these. A side that gets frames that it cannot read sends HELLO; there is no RST.
 */
#include "link.h"

#if LINK_SECURE

#include "ascon.h"

#include <string.h>

static int isSameNonce(const U8* a, const U8* b) {
    return memcmp(a, b, LINK_NONCE_BYTES) == 0;
}

/* Returns whether a CONFIRM belongs to the present session. */
static int isOfSession(const Link* link, const U8* nonces) {
    return link->state == LINK_STATE_UP && isSameNonce(nonces, link->session.peerNonce) &&
           isSameNonce(nonces + LINK_NONCE_BYTES, link->session.nonce);
}

/* Prepares the session with the peer's nonce under the key of a slot. */
static void makeKeyed(Link* link, int slot, const U8* frame) {
    Link_Session* session = &link->handshake.candidate;
    link_makeCandidate(link, frame + LINK_HEADER, frame[2]);
    session->slot = (U8)slot;
    link_deriveKeys(link->secrets.key[slot], session->nonce, session->peerNonce, &session->keys);
}

static void forgetCandidate(Link* link) {
    Ascon_wipe(&link->handshake.candidate.keys, sizeof link->handshake.candidate.keys);
}

/* Returns whether a frame has a good tag under the key of a slot, which the candidate then notes.
 */
static int isUnder(Link* link, int slot, U8* frame, Link_Kind kind) {
    const U8* key = link->secrets.hello[slot];
    if (!(link->secrets.set >> slot & 1))
        return 0;
    link->handshake.candidate.slot = (U8)slot;
    if (kind != LINK_KIND_HELLO) {
        makeKeyed(link, slot, frame);
        key = link->handshake.candidate.keys.receive;
    }
    return link_unprotect(frame, key, 0, 0);
}

int link_isOfUse(const Link* link, const U8* frame, Link_Kind kind) {
    const Link_Handshake* handshake = &link->handshake;
    const U8* nonces = frame + LINK_HEADER;
    if (isSameNonce(nonces, handshake->nonce))
        return 0; /* the own frame, reflected */
    if (kind == LINK_KIND_HELLO)
        return (frame[1] & ~LINK_VERSION_UP) == LINK_VERSION;
    if (frame[1] != LINK_VERSION)
        return 0;
    if (kind == LINK_KIND_CONFIRM && (isOfSession(link, nonces) || !handshake->isAnswered))
        return isOfSession(link, nonces);
    return isSameNonce(nonces + LINK_NONCE_BYTES, handshake->nonce);
}

int link_isGenuine(Link* link, U8* frame, Link_Kind kind) {
    if (kind == LINK_KIND_CONFIRM && isOfSession(link, frame + LINK_HEADER))
        return link_unprotect(frame, link->session.keys.receive, 0, 0);
    if (isUnder(link, 0, frame, kind) || isUnder(link, 1, frame, kind))
        return 1;
    forgetCandidate(link);
    return 0;
}

static void begin(Link* link) {
    link_confirmCandidate(link);
    forgetCandidate(link);
    link_drawNonce(link);
}

static void onHello(Link* link, const U8* frame) {
    Link_Handshake* handshake = &link->handshake;
    int isUp = link->state == LINK_STATE_UP;
    int isPresent = isUp && isSameNonce(frame + LINK_HEADER, link->session.peerNonce);
    if (isUp && (link->now - handshake->lastAnswer < LINK_ANSWER_EVERY ||
                 frame[1] != LINK_VERSION || (isPresent && !handshake->isUnconfirmed)))
        return;
    handshake->lastAnswer = link->now;
    if (isPresent) { /* the peer has not heard the CONFIRM */
        link_sendHandshake(link, &link->session, LINK_KIND_CONFIRM);
        return;
    }
    if (isUp && !handshake->isUnconfirmed) {
        handshake->slot = handshake->candidate.slot;
        link_sendHello(link, LINK_VERSION | LINK_VERSION_UP);
    } else { /* a peer that is unconfirmed may yet answer a HELLO, and begin this session then */
        makeKeyed(link, handshake->candidate.slot, frame);
        link_sendHandshake(link, &handshake->candidate, LINK_KIND_HELLO_ACK);
        forgetCandidate(link);
    }
    if (!handshake->isAnswered)
        handshake->firstAnswer = link->now;
    handshake->isAnswered = 1;
}

void link_onGenuine(Link* link, const U8* frame, Link_Kind kind) {
    Link_Handshake* handshake = &link->handshake;
    if (kind == LINK_KIND_HELLO) {
        onHello(link, frame);
        return;
    }
    if (kind == LINK_KIND_HELLO_ACK) {
        begin(link);
        handshake->isUnconfirmed = 1;
        handshake->helloEvery = LINK_HELLO_FIRST;
        handshake->helloAt = link->now;
        return;
    }
    if (!isOfSession(link, frame + LINK_HEADER))
        begin(link);
    link->receiver.ackDue = link->receiver.ackNow = 1; /* so that the peer hears */
}

void link_onPing(Link* link, const U8* frame) {
    Link_Watch* watch = &link->watch;
    U8 answer[LINK_MAX_OVERHEAD];
    U32 number;
    if (frame[2] & LINK_PING_ANSWER) {
        number = link_extend(watch->pingsSent, frame[1]);
        if (LINK_BEFORE(watch->pingsAnswered, number) && !LINK_BEFORE(watch->pingsSent, number)) {
            watch->pingsAnswered = watch->pingsSent;
            watch->provenAt = watch->askedAt; /* the answer itself may have been held back */
            link->heardAt = link->now;
        }
        return;
    }
    number = link_extend(watch->pingsSeen, frame[1]);
    if (!LINK_BEFORE(watch->pingsSeen, number))
        return; /* heard before */
    watch->pingsSeen = number;
    link->heardAt = link->now;
    (void)link_sendControl(link, answer, LINK_KIND_PING, number, 0, LINK_PING_ANSWER);
}

void link_pollKeyed(Link* link) {
    Link_Handshake* handshake = &link->handshake;
    Link_Watch* watch = &link->watch;
    U8 frame[LINK_MAX_OVERHEAD];
    U32 now = link->now;
    U32 silence = now - link->heardAt;
    U32 proof = now - watch->provenAt;
    if (handshake->isAnswered && now - handshake->firstAnswer >= LINK_NONCE_LIFE)
        link_drawNonce(link);
    if (link->state != LINK_STATE_UP)
        return;
    if (handshake->isUnconfirmed && !LINK_BEFORE(now, handshake->helloAt)) {
        link_sendHandshake(link, &link->session, LINK_KIND_CONFIRM);
        handshake->helloAt = now + handshake->helloEvery;
        if (handshake->helloEvery < LINK_HELLO_LAST)
            handshake->helloEvery *= 2U;
    }
    if (watch->failures >= LINK_MOST_FAILURES || link->sender.next >= LINK_LAST_NUMBER) {
        link_abort(link);
    } else if (silence >= LINK_DEAD_AFTER || proof >= LINK_PROOF_LAST) {
        link_lose(link);
    } else if ((silence >= LINK_PING_AFTER || proof >= LINK_PROOF_AFTER) &&
               !LINK_BEFORE(now, link->pingAt)) {
        if (watch->pingsAnswered == watch->pingsSent)
            watch->askedAt = now;
        (void)link_sendControl(link, frame, LINK_KIND_PING, ++watch->pingsSent, 0, 0);
        link->pingAt = now + (silence >= LINK_PING_AFTER ? LINK_PING_EVERY : LINK_PROOF_EVERY);
    }
}

#endif
