/* SPDX-License-Identifier: MIT
 *
 * link_handshake_clear: makes sessions without a key. A HELLO is answered with HELLO-ACK. The first
 * frame that the peer sends in the new session confirms the session.
 */
#include "link_handshake_clear.h"

static U32 cost(const Link_Handshake* handshake, const U8* frame) {
    (void)handshake;
    (void)frame;
    return 1;
}

static int expect(Link_Handshake* handshake, const U8* frame, U32 attempt, Link_Seal* seal) {
    if (LINK_IS_HANDSHAKE(LINK_KIND_OF(frame))) {
        seal->session = LINK_NO_SEED;
        return attempt == 0;
    }
    seal->session = handshake->candidate.key;
    return attempt && handshake->hasCandidate && link_isOfEpoch(frame, seal->session);
}

static void onHello(Link_Handshake* handshake, const U8* peerNonce, U32 features) {
    const Link_Identity* of = &handshake->present;
    /* A repeated HELLO means that the answer was lost. The answer is therefore sent again. */
    if (handshake->state != LINK_STATE_UP || link_get32(peerNonce) != link_get32(of->peerNonce)) {
        of = &handshake->candidate;
        link_makeCandidate(handshake, peerNonce, features);
        handshake->hasCandidate = 1;
    }
    link_sendHandshake(handshake, of, LINK_KIND_HELLO_ACK, LINK_VERSION);
}

static U32 onFrame(Link_Handshake* handshake, const U8* frame, U32 attempt) {
    const U8* payload = frame + LINK_HEADER;
    Link_Kind kind = LINK_KIND_OF(frame);
    U32 epoch = LINK_KEY_EPOCH(handshake->present.key);
    (void)attempt;
    /* an RST repeats the EPOCH of the frame that it answers; the bit LINK_READY of this EPOCH may
     * be inverted */
    if (kind == LINK_KIND_RST)
        return handshake->state == LINK_STATE_UP && ((LINK_EPOCH(frame) ^ epoch) & 3U) == 0
                   ? LINK_VERDICT_LOST
                   : LINK_VERDICT_NONE;
    if (frame[1] != LINK_VERSION)
        return LINK_VERDICT_NONE;
    if (kind == LINK_KIND_HELLO) {
        onHello(handshake, payload, frame[2]);
        return LINK_VERDICT_NONE;
    }
    if (handshake->state != LINK_STATE_CONNECTING ||
        link_get32(payload + 4) != link_get32(handshake->nonce))
        return LINK_VERDICT_NONE;
    link_makeCandidate(handshake, payload, frame[2]);
    /* the acknowledgement, the first frame of this side, confirms the session to the peer */
    return LINK_VERDICT_BEGIN | LINK_VERDICT_ACK;
}

static void sendHello(Link_Handshake* handshake, const U8* unknown) {
    U8 reset[LINK_MAX_OVERHEAD];
    Link_Seal seal;
    if (!unknown) {
        link_sendHandshake(handshake, 0, LINK_KIND_HELLO, LINK_VERSION);
        return;
    }
    /* later HELLO frames also have this epoch */
    handshake->present.key = LINK_EPOCH_KEY(LINK_EPOCH(unknown));
    seal.session = handshake->present.key | LINK_NO_SEED;
    (void)link_sendNow(
        handshake->pacing, reset,
        LINK_CONTROL_HEADER(LINK_KIND_RST, 0, 0) | LINK_HEADER_OF(0U, 0U, LINK_FEATURES), &seal);
}

const Link_HandshakeRules link_clearHandshake = {cost, expect, onFrame, sendHello};
