/* SPDX-License-Identifier: MIT
 *
 * link_search: finds frames among the bytes that the radio delivers.
 */
#include "link_search.h"

#include <string.h>

/* Returns whether a header is plausible. Most garbage is rejected here, before a checksum is
 * computed. */
static int isPlausible(const Link_Codec* codec, const U8* frame) {
    U32 size = LINK_LENGTH(frame) + LINK_OVERHEAD;
    U32 payload = size - codec->overhead;
    Link_Kind kind = LINK_KIND_OF(frame);
    if (size < codec->overhead)
        return 0;
    if (kind == LINK_KIND_DATA)
        return payload != 0 || (frame[2] & LINK_LAST);
    if (kind > LINK_KIND_PING)
        return payload >= 2U;
    if (kind == LINK_KIND_ACK)
        return payload - 1U <= LINK_BITMAP;
    return payload == codec->sizes[kind];
}

/* Charges the cost of one frame, in rounds of Ascon, to the search budget. Returns whether the
 * budget was sufficient. Without the budget, hostile bytes with many headers could keep the CPU
 * busy. */
static int mayTry(Link_Search* search, U32 rounds) {
    U32 now = search->session->handshake.pacing->env.now;
    U32 debt = search->paidAt - now;
    /* a larger difference means that paidAt is in the past, so nothing is owed */
    if (debt > LINK_ROUNDS_AT_ONCE * LINK_ROUND_EVERY)
        debt = 0;
    debt += rounds * LINK_ROUND_EVERY;
    if (debt > LINK_ROUNDS_AT_ONCE * LINK_ROUND_EVERY)
        return 0;
    search->paidAt = now + debt;
    return 1;
}

/* Opens a plausible frame with the seal that the session expects for it. Returns the opened frame,
 * which is in place or in `copy`, and sets `attempt` to the attempt that has opened it. Returns 0
 * if no seal matches. */
static const U8* unseal(const Link_Search* search, const U8* frame, U8* copy, U32* attempt) {
    const Link_Codec* codec = search->session->handshake.pacing->env.codec;
    const U8* opened;
    Link_Seal seal;
    for (*attempt = 0; *attempt < 2U; ++*attempt)
        if (link_expect(search->session, frame, *attempt, &seal) &&
            (opened = codec->open(frame, copy, &seal)) != 0)
            return opened;
    return 0;
}

/* Returns 1 if a frame without a tag that the search has found can be trusted, 0 if not, and -1 if
 * this is not known yet. The checksum of such a frame might match by coincidence. The frame is
 * therefore trusted only if the bytes end after it, or if a valid frame follows. */
static int isConfirmed(const Link_Search* search, const U8* next, U32 left, int isEnd) {
    const Link_Codec* codec = search->session->handshake.pacing->env.codec;
    U32 size, attempt;
    for (; left && *next == LINK_FILL; --left)
        ++next;
    if (left == 0)
        return 1;
    size = LINK_LENGTH(next) + LINK_OVERHEAD;
    if (size > LINK_MAX_FRAME)
        return 0;
    if (left < size)
        return isEnd ? 0 : -1;
    return isPlausible(codec, next) && unseal(search, next, 0, &attempt);
}

/* Processes a complete frame that is followed by `left` bytes. `isSearch` is 1 if no frame ends
 * directly before it. Returns 1 if the frame was processed, 0 if it is not a frame for this side,
 * and -1 if this is not known yet. */
static int take(Link_Search* search, const U8* frame, U32 left, int isSearch, int isEnd) {
    Link_Session* session = search->session;
    Link_Env* env = &session->handshake.pacing->env;
    U8 copy[LINK_MAX_FRAME];
    U32 size = LINK_LENGTH(frame) + LINK_OVERHEAD;
    U32 attempt, rounds = 0;
    const U8* opened;
    int confirmed = 1;
    if (isPlausible(env->codec, frame))
        rounds = link_costOf(session, frame);
    if (!rounds)
        return 0;
    if (isSearch && env->codec->isAuthenticated) {
        int isHandshake = LINK_IS_HANDSHAKE(LINK_KIND_OF(frame));
        if (isHandshake && left)
            return 0;
        if (!mayTry(search, rounds))
            /* a handshake frame is tried again after a silence, in which the budget grows */
            return isHandshake ? -1 : 0;
    }
    opened = unseal(search, frame, copy, &attempt);
    if (!opened && env->codec->isAuthenticated)
        link_onForgery(session, frame);
    if (opened && isSearch && !env->codec->isAuthenticated)
        confirmed = isConfirmed(search, frame + size, left, isEnd);
    if (!opened || confirmed <= 0)
        return opened ? confirmed : 0;
    search->outOfStep = 0;
    link_hear(session->handshake.pacing, size);
    ++env->statistics.framesReceived;
    env->statistics.bytesReceived += size;
    link_onFrame(session, opened, attempt);
    return 1;
}

