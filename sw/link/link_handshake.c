/* SPDX-License-Identifier: MIT
 *
 * link_handshake: the parts of a handshake that do not depend on a key.
 */
#include "link_handshake.h"

#include "ascon.h"

#include <string.h>

void link_useRules(Link_Handshake* handshake, const Link_HandshakeRules* rules) {
    handshake->rules = rules;
    handshake->slot = 1; /* each HELLO first changes the slot, so the first HELLO uses slot 0 */
}

void link_setSecret(Link_Handshake* handshake, int slot, const U8* key, U32 side) {
    U32 bit = 1U << slot;
    handshake->keys = (U8)(handshake->keys & ~bit);
    memset(&handshake->secrets[slot], 0, sizeof handshake->secrets[slot]);
    if (!key)
        return;
    handshake->isGround = (side & LINK_GROUND) != 0;
    link_makeSecret(&handshake->secrets[slot], key, side & ~LINK_GROUND);
    handshake->keys = (U8)(handshake->keys | bit);
}

void link_drawNonce(Link_Handshake* handshake) {
    const Link_Env* env = &handshake->pacing->env;
    U32 i;
    for (i = 0; i < env->codec->nonceBytes; i += 4U)
        link_put32(handshake->nonce + i, env->port->random(env->context));
    handshake->isAnswered = 0;
}

void link_makeCandidate(Link_Handshake* handshake, const U8* peerNonce, U32 features) {
    Link_Identity* candidate = &handshake->candidate;
    memcpy(candidate->nonce, handshake->nonce, LINK_NONCE_BYTES);
    memset(candidate->peerNonce, 0, LINK_NONCE_BYTES);
    memcpy(candidate->peerNonce, peerNonce, handshake->pacing->env.codec->nonceBytes);
    candidate->key = link_sessionKey(link_get32(candidate->nonce), link_get32(peerNonce));
    candidate->features = (U8)(features & LINK_FEATURES);
}

void link_sendHandshake(Link_Handshake* handshake, const Link_Identity* of, Link_Kind kind,
                        U32 version) {
    Link_Pacing* pacing = handshake->pacing;
    const Link_Codec* codec = pacing->env.codec;
    U8 frame[LINK_MAX_OVERHEAD + LINK_ANSWER_BYTES];
    U32 bytes = codec->nonceBytes;
    Link_Seal seal;
    seal.key = handshake->secrets[handshake->slot].hello;
    seal.session = handshake->present.key | LINK_NO_SEED;
    seal.number = version;
    seal.acked = 0;
    memcpy(frame + LINK_HEADER, of ? of->nonce : handshake->nonce, bytes);
    if (of) {
        seal.key = LINK_OWN_KEY(of, handshake);
        memcpy(frame + LINK_HEADER + bytes, of->peerNonce, bytes);
        memcpy(frame + LINK_PUBLIC_AT, of->secrets.publicKey, LINK_PUBLIC_BYTES);
        bytes = codec->sizes[LINK_KIND_HELLO_ACK];
    }
    (void)link_sendNow(
        pacing, frame,
        LINK_HEADER_OF(LINK_CONTROL | bytes, (U8)version, LINK_KIND_BITS(kind) | LINK_FEATURES),
        &seal);
}

void link_adoptCandidate(Link_Handshake* handshake, int isUnconfirmed) {
    handshake->present = handshake->candidate;
    handshake->hasCandidate = 0;
    handshake->state = LINK_STATE_UP;
    link_wipeCandidate(handshake);
    if (handshake->pacing->env.codec->isAuthenticated)
        link_drawNonce(handshake);
    if (isUnconfirmed) {
        handshake->isUnconfirmed = 1;
        handshake->helloEvery = LINK_HELLO_FIRST;
        handshake->helloAt = handshake->pacing->env.now;
    }
}

void link_wipeCandidate(Link_Handshake* handshake) {
    Ascon_wipe(&handshake->candidate.secrets, sizeof handshake->candidate.secrets);
}

void link_leave(Link_Handshake* handshake, Link_State next) {
    U32 now = handshake->pacing->env.now;
    handshake->state = (U8)next;
    link_drawNonce(handshake);
    handshake->isUnconfirmed = 0;
    handshake->helloAt = now;
    handshake->resetAt = now - LINK_HELLO_FIRST;
    handshake->helloEvery = LINK_HELLO_FIRST;
    Ascon_wipe(&handshake->present.secrets, sizeof handshake->present.secrets);
}

void link_forgetPeer(Link_Handshake* handshake) {
    handshake->hasCandidate = 0;
    handshake->resetAt = handshake->pacing->env.now;
}

void link_onUnknown(Link_Handshake* handshake, const U8* frame) {
    U32 now = handshake->pacing->env.now;
    if (handshake->state != LINK_STATE_IDLE || now - handshake->resetAt < LINK_HELLO_FIRST)
        return;
    handshake->resetAt = now;
    handshake->rules->sendHello(handshake, frame);
}

void link_pollHandshake(Link_Handshake* handshake) {
    U32 now = handshake->pacing->env.now;
    if (handshake->isAnswered && now - handshake->firstAnswer >= LINK_NONCE_LIFE)
        link_drawNonce(handshake);
    if ((handshake->state != LINK_STATE_CONNECTING && !handshake->isUnconfirmed) ||
        LINK_BEFORE(now, handshake->helloAt))
        return;
    if (handshake->isUnconfirmed)
        link_sendHandshake(handshake, &handshake->present, LINK_KIND_CONFIRM, LINK_VERSION);
    else
        handshake->rules->sendHello(handshake, 0);
    handshake->helloAt = now + handshake->helloEvery;
    if (handshake->helloEvery < LINK_HELLO_LAST)
        handshake->helloEvery *= 2U;
}
