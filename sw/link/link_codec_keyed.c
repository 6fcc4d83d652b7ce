/* SPDX-License-Identifier: MIT
 *
 * link_codec_keyed: encrypts and authenticates frames by Ascon-AEAD128, makes sessions with a peer
 * that has the key, and sees that it is alive. All parts of a frame that are not encrypted belong
 * to its nonce. A HELLO may be a recording: it changes nothing here, and costs an answer only
 * (docs/link.md).
 */
#include "link_session.h"

#include "ascon.h"

#include <string.h>

/* Rounds of Ascon that the search may spend on a frame. */
#define ROUNDS_HELLO 48U /* under the keys of both slots */
#define ROUNDS_HANDSHAKE 168U
#define ROUNDS_OF(payload) (24U + (payload) / 2U)

#define CLEAR_AT 11U  /* start of the payload in clear in a nonce, ... */
#define CLEAR_MOST 5U /* and its greatest size there */

/* Returns the number of payload bytes in clear, which come first: all of a control frame, the
 * acknowledgement of a PIGGYBACK, the nonces of HELLO-ACK and CONFIRM. */
static U32 clearOf(const U8* frame) {
    U32 most = frame[2] >> 5 >= LINK_KIND_PIGGYBACK ? 1U : 2U * LINK_NONCE_BYTES;
    if (!(frame[0] & LINK_CONTROL))
        return 0;
    return LINK_LENGTH(frame) < most ? LINK_LENGTH(frame) : most;
}

static void makeNonce(U8* nonce, const U8* frame, U32 clear, U32 number, U32 acked) {
    U32 kind = (U32)frame[2] >> 5;
    memset(nonce, 0, ASCON_NONCE_BYTES);
    link_put32(nonce, number);
    link_put32(nonce + 4, acked);
    if ((frame[0] & LINK_CONTROL) && LINK_IS_HANDSHAKE(kind))
        memcpy(nonce, frame + LINK_HEADER, LINK_NONCE_BYTES);
    else if (clear > CLEAR_MOST) /* an acknowledgement's: 9 bytes at most */
        memcpy(nonce + 4, frame + LINK_HEADER + CLEAR_MOST,
               clear < LINK_BITMAP + 1U ? clear - CLEAR_MOST : LINK_BITMAP + 1U - CLEAR_MOST);
    memcpy(nonce + 8, frame, LINK_HEADER);
    memcpy(nonce + CLEAR_AT, frame + LINK_HEADER, clear < CLEAR_MOST ? clear : CLEAR_MOST);
}

/* Encrypts or decrypts the payload, and computes its tag. */
static void crypt(U8* frame, const U8* key, U32 number, U32 acked, int isDecryption, U8* tag) {
    U8 nonce[ASCON_NONCE_BYTES];
    U32 clear = clearOf(frame);
    makeNonce(nonce, frame, clear, number, acked);
    link_cipher(key, nonce, frame + LINK_HEADER + clear, LINK_LENGTH(frame) - clear, isDecryption,
                tag);
}

U32 link_protect(U8* frame, U32 header, const U8* key, U32 number, U32 acked) {
    U32 size = LINK_LENGTH_OF(header) + LINK_HEADER;
    U8 tag[ASCON_TAG_BYTES];
    frame[0] = (U8)header;
    frame[1] = (U8)(header >> 8);
    frame[2] = (U8)(header >> 16);
    crypt(frame, key, number, acked, 0, tag);
    memcpy(frame + size, tag, LINK_TAG);
    frame[0] = (U8)(frame[0] + LINK_TAG_MORE);
    return size + LINK_TAG;
}

int link_unprotect(U8* frame, const U8* key, U32 number, U32 acked) {
    U32 size = LINK_LENGTH(frame) - LINK_TAG_MORE;
    U8 tag[ASCON_TAG_BYTES];
    frame[0] = (U8)(frame[0] - LINK_TAG_MORE);
    crypt(frame, key, number, acked, 1, tag);
    if (Ascon_isSame(tag, frame + LINK_HEADER + size, LINK_TAG))
        return 1;
    Ascon_wipe(frame + LINK_HEADER, size);
    frame[0] = (U8)(frame[0] + LINK_TAG_MORE);
    return 0;
}

