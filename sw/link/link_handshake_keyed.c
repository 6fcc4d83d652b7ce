/* SPDX-License-Identifier: MIT
 *
 * link_handshake_keyed: makes sessions with a peer that has the key. A HELLO may be a recording by
 * an attacker, so it does not change the state; it only causes an answer (docs/link.md).
 */
#include "link_handshake_keyed.h"

#include <string.h>

/* Costs of opening a frame, in rounds of Ascon. */
#define ROUNDS_HELLO 48U /* HELLO, tried with the keys of both slots */
#define ROUNDS_ANSWER 168U

static int isSameNonce(const U8* a, const U8* b) {
    return memcmp(a, b, LINK_NONCE_BYTES) == 0;
}

/* Returns whether a CONFIRM belongs to the current session. */
static int isOfSession(const Link_Handshake* handshake, const U8* nonces) {
    const Link_Identity* present = &handshake->present;
    return handshake->state == LINK_STATE_UP && isSameNonce(nonces, present->peerNonce) &&
           isSameNonce(nonces + LINK_NONCE_BYTES, present->nonce);
}

/* Prepares the candidate's keys with the peer's nonce and the key of a slot. */
static void makeKeyed(Link_Handshake* handshake, U32 slot, const U8* frame) {
    Link_Identity* candidate = &handshake->candidate;
    int isGround = handshake->isGround;
    link_makeCandidate(handshake, frame + LINK_HEADER, frame[2]);
    candidate->slot = (U8)slot;
    candidate->isGround = (U8)isGround;
    link_deriveKeys(&handshake->secrets[slot], isGround ? candidate->peerNonce : candidate->nonce,
                    isGround ? candidate->nonce : candidate->peerNonce,
                    &candidate->secrets.handshake);
}

/* Returns a cost only for frames that are fresh and expected. This check itself costs no round of
 * Ascon. */
static U32 cost(const Link_Handshake* handshake, const U8* frame) {
    const U8* nonces = frame + LINK_HEADER;
    Link_Kind kind = LINK_KIND_OF(frame);
    if (isSameNonce(nonces, handshake->nonce))
        return 0; /* a frame of this side that an attacker has recorded and sent back */
    if (kind == LINK_KIND_HELLO)
        return (frame[1] & ~LINK_VERSION_UP) == LINK_VERSION ? ROUNDS_HELLO : 0U;
    if (frame[1] != LINK_VERSION)
        return 0;
    if (kind == LINK_KIND_CONFIRM && isOfSession(handshake, nonces))
        return ROUNDS_ANSWER;
    return (kind != LINK_KIND_CONFIRM || handshake->isAnswered) &&
                   isSameNonce(nonces + LINK_NONCE_BYTES, handshake->nonce)
               ? ROUNDS_ANSWER
               : 0U;
}

static int expect(Link_Handshake* handshake, const U8* frame, U32 attempt, Link_Seal* seal) {
    Link_Kind kind = LINK_KIND_OF(frame);
    if (!LINK_IS_HANDSHAKE(kind))
        return 0;
    seal->number = seal->acked = 0;
    if (kind == LINK_KIND_CONFIRM && isOfSession(handshake, frame + LINK_HEADER)) {
        seal->key = LINK_PEERS_KEY(&handshake->present, handshake);
        return attempt == 0;
    }
    if (!((U32)handshake->keys >> attempt & 1U)) /* attempt n uses the key of slot n */
        return 0;
    seal->key = handshake->secrets[attempt].hello;
    if (kind != LINK_KIND_HELLO) {
        makeKeyed(handshake, attempt, frame);
        seal->key = LINK_PEERS_KEY(&handshake->candidate, handshake);
    }
    return 1;
}

/* Copies the public key of this side's key pair into the candidate. */
static void offerPair(Link_Handshake* handshake) {
    const Link_Env* env = &handshake->pacing->env;
    if (!handshake->hasPair)
        link_makePair(&handshake->pair, env->port->random, env->context);
    handshake->hasPair = 1;
    memcpy(handshake->candidate.secrets.publicKey, handshake->pair.publicKey, LINK_PUBLIC_BYTES);
}

static void onHello(Link_Handshake* handshake, const U8* frame, U32 slot) {
    U32 now = handshake->pacing->env.now;
    int isUp = handshake->state == LINK_STATE_UP;
    int isPresent = isUp && isSameNonce(frame + LINK_HEADER, handshake->present.peerNonce);
    if (isUp && (now - handshake->lastAnswer < LINK_ANSWER_EVERY || frame[1] != LINK_VERSION ||
                 (isPresent && !handshake->isUnconfirmed)))
        return;
    handshake->lastAnswer = now;
    if (isPresent) { /* the session exists already: the peer has not received this side's CONFIRM */
        link_sendHandshake(handshake, &handshake->present, LINK_KIND_CONFIRM, LINK_VERSION);
        return;
    }
    if (isUp && !handshake->isUnconfirmed) {
        handshake->slot = (U8)slot;
        link_sendHandshake(handshake, 0, LINK_KIND_HELLO, LINK_VERSION | LINK_VERSION_UP);
        /* A session that the peer has not confirmed may belong to an earlier HELLO. The new HELLO
         * is therefore answered as without a session. */
    } else {
        makeKeyed(handshake, slot, frame);
        offerPair(handshake);
        link_sendHandshake(handshake, &handshake->candidate, LINK_KIND_HELLO_ACK, LINK_VERSION);
        link_wipeCandidate(handshake);
    }
    if (!handshake->isAnswered)
        handshake->firstAnswer = now;
    handshake->isAnswered = 1;
}

static U32 onFrame(Link_Handshake* handshake, const U8* frame, U32 attempt) {
    Link_SessionSecrets* secrets = &handshake->candidate.secrets;
    Link_Kind kind = LINK_KIND_OF(frame);
    if (kind == LINK_KIND_HELLO) {
        onHello(handshake, frame, attempt);
        return LINK_VERDICT_NONE;
    }
    if (kind == LINK_KIND_CONFIRM && isOfSession(handshake, frame + LINK_HEADER))
        /* the acknowledgement informs the peer that the session has begun */
        return LINK_VERDICT_ACK;
    offerPair(handshake);
    secrets->keys = secrets->handshake;
    link_mixKeys(&secrets->keys, &handshake->pair, frame + LINK_PUBLIC_AT);
    handshake->hasPair = 0;
    return kind == LINK_KIND_CONFIRM ? LINK_VERDICT_BEGIN | LINK_VERDICT_ACK
                                     : LINK_VERDICT_BEGIN | LINK_VERDICT_UNCONFIRMED;
}

/* Sends HELLO; if both slots have a key, uses the keys in turn. Also answers a frame of an unknown
 * session with HELLO: the peer's answer then makes a new session. */
static void sendHello(Link_Handshake* handshake, const U8* unknown) {
    U32 keys = handshake->keys;
    (void)unknown;
    if (!keys)
        return;
    handshake->slot = (U8)(keys == 3U ? !handshake->slot : keys >> 1);
    link_sendHandshake(handshake, 0, LINK_KIND_HELLO, LINK_VERSION);
}

const Link_HandshakeRules link_keyedHandshake = {cost, expect, onFrame, sendHello};
