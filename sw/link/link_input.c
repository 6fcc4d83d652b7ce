/* SPDX-License-Identifier: MIT
 *
 * link_input: finds frames in a stream of bytes, and gives each to its part of the layer.
 */
#include "link.h"

#include <string.h>

/* The party whose checksum a frame has. */
typedef enum Owner { NOBODY, HANDSHAKE, SESSION, CANDIDATE } Owner;

static int hasGoodCrc(const U8* frame, U32 key) {
    return link_crc(key, frame, LINK_LENGTH(frame) + LINK_OVERHEAD) == 0;
}

static Link_Kind kindOf(const U8* frame) {
    return frame[0] & LINK_CONTROL ? (Link_Kind)(frame[2] >> 5) : LINK_KIND_DATA;
}

/* True if a header makes sense: most garbage fails here, before the checksum. */
static int isPlausible(const Link* link, const U8* frame) {
    static const U8 sizes[2][6] = {{1, 4, 8, 0, 0, 0}, {1, 8, 16, 16, 0, 0}}; /* by Link_Kind */
    U32 payload = LINK_LENGTH(frame) + LINK_OVERHEAD - link->overhead;
    Link_Kind kind = kindOf(frame);
    if (kind == LINK_KIND_DATA)
        return payload != 0 || (frame[2] & LINK_LAST);
    if (kind > LINK_KIND_PING)
        return payload >= 2U;
    if (kind == LINK_KIND_ACK)
        return payload - 1U <= LINK_BITMAP;
    return payload == sizes[LINK_IS_SECURE(link)][kind];
}