U32 link_extend(U32 expected, U32 byte) {
    U32 ahead = (byte - expected) & 0xFFU;
    return expected + ahead - (ahead & 0x80U) * 2U;
}

static int isSameNonce(const U8* a, const U8* b) {
    return memcmp(a, b, LINK_NONCE_BYTES) == 0;
}

/* Returns whether a CONFIRM belongs to the present session. */
static int isOfSession(const Link_Session* session, const U8* nonces) {
    const Link_Identity* present = &session->output->present;
    return session->state == LINK_STATE_UP && isSameNonce(nonces, present->peerNonce) &&
           isSameNonce(nonces + LINK_NONCE_BYTES, present->nonce);
}

/* Prepares the session with the peer's nonce under the key of a slot. */
static void makeKeyed(Link_Session* session, int slot, const U8* frame) {
    Link_Identity* candidate = &session->candidate;
    int isGround = session->output->isGround;
    link_makeCandidate(session, frame + LINK_HEADER, frame[2]);
    candidate->slot = (U8)slot;
    link_deriveKeys(&session->secrets[slot], isGround ? candidate->peerNonce : candidate->nonce,
                    isGround ? candidate->nonce : candidate->peerNonce, &candidate->shake);
}

static void forgetCandidate(Link_Session* session) {
    Ascon_wipe(&session->candidate.keys, sizeof session->candidate.keys);
    Ascon_wipe(&session->candidate.shake, sizeof session->candidate.shake);
}

/* Returns whether a frame has a good tag under the key of a slot, which the candidate then notes.
 */
static int isUnder(Link_Session* session, int slot, U8* frame, Link_Kind kind) {
    const U8* key = session->secrets[slot].hello;
    if (!(session->keys >> slot & 1))
        return 0;
    session->candidate.slot = (U8)slot;
    if (kind != LINK_KIND_HELLO) {
        makeKeyed(session, slot, frame);
        key = LINK_PEERS_KEY(session->output, session->candidate.shake);
    }
    return link_unprotect(frame, key, 0, 0);
}

/* Returns whether a frame of the handshake is fresh and relevant, which takes no round of Ascon. */
static int isOfUse(const Link_Session* session, const U8* frame, Link_Kind kind) {
    const U8* nonces = frame + LINK_HEADER;
    if (isSameNonce(nonces, session->nonce))
        return 0; /* the own frame, reflected */
    if (kind == LINK_KIND_HELLO)
        return (frame[1] & ~LINK_VERSION_UP) == LINK_VERSION;
    if (frame[1] != LINK_VERSION)
        return 0;
    if (kind == LINK_KIND_CONFIRM && isOfSession(session, nonces))
        return 1;
    return (kind != LINK_KIND_CONFIRM || session->isAnswered) &&
           isSameNonce(nonces + LINK_NONCE_BYTES, session->nonce);
}

/* Returns whether such a frame is authentic, and decrypts its copy. */
static int isGenuine(Link_Session* session, const U8* frame, U8* copy, Link_Kind kind) {
    const Link_Output* output = session->output;
    int slot;
    if (kind == LINK_KIND_CONFIRM && isOfSession(session, copy + LINK_HEADER))
        return link_unprotect(copy, LINK_PEERS_KEY(output, output->present.shake), 0, 0);
    for (slot = 0; slot < LINK_KEYS; ++slot) {
        if (isUnder(session, slot, copy, kind))
            return 1;
        memcpy(copy, frame, LINK_LENGTH(frame) + LINK_OVERHEAD); /* the other key has spoilt it */
    }
    forgetCandidate(session);
    return 0;
}

/* Spends the search budget, in rounds of Ascon, on one frame. Returns whether it sufficed: however
 * many headers an attacker's bytes pretend to hold, they do not keep the processor busy. */
static int mayTry(Link_Input* input, U32 rounds) {
    U32 debt = input->paidAt - input->output->now;
    if (debt > LINK_ROUNDS_AT_ONCE * LINK_ROUND_EVERY) /* it was paid earlier */
        debt = 0;
    debt += rounds * LINK_ROUND_EVERY;
    if (debt > LINK_ROUNDS_AT_ONCE * LINK_ROUND_EVERY)
        return 0;
    input->paidAt = input->output->now + debt;
    return 1;
}