/* Counts a byte at which no frame begins. If the byte directly follows a frame, it may be the first
 * byte of a frame of an unknown session. Such a frame is answered, unless the length in its header
 * is impossible, as in a broadcast. */
static void skip(Link_Search* search, const U8* frame, U32 left) {
    Link_Env* env = &search->session->handshake.pacing->env;
    if (!search->outOfStep && LINK_LENGTH(frame) <= LINK_MAX_PAYLOAD &&
        left >= env->codec->overhead)
        link_onUnknown(&search->session->handshake, frame);
    search->outOfStep = 1;
    ++env->statistics.bytesSkipped;
}

/* Processes all complete frames in the bytes. `isEnd` is 1 if a silence has followed: an incomplete
 * frame is then not continued. Returns the number of bytes used.
 *
 * Without a key, the bytes after an incomplete frame must wait until it is complete. With a key, a
 * frame has a tag and needs no confirmation. It is processed when its last byte arrives, even if
 * its bytes follow the beginning of another frame: that beginning may come from an attacker who
 * wants to delay the genuine frame. Frames that end within bytes kept from earlier calls were
 * already checked.
 *
 * An attacker can send bytes that look like a handshake frame at the end of each portion that the
 * caller reads, and so use up the search budget before the genuine frame arrives. If the budget
 * does not suffice for a handshake frame at the end of the bytes, this frame is therefore kept, and
 * tried again after a silence. */
static U32 parse(Link_Search* search, const U8* bytes, U32 count, int isEnd) {
    int isSure = search->session->handshake.pacing->env.codec->isAuthenticated;
    U32 used = 0;
    U32 at = 0;
    while (at < count) {
        const U8* frame = bytes + at;
        U32 end = at + LINK_LENGTH(frame) + LINK_OVERHEAD;
        int isFrame = end - at <= LINK_MAX_FRAME;
        int taken = 0;
        if (isFrame && end <= count &&
            (!isSure || end > search->count ||
             (isEnd && end == count && LINK_IS_HANDSHAKE(LINK_KIND_OF(frame)))))
            taken = take(search, frame, count - end, search->outOfStep || at != used, isEnd);
        if (taken > 0) {
            at = used = end;
            continue;
        }
        if (!isSure && (taken < 0 || (isFrame && end > count && !isEnd)))
            break;
        if (at == used && (isEnd || !isFrame || (end <= count && taken == 0))) {
            if (*frame != LINK_FILL)
                skip(search, frame, count - at);
            ++used;
        }
        ++at;
    }
    return used;
}

/* Parses the `count` bytes that are kept, and continues to keep an incomplete frame. */
static void parseKept(Link_Search* search, U32 count, int isEnd) {
    U32 used = parse(search, search->bytes, count, isEnd);
    search->count = (U8)(count - used);
    memmove(search->bytes, search->bytes + used, search->count);
}

void link_pollSearch(Link_Search* search) {
    const Link_Env* env = &search->session->handshake.pacing->env;
    if (LINK_BEFORE(env->now, search->at + LINK_FRAME_GAP))
        return;
    if (search->count)
        parseKept(search, search->count, 1);
    if (env->codec->isAuthenticated)
        search->outOfStep = 0;
}

void link_takeBytes(Link_Search* search, const U8* bytes, U32 size) {
    link_pollSearch(search);
    if (size == 0)
        /* returns without recording the time: an empty portion must not hide a silence; `bytes` may
         * be null */
        return;
    search->at = search->session->handshake.pacing->env.now;
    /* the usual case: no bytes are kept, and a complete frame is read in place */
    if (search->count == 0) {
        U32 used = parse(search, bytes, size, 0);
        search->count = (U8)(size - used);
        memcpy(search->bytes, bytes + used, search->count);
        return;
    }
    while (size) {
        U32 had = search->count;
        U32 part = sizeof search->bytes - had;
        if (part > size)
            part = size;
        memcpy(search->bytes + had, bytes, part);
        bytes += part;
        size -= part;
        parseKept(search, had + part, 0);
    }
}
