/* SPDX-License-Identifier: MIT
 *
 * link_codec_clear: the codec without a key: frames end with a CRC.
 */
#include "link_session.h"

/* The party whose checksum a frame has. */
typedef enum Owner { NOBODY, HANDSHAKE, SESSION, CANDIDATE } Owner;

static U32 seal(const Link_Output* output, U8* frame, U32 header, U32 number) {
    U32 key = output->present.key;
    (void)number;
    if ((header & LINK_CONTROL) && LINK_IS_HANDSHAKE(header >> 21 & 7U))
        key |= LINK_NO_SEED;
    return link_seal(frame, header, key);
}

static int hasGoodCrc(const U8* frame, U32 key) {
    return link_crc(key, frame, LINK_LENGTH(frame) + LINK_OVERHEAD) == 0;
}

/* Returns the owner of a whole frame: the session, or one that a HELLO announced. */
static Owner ownerOf(const Link_Session* session, const U8* frame) {
    const Link_Identity* present = &session->output->present;
    const Link_Identity* candidate = &session->candidate;
    if (!link_isPlausible(session->output, frame))
        return NOBODY;
    if (LINK_IS_HANDSHAKE(LINK_KIND_OF(frame)))
        return hasGoodCrc(frame, LINK_NO_SEED) ? HANDSHAKE : NOBODY;
    if (session->state == LINK_STATE_UP && link_isOfEpoch(frame, present->key) &&
        hasGoodCrc(frame, present->key))
        return SESSION;
    return session->hasCandidate && link_isOfEpoch(frame, candidate->key) &&
                   hasGoodCrc(frame, candidate->key)
               ? CANDIDATE
               : NOBODY;
}

/* Tells whether a frame that the search has found may be believed, since it might be one by chance:
 * if it ends where the bytes end, or a good one follows. Returns 1 yes, 0 no, -1 not known yet. */
static int isConfirmed(const Link_Session* session, const U8* next, U32 left, int isEnd) {
    U32 payload;
    for (; left && *next == LINK_FILL; --left)
        ++next;
    if (left == 0)
        return 1;
    payload = LINK_LENGTH(next);
    if (payload > LINK_MAX_PAYLOAD)
        return 0;
    if (left < payload + LINK_OVERHEAD)
        return isEnd ? 0 : -1;
    return ownerOf(session, next) != NOBODY;
}

static U32 parse(Link_Input* input, const U8* bytes, U32 count, int isEnd) {
    Link_Output* output = input->output;
    U32 used = 0;
    while (used < count) {
        const U8* frame = bytes + used;
        U32 left = count - used;
        U32 size = LINK_LENGTH(frame) + LINK_OVERHEAD;
        if (*frame == LINK_FILL) {
            ++used;
            continue;
        }
        if (size <= LINK_MAX_FRAME && left < size && !isEnd)
            break;
        if (size <= LINK_MAX_FRAME && left >= size) {
            Owner owner = ownerOf(input->session, frame);
            int confirmed = 1;
            if (owner != NOBODY && input->outOfStep)
                confirmed = isConfirmed(input->session, frame + size, left - size, isEnd);
            if (confirmed < 0)
                break;
            if (confirmed && owner != NOBODY) {
                if (owner == CANDIDATE)
                    link_confirmCandidate(input->session);
                if (owner != HANDSHAKE)
                    output->heardAt = input->session->watch.provenAt = output->now;
                link_accept(input, frame, size);
                used += size;
                continue;
            }
        }
        link_skip(input, frame, left);
        ++used;
    }
    return used;
}

static void onHello(Link_Session* session, const U8* peerNonce, U32 features) {
    const Link_Identity* of = &session->output->present;
    /* A repeated HELLO means that the answer was lost, and gets the same one. */
    if (session->state != LINK_STATE_UP || link_get32(peerNonce) != link_get32(of->peerNonce)) {
        of = &session->candidate;
        link_makeCandidate(session, peerNonce, features);
        session->hasCandidate = 1;
    }
    link_sendHandshake(session, of, LINK_KIND_HELLO_ACK, LINK_VERSION);
}

static void onHandshake(Link_Session* session, const U8* frame, Link_Kind kind) {
    const U8* payload = frame + LINK_HEADER;
    if (kind == LINK_KIND_RST) { /* it may answer a frame with LINK_READY */
        if (session->state == LINK_STATE_UP &&
            ((LINK_EPOCH(frame) ^ LINK_KEY_EPOCH(session->output->present.key)) & 3U) == 0)
            link_lose(session);
    } else if (frame[1] != LINK_VERSION) {
        return;
    } else if (kind == LINK_KIND_HELLO) {
        onHello(session, payload, frame[2]);
    } else if (session->state == LINK_STATE_CONNECTING &&
               link_get32(payload + 4) == link_get32(session->nonce)) {
        link_makeCandidate(session, payload, frame[2]);
        link_confirmCandidate(session);
        link_oweAck(session->receiver); /* this first frame confirms it */
    }
}

static void call(Link_Session* session, const U8* unknown) {
    U8 reset[LINK_MAX_OVERHEAD];
    if (!unknown) {
        link_sendHandshake(session, 0, LINK_KIND_HELLO, LINK_VERSION);
        return;
    }
    session->output->present.key = LINK_EPOCH_KEY(LINK_EPOCH(unknown));
    (void)link_sendControl(session->output, reset, LINK_KIND_BITS(LINK_KIND_RST) | LINK_FEATURES, 0,
                           0);
}

const Link_Codec link_clear = {LINK_OVERHEAD, 4U,    LINK_CHECK,  0, {1, 4, 8, 0, 0, 0},
                               seal,          parse, onHandshake, 0, call};