/* Decrypts a frame under the session's key, where its numbers say that it is for now. */
static int decrypt(Link_Session* session, U8* frame) {
    const Link_Output* output = session->output;
    U32 number = session->sender->base; /* whose lowest byte is near byte 1 */
    U32 acked = 0;
    Link_Kind kind = LINK_KIND_OF(frame);
    if (kind >= LINK_KIND_PIGGYBACK) /* or data */
        number = output->expected;
    if (LINK_IS_RIDE(kind))
        acked = link_extend(session->sender->base, frame[LINK_HEADER]);
    if (kind == LINK_KIND_PING)
        number = frame[2] & LINK_PING_ANSWER ? session->watch.pingsSent : session->watch.pingsSeen;
    if (kind == LINK_KIND_BYE)
        number = frame[1];
    if (link_unprotect(frame, LINK_PEERS_KEY(output, output->present.keys),
                       link_extend(number, frame[1]), acked))
        return 1;
    ++session->watch.failures;
    return 0;
}

/* Copies a frame, and decrypts the copy. The search looks at a frame of the handshake only where
 * the bytes end with it, as its packet does. Returns 0: it is none, or not of use here. */
static int decipher(Link_Input* input, const U8* frame, U8* copy, int isSearch, int isLast) {
    Link_Session* session = input->session;
    U32 size = LINK_LENGTH(frame) + LINK_OVERHEAD;
    U32 rounds = ROUNDS_OF(size - LINK_SECURE_OVERHEAD);
    Link_Kind kind = LINK_KIND_OF(frame);
    int isHandshake = LINK_IS_HANDSHAKE(kind);
    if (size < LINK_SECURE_OVERHEAD || !link_isPlausible(input->output, frame))
        return 0;
    if (isHandshake) {
        if ((isSearch && !isLast) || !isOfUse(session, frame, kind))
            return 0;
        rounds = kind == LINK_KIND_HELLO ? ROUNDS_HELLO : ROUNDS_HANDSHAKE;
    } else if (session->state != LINK_STATE_UP ||
               !link_isOfEpoch(frame, input->output->present.key)) {
        return 0;
    }
    if (isSearch && !mayTry(input, rounds))
        return 0;
    memcpy(copy, frame, size);
    if (isHandshake)
        return isGenuine(session, frame, copy, kind);
    return decrypt(session, copy);
}

/* A tag needs no confirmation, so a frame is taken when its last byte is there, even behind the
 * beginning of another that is not whole: that may be an attacker's, who would have it wait. */
static U32 parse(Link_Input* input, const U8* bytes, U32 count, int isEnd) {
    U8 copy[LINK_MAX_FRAME];
    U32 used = 0;
    U32 at = 0;
    while (at < count) {
        U32 end = at + LINK_LENGTH(bytes + at) + LINK_OVERHEAD;
        int isFrame = end - at <= LINK_MAX_FRAME;
        if (isFrame && end > input->count && end <= count) {
            int isSearch = input->outOfStep || at != used;
            if (decipher(input, bytes + at, copy, isSearch, end == count)) {
                link_accept(input, copy, end - at);
                at = used = end;
                continue;
            }
        }
        if (at == used && (!isFrame || end <= count || isEnd)) {
            if (bytes[at] != LINK_FILL)
                link_skip(input, bytes + at, count - at);
            ++used;
        }
        ++at;
    }
    return used;
}

/* Completes a frame under the session's key. Returns its size in bytes. */
static U32 seal(const Link_Output* output, U8* frame, U32 header, U32 number) {
    U32 kind = header & LINK_CONTROL ? header >> 21 & 7U : LINK_KIND_DATA;
    return link_protect(frame, header ^ LINK_KEY_EPOCH(output->present.key) << 18,
                        LINK_IS_HANDSHAKE(kind) ? output->call
                                                : LINK_OWN_KEY(output, output->present.keys),
                        number, LINK_IS_RIDE(kind) ? output->expected : 0);
}

/* Takes the own pair, as it is sent to the peer. */
static void offerPair(Link_Session* session) {
    const Link_Output* output = session->output;
    link_makePair(&session->pair, output->port, output->context);
    memcpy(session->candidate.open, session->pair.open, LINK_OPEN_BYTES);
}