/* Returns the owner of a whole frame: the session, or one that a HELLO announced. */
static Owner ownerOf(const Link* link, const U8* frame) {
    const Link_Session* candidate = &link->handshake.candidate;
    U32 epoch = LINK_EPOCH(frame);
    if (!isPlausible(link, frame))
        return NOBODY;
    if (LINK_IS_HANDSHAKE(kindOf(frame)))
        return hasGoodCrc(frame, LINK_NO_SEED) ? HANDSHAKE : NOBODY;
    if (link->state == LINK_STATE_UP && epoch == LINK_KEY_EPOCH(link->session.key) &&
        hasGoodCrc(frame, link->session.key))
        return SESSION;
    return link->handshake.hasCandidate && epoch == LINK_KEY_EPOCH(candidate->key) &&
                   hasGoodCrc(frame, candidate->key)
               ? CANDIDATE
               : NOBODY;
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
    Link_Kind kind = kindOf(frame);
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

/* The same as ownerOf, with a key; copies the frame, and decrypts the copy. The search looks at a
 * frame of the handshake only where the bytes end with it, as its packet does. */
static Owner decipher(Link* link, const U8* frame, U8* copy, int isSearch, int isLast) {
    U32 size = LINK_LENGTH(frame) + LINK_OVERHEAD;
    U32 rounds = LINK_ROUNDS_OF(size - link->overhead);
    Link_Kind kind = kindOf(frame);
    int isHandshake = LINK_IS_HANDSHAKE(kind);
    if (size < link->overhead || !isPlausible(link, frame))
        return NOBODY;
    if (isHandshake) {
        if ((isSearch && !isLast) || !link_isOfUse(link, frame, kind))
            return NOBODY;
        rounds = kind == LINK_KIND_HELLO ? LINK_ROUNDS_HELLO : LINK_ROUNDS_HANDSHAKE;
    } else if (link->state != LINK_STATE_UP ||
               LINK_EPOCH(frame) != LINK_KEY_EPOCH(link->session.key)) {
        return NOBODY;
    }
    if (isSearch && !mayTry(link, rounds))
        return NOBODY;
    memcpy(copy, frame, size);
    if (isHandshake)
        return link_isGenuine(link, copy, kind) ? HANDSHAKE : NOBODY;
    return decrypt(link, copy) ? SESSION : NOBODY;
}

/* Tells whether a frame that the search has found may be believed. The search at every byte behind
 * something that was no frame might find one by chance; so there a frame counts only if it ends
 * where the bytes end, or a good one follows. Returns 1 yes, 0 no, -1 not known yet. */
static int isConfirmed(const Link* link, const U8* next, U32 left, int isEnd) {
    U32 payload;
    if (left == 0)
        return 1;
    payload = LINK_LENGTH(next);
    if (payload > LINK_MAX_PAYLOAD)
        return 0;
    if (left < payload + LINK_OVERHEAD)
        return isEnd ? 0 : -1;
    return ownerOf(link, next) != NOBODY;
}

static int onPiggyback(Link* link, const U8* frame) {
    const U8* payload = frame + LINK_HEADER;
    U32 flags = LINK_FIRST | LINK_LAST | LINK_CHANNEL(frame[2]);
    if (kindOf(frame) == LINK_KIND_PIGGYBACK_ASK)
        flags |= LINK_ACK_NOW;
    /* A peer sends no such frame while a message is held: the whole window is open. */
    link_onAck(link, payload[0], link->sender.fullCredit, 0, 0);
    return link_onData(link, frame[1], flags, payload + 1, LINK_LENGTH(frame) - 1U);
}

/* Acts upon a good frame. */
static void takeFrame(Link* link, const U8* frame, Owner owner) {
    const U8* payload = frame + LINK_HEADER;
    U32 size = LINK_LENGTH(frame);
    U32 duplicates = link->statistics.duplicates;
    Link_Kind kind = kindOf(frame);
    int isFair = 1;
    if (owner == HANDSHAKE) {
        if (LINK_IS_SECURE(link))
            link_onGenuine(link, frame, kind);
        else
            link_onHandshake(link, frame, kind);
        return;
    }
    if (owner == CANDIDATE)
        link_confirmCandidate(link);
    if (!LINK_IS_SECURE(link))
        link->heardAt = link->now;
    link->handshake.isUnconfirmed = 0;
    if (!LINK_BEFORE(link->now, link->pingAt))
        link->pingAt = link->now; /* or it would in time be so old that it reads as a future time */
    if (kind == LINK_KIND_DATA) {
        isFair = link_onData(link, frame[1], frame[2], payload, size);
    } else if (kind == LINK_KIND_ACK) {
        link_onAck(link, frame[1], payload[0], payload + 1, size - 1U);
    } else if (kind == LINK_KIND_BYE) {
        link_lose(link);
    } else if (kind == LINK_KIND_PING && LINK_IS_SECURE(link)) {
        link_onPing(link, frame);
    } else if (kind == LINK_KIND_PING) {
        link->receiver.ackDue = link->receiver.ackNow = 1;
    } else {
        isFair = onPiggyback(link, frame);
    }
    /* What was heard before may be an attacker's recording, and is no sign of life; link_onAck and
     * link_onPing look themselves. */
    if (kind >= LINK_KIND_PIGGYBACK && duplicates == link->statistics.duplicates)
        link->heardAt = link->now;
    if (!isFair)
        link_abort(link);
}

/* Answers a peer that talks in an unknown session, but not too often. */
static void refuse(Link* link, const U8* frame) {
    U8 reset[LINK_MAX_OVERHEAD];
    if (link->state != LINK_STATE_IDLE || link->now - link->pingAt < LINK_HELLO_FIRST)
        return;
    link->pingAt = link->now;
    if (LINK_IS_SECURE(link)) { /* its answer makes a new session */
        link_call(link);
        return;
    }
    link->session.key = LINK_EPOCH_KEY(LINK_EPOCH(frame));
    (void)link_sendControl(link, reset, LINK_KIND_RST, 0, 0, LINK_FEATURES);
}

/* Counts a byte where no frame begins; the first one behind a frame may be of an unknown session.
 */
static void skip(Link* link, const U8* frame, U32 left) {
    if (!link->parser.outOfStep) {
        ++link->statistics.crcErrors;
        if (left >= link->overhead)
            refuse(link, frame);
    }
    link->parser.outOfStep = 1;
    ++link->statistics.bytesSkipped;
}

static void accept(Link* link, const U8* frame, U32 size, Owner owner) {
    link->parser.outOfStep = 0;
    link_hear(link, size);
    takeFrame(link, frame, owner);
    ++link->statistics.framesReceived;
    link->statistics.bytesReceived += size;
}

/* Takes all whole frames out of the bytes; returns the number of bytes used. After a bad
 * frame it goes on at the next byte. `isEnd`: a silence follows, so half a frame will never become
 * whole. */
static U32 parse(Link* link, const U8* bytes, U32 count, int isEnd) {
    U32 used = 0;
    while (used < count) {
        const U8* frame = bytes + used;
        U32 left = count - used;
        U32 size = LINK_LENGTH(frame) + LINK_OVERHEAD;
        if (size <= LINK_MAX_FRAME && left < size && !isEnd)
            break;
        if (size <= LINK_MAX_FRAME && left >= size) {
            Owner owner = ownerOf(link, frame);
            int confirmed = 1;
            if (owner != NOBODY && link->parser.outOfStep)
                confirmed = isConfirmed(link, frame + size, left - size, isEnd);
            if (confirmed < 0)
                break;
            if (confirmed && owner != NOBODY) {
                accept(link, frame, size, owner);
                used += size;
                continue;
            }
        }
        skip(link, frame, left);
        ++used;
    }
    return used;
}

/* The same with a key. A tag needs no confirmation, so a frame is taken when its last byte is
 * there, even behind the beginning of another that is not whole: that may be an attacker's, who
 * would have it wait. The frames that end within the first `tried` bytes were looked at before. */
static U32 parseKeyed(Link* link, const U8* bytes, U32 count, U32 tried, int isEnd) {
    U8 copy[LINK_MAX_FRAME];
    U32 used = 0;
    U32 at = 0;
    while (at < count) {
        U32 end = at + LINK_LENGTH(bytes + at) + LINK_OVERHEAD;
        int isFrame = end - at <= LINK_MAX_FRAME;
        if (isFrame && end > tried && end <= count) {
            int isSearch = link->parser.outOfStep || at != used;
            Owner owner = decipher(link, bytes + at, copy, isSearch, end == count);
            if (owner != NOBODY) {
                accept(link, copy, end - at, owner);
                at = used = end;
                continue;
            }
        }
        if (at == used && (!isFrame || end <= count || isEnd)) {
            skip(link, bytes + at, count - at);
            ++used;
        }
        ++at;
    }
    return used;
}

static U32 parseAny(Link* link, const U8* bytes, U32 count, U32 tried, int isEnd) {
    return LINK_IS_SECURE(link) ? parseKeyed(link, bytes, count, tried, isEnd)
                                : parse(link, bytes, count, isEnd);
}

/* Parses the kept bytes, and keeps an incomplete frame. */
static void parseKept(Link* link, U32 tried, int isEnd) {
    Link_Parser* parser = &link->parser;
    U32 used = parseAny(link, link->input, parser->count, tried, isEnd);
    parser->count = (U8)(parser->count - used);
    memmove(link->input, link->input + used, parser->count);
}

void Link_receive(Link* link, const U8* bytes, U32 size, U32 nowUs) {
    Link_Parser* parser = &link->parser;
    link->now = nowUs;
    link_pollInput(link);
    if (size == 0)
        return; /* or no silence would ever be seen; bytes may be null */
    parser->at = nowUs;
    if (parser->count == 0) {
        /* The usual case: a whole frame is read in place. The rest fits. */
        U32 used = parseAny(link, bytes, size, 0, 0);
        parser->count = (U8)(size - used);
        memcpy(link->input, bytes + used, parser->count);
        return;
    }
    while (size) {
        U32 had = parser->count;
        U32 part = sizeof link->input - had;
        if (part > size)
            part = size;
        memcpy(link->input + had, bytes, part);
        parser->count = (U8)(had + part);
        bytes += part;
        size -= part;
        parseKept(link, had, 0);
    }
}

void link_pollInput(Link* link) {
    Link_Parser* parser = &link->parser;
    if (LINK_BEFORE(link->now, parser->at + LINK_FRAME_GAP))
        return;
    if (parser->count)
        parseKept(link, parser->count, 1);
    if (LINK_IS_SECURE(link)) /* a tag needs no confirmation, a CRC does */
        parser->outOfStep = 0;
}
