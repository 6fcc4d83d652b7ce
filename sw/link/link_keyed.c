/* SPDX-License-Identifier: MIT
 *
 * link_keyed: makes sessions with a peer that has the key, and sees that it is alive.
 * A HELLO may be a recording: it changes nothing here, and costs an answer only (docs/link.md).
 */
#include "link.h"

#if LINK_SECURE

#include "ascon.h"

#include <string.h>

/* Rounds of Ascon that the search may spend on a frame. */
#define ROUNDS_HELLO 48U /* under the keys of both slots */
#define ROUNDS_HANDSHAKE 136U
#define ROUNDS_OF(payload) (24U + (payload) / 2U)

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
    link_deriveKeys(&link->secrets, slot, session->nonce, session->peerNonce, &session->keys);
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

/* Returns whether a frame of the handshake is fresh and relevant, which takes no round of Ascon. */
static int isOfUse(const Link* link, const U8* frame, Link_Kind kind) {
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

/* Returns whether such a frame is authentic, and decrypts it. */
static int isGenuine(Link* link, U8* frame, Link_Kind kind) {
    if (kind == LINK_KIND_CONFIRM && isOfSession(link, frame + LINK_HEADER))
        return link_unprotect(frame, link->session.keys.receive, 0, 0);
    if (isUnder(link, 0, frame, kind) || isUnder(link, 1, frame, kind))
        return 1;
    forgetCandidate(link);
    return 0;
}

/* Spends the search budget, in rounds of Ascon, on one frame. Returns whether it sufficed: however
 * many headers an attacker's bytes pretend to hold, they do not keep the processor busy. */
static int mayTry(Link* link, U32 rounds) {
    Link_Parser* parser = &link->parser;
    U32 debt = parser->paidAt - link->now;
    if (debt > LINK_ROUNDS_AT_ONCE * LINK_ROUND_EVERY) /* it was paid earlier */
        debt = 0;
    debt += rounds * LINK_ROUND_EVERY;
    if (debt > LINK_ROUNDS_AT_ONCE * LINK_ROUND_EVERY)
        return 0;
    parser->paidAt = link->now + debt;
    return 1;
}

/* Decrypts a frame under the session's key, where its numbers say that it is for now. */
static int decrypt(Link* link, U8* frame) {
    U32 number = link->sender.base; /* whose lowest byte is near byte 1 */
    U32 acked = 0;
    Link_Kind kind = LINK_KIND_OF(frame);
    if (kind >= LINK_KIND_PIGGYBACK) /* or data */
        number = link->receiver.next;
    if (kind == LINK_KIND_PIGGYBACK || kind == LINK_KIND_PIGGYBACK_ASK)
        acked = link_extend(link->sender.base, frame[LINK_HEADER]);
    if (kind == LINK_KIND_PING)
        number = frame[2] & LINK_PING_ANSWER ? link->watch.pingsSent : link->watch.pingsSeen;
    if (kind == LINK_KIND_BYE)
        number = frame[1];
    if (link_unprotect(frame, link->session.keys.receive, link_extend(number, frame[1]), acked))
        return 1;
    ++link->watch.failures;
    return 0;
}

/* Copies a frame, and decrypts the copy. The search looks at a frame of the handshake only where
 * the bytes end with it, as its packet does. Returns 0: it is none, or not of use here. */
static int decipher(Link* link, const U8* frame, U8* copy, int isSearch, int isLast) {
    U32 size = LINK_LENGTH(frame) + LINK_OVERHEAD;
    U32 rounds = ROUNDS_OF(size - LINK_SECURE_OVERHEAD);
    Link_Kind kind = LINK_KIND_OF(frame);
    int isHandshake = LINK_IS_HANDSHAKE(kind);
    if (size < LINK_SECURE_OVERHEAD || !link_isPlausible(link, frame))
        return 0;
    if (isHandshake) {
        if ((isSearch && !isLast) || !isOfUse(link, frame, kind))
            return 0;
        rounds = kind == LINK_KIND_HELLO ? ROUNDS_HELLO : ROUNDS_HANDSHAKE;
    } else if (link->state != LINK_STATE_UP ||
               LINK_EPOCH(frame) != LINK_KEY_EPOCH(link->session.key)) {
        return 0;
    }
    if (isSearch && !mayTry(link, rounds))
        return 0;
    memcpy(copy, frame, size);
    if (isHandshake)
        return isGenuine(link, copy, kind);
    return decrypt(link, copy);
}

/* A tag needs no confirmation, so a frame is taken when its last byte is there, even behind the
 * beginning of another that is not whole: that may be an attacker's, who would have it wait. */
static U32 parse(Link* link, const U8* bytes, U32 count, int isEnd) {
    U8 copy[LINK_MAX_FRAME];
    U32 used = 0;
    U32 at = 0;
    while (at < count) {
        U32 end = at + LINK_LENGTH(bytes + at) + LINK_OVERHEAD;
        int isFrame = end - at <= LINK_MAX_FRAME;
        if (isFrame && end > link->parser.count && end <= count) {
            int isSearch = link->parser.outOfStep || at != used;
            if (decipher(link, bytes + at, copy, isSearch, end == count)) {
                link_accept(link, copy, end - at);
                at = used = end;
                continue;
            }
        }
        if (at == used && (!isFrame || end <= count || isEnd)) {
            link_skip(link, bytes + at, count - at);
            ++used;
        }
        ++at;
    }
    return used;
}

/* Completes a frame under the session's key. Returns its size in bytes. */
static U32 seal(const Link* link, U8* frame, U32 header, U32 number) {
    const U8* key = link->session.keys.send;
    U32 acked = 0;
    if (header & LINK_CONTROL) {
        U32 kind = header >> 21 & 7U;
        if (kind == LINK_KIND_HELLO)
            key = link->secrets.hello[link->handshake.slot];
        if (kind == LINK_KIND_HELLO_ACK)
            key = link->handshake.candidate.keys.send;
        if (kind >= LINK_KIND_PIGGYBACK)
            acked = link->receiver.next;
    }
    return link_protect(frame, header | LINK_KEY_EPOCH(link->session.key) << 18, key, number,
                        acked);
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
        link_sendHandshake(link, &link->session, LINK_KIND_CONFIRM, LINK_VERSION);
        return;
    }
    if (isUp && !handshake->isUnconfirmed) {
        handshake->slot = handshake->candidate.slot;
        link_sendHandshake(link, 0, LINK_KIND_HELLO, LINK_VERSION | LINK_VERSION_UP);
    } else { /* a peer that is unconfirmed may yet answer a HELLO, and begin this session then */
        makeKeyed(link, handshake->candidate.slot, frame);
        link_sendHandshake(link, &handshake->candidate, LINK_KIND_HELLO_ACK, LINK_VERSION);
        forgetCandidate(link);
    }
    if (!handshake->isAnswered)
        handshake->firstAnswer = link->now;
    handshake->isAnswered = 1;
}

static void onHandshake(Link* link, const U8* frame, Link_Kind kind) {
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

/* Sends HELLO; where both slots have a key, under each in turn. A peer in an unknown session gets
 * the same, since its answer makes a new session. */
static void call(Link* link, const U8* unknown) {
    U32 set = link->secrets.set;
    (void)unknown;
    if (!set)
        return;
    link->handshake.slot = (U8)(set == 3U ? !link->handshake.slot : set >> 1);
    link_sendHandshake(link, 0, LINK_KIND_HELLO, LINK_VERSION);
}

static void onPing(Link* link, const U8* frame) {
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

const Link_Codec link_keyed = {LINK_SECURE_OVERHEAD,
                               LINK_NONCE_BYTES,
                               0,
                               1,
                               LINK_KIND_BYE,
                               0,
                               {1, 8, 16, 16, 0, 0},
                               seal,
                               parse,
                               onHandshake,
                               onPing,
                               call};

#endif