/* Begins the session of a frame, which has the peer's half of its pair. */
static void begin(Link_Session* session, const U8* frame) {
    Link_Identity* candidate = &session->candidate;
    offerPair(session);
    candidate->keys = candidate->shake;
    link_mixKeys(&candidate->keys, &session->pair, frame + LINK_OPEN_AT);
    link_confirmCandidate(session);
    forgetCandidate(session);
    link_drawNonce(session);
}

static void onHello(Link_Session* session, const U8* frame) {
    Link_Output* output = session->output;
    int isUp = session->state == LINK_STATE_UP;
    int isPresent = isUp && isSameNonce(frame + LINK_HEADER, output->present.peerNonce);
    if (isUp && (output->now - session->lastAnswer < LINK_ANSWER_EVERY ||
                 frame[1] != LINK_VERSION || (isPresent && !session->isUnconfirmed)))
        return;
    session->lastAnswer = output->now;
    if (isPresent) { /* the peer has not heard the CONFIRM */
        link_sendHandshake(session, &output->present, LINK_KIND_CONFIRM, LINK_VERSION);
        return;
    }
    if (isUp && !session->isUnconfirmed) {
        session->slot = session->candidate.slot;
        link_sendHandshake(session, 0, LINK_KIND_HELLO, LINK_VERSION | LINK_VERSION_UP);
    } else { /* a peer that is unconfirmed may yet answer a HELLO, and begin this session then */
        makeKeyed(session, session->candidate.slot, frame);
        offerPair(session);
        link_sendHandshake(session, &session->candidate, LINK_KIND_HELLO_ACK, LINK_VERSION);
        forgetCandidate(session);
    }
    if (!session->isAnswered)
        session->firstAnswer = output->now;
    session->isAnswered = 1;
}

static void onHandshake(Link_Session* session, const U8* frame, Link_Kind kind) {
    if (kind == LINK_KIND_HELLO) {
        onHello(session, frame);
        return;
    }
    if (kind == LINK_KIND_HELLO_ACK) {
        begin(session, frame);
        session->isUnconfirmed = 1;
        session->helloEvery = LINK_HELLO_FIRST;
        session->helloAt = session->output->now;
        return;
    }
    if (!isOfSession(session, frame + LINK_HEADER))
        begin(session, frame);
    link_oweAck(session->receiver); /* so that the peer hears */
}

/* Sends HELLO; where both slots have a key, under each in turn. A peer in an unknown session gets
 * the same, since its answer makes a new session. */
static void call(Link_Session* session, const U8* unknown) {
    U32 keys = session->keys;
    (void)unknown;
    if (!keys)
        return;
    session->slot = (U8)(keys == 3U ? !session->slot : keys >> 1);
    link_sendHandshake(session, 0, LINK_KIND_HELLO, LINK_VERSION);
}

static void onPing(Link_Session* session, const U8* frame) {
    Link_Output* output = session->output;
    Link_Watch* watch = &session->watch;
    U8 answer[LINK_MAX_OVERHEAD];
    U32 number;
    if (frame[2] & LINK_PING_ANSWER) {
        number = link_extend(watch->pingsSent, frame[1]);
        if (LINK_BEFORE(watch->pingsAnswered, number) && !LINK_BEFORE(watch->pingsSent, number)) {
            watch->pingsAnswered = watch->pingsSent;
            watch->provenAt = watch->askedAt; /* the answer itself may have been held back */
            output->heardAt = output->now;
        }
        return;
    }
    number = link_extend(watch->pingsSeen, frame[1]);
    if (!LINK_BEFORE(watch->pingsSeen, number))
        return; /* heard before */
    watch->pingsSeen = number;
    output->heardAt = output->now;
    (void)link_sendControl(output, answer, LINK_KIND_BITS(LINK_KIND_PING) | LINK_PING_ANSWER,
                           number, 0);
}

const Link_Codec link_keyed = {LINK_SECURE_OVERHEAD,
                               LINK_NONCE_BYTES,
                               0,
                               1,
                               {1, LINK_NONCE_BYTES, LINK_ANSWER_BYTES, LINK_ANSWER_BYTES, 0, 0},
                               seal,
                               parse,
                               onHandshake,
                               onPing,
                               call};
