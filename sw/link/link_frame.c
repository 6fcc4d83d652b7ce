/* SPDX-License-Identifier: MIT
 *
 * link_frame: frames: checksum, building, and finding them in a stream of bytes.
 */
#include "link.h"

#include <string.h>

/* Adds the checksum and hands the frame over. 1: taken. */
int Link_sendFrame(Link* link, U8* frame, U32 payload, U16 seed) {
    U32 size = payload + LINK_OVERHEAD;
    U16 crc = Link_crc(seed, frame, size - 2U);
    frame[size - 2U] = (U8)(crc >> 8);
    frame[size - 1U] = (U8)crc;
    if (link->port->transmit(link->context, frame, size) != 0)
        return 0;
    if (LINK_BEFORE(link->paceUntil, link->now))
        link->paceUntil = link->now;
    /* A packet shorter than the longest is followed by the silence that sends it off. */
    link->paceUntil +=
        (size + (size < LINK_LONGEST(link) + LINK_OVERHEAD ? 4U : 0U)) * link->byteTimeUs16 >> 4;
    LINK_COUNT(link, framesSent, 1U);
    LINK_COUNT(link, bytesSent, size);
    return 1;
}

/* A control frame whose payload, `size` bytes, stands at frame + 3. 1: taken. */
int Link_sendControl(Link* link, U8* frame, Link_Kind kind, U32 byte1, U32 size) {
    U32 bits = (U32)kind << 5 | (U32)link->session.epoch << 2;
    U16 seed = link->session.seed;
    if (kind >= LINK_KIND_HELLO && kind <= LINK_KIND_RST) {
        bits |= LINK_FEATURES;
        seed = LINK_NO_SEED;
    }
    frame[0] = (U8)(LINK_CONTROL | size);
    frame[1] = (U8)byte1;
    frame[2] = (U8)bits;
    return Link_sendFrame(link, frame, size, seed);
}

static int hasGoodCrc(const U8* frame, U32 payload, U16 seed) {
    U32 size = payload + 3U;
    return Link_crc(seed, frame, size) == ((U32)frame[size] << 8 | frame[size + 1U]);
}

static U32 kindOf(const U8* frame) {
    return frame[0] & LINK_CONTROL ? frame[2] >> 5 : LINK_KIND_DATA;
}

/* Whether a header makes sense; it keeps chance from passing garbage on to the checksum. */
static int isPlausible(const U8* frame, U32 payload) {
    static const U8 sizes[] = {1, 4, 8, 0, 0, 0}; /* by Link_Kind */
    U32 kind = kindOf(frame);
    if (kind == LINK_KIND_DATA)
        return payload != 0 || (frame[2] & LINK_LAST);
    if (kind > LINK_KIND_PING)
        return payload >= 2U;
    return payload == sizes[kind] || (kind == LINK_KIND_ACK && payload == 5U);
}

typedef enum Owner { NOBODY, HANDSHAKE, SESSION, CANDIDATE } Owner;

/* Whose checksum a whole frame has: the session's, or that of one that a HELLO announced. */
static Owner ownerOf(const Link* link, const U8* frame, U32 payload) {
    U32 kind = kindOf(frame);
    U32 epoch = frame[2] >> 2 & 7U;
    if (!isPlausible(frame, payload))
        return NOBODY;
    if (kind >= LINK_KIND_HELLO && kind <= LINK_KIND_RST)
        return hasGoodCrc(frame, payload, LINK_NO_SEED) ? HANDSHAKE : NOBODY;
    if (link->state == LINK_STATE_UP && epoch == link->session.epoch &&
        hasGoodCrc(frame, payload, link->session.seed))
        return SESSION;
    return link->hasCandidate && epoch == link->candidate.epoch &&
                   hasGoodCrc(frame, payload, link->candidate.seed)
               ? CANDIDATE
               : NOBODY;
}

/* After something that was no frame, the search at every byte might find one by chance. So there a
 * frame is believed only if it ends where the bytes end, or a good one follows. -1: not known yet.
 */
static int isConfirmed(const Link* link, const U8* next, U32 left, int isEnd) {
    U32 payload;
    if (left == 0)
        return 1;
    payload = next[0] & 0x7FU;
    if (payload > LINK_MAX_PAYLOAD)
        return 0;
    if (left < payload + LINK_OVERHEAD)
        return isEnd ? 0 : -1;
    return ownerOf(link, next, payload) != NOBODY;
}

/* Acts upon a good frame. */
static void takeFrame(Link* link, const U8* frame, U32 payload, Owner owner) {
    U32 kind = kindOf(frame);
    if (owner == HANDSHAKE) {
        Link_onHandshake(link, frame, (Link_Kind)kind);
        return;
    }
    if (owner == CANDIDATE)
        Link_confirmCandidate(link);
    link->heardAt = link->now;
    if (kind == LINK_KIND_DATA) {
        Link_onData(link, frame[1], frame[2], frame + 3, payload);
    } else if (kind == LINK_KIND_ACK) {
        Link_onAck(link, frame[1], frame[3], payload == 5U ? Link_get32(frame + 4) : 0);
    } else if (kind == LINK_KIND_BYE) {
        Link_lose(link);
    } else if (kind == LINK_KIND_PING) {
        link->ackDue = link->ackNow = 1;
    } else {
        /* Such a frame is not sent while a message is held: the whole window is open. */
        Link_onAck(link, frame[3], link->fullCredit, 0);
        Link_onData(link, frame[1],
                    LINK_FIRST | LINK_LAST | (kind == LINK_KIND_RIDE_ASK ? LINK_ACK_NOW : 0U) |
                        (frame[2] & 3U),
                    frame + 4, payload - 1U);
    }
}

/* Somebody talks in a session that is not known here: say so, but not too often. */
static void refuse(Link* link, const U8* frame) {
    U8 reset[LINK_OVERHEAD];
    if (link->state != LINK_STATE_IDLE || LINK_BEFORE(link->now, link->pingAt))
        return;
    link->pingAt = link->now + LINK_HELLO_FIRST;
    link->session.epoch = frame[2] >> 2 & 7U;
    (void)Link_sendControl(link, reset, LINK_KIND_RST, 0, 0);
}

/* Takes all whole frames out of the bytes; returns how many it is done with. After a bad one it
 * goes on at the next byte; `isEnd`: a silence follows, so half a frame will never become whole. */
static U32 parse(Link* link, const U8* bytes, U32 count, int isEnd) {
    U32 used = 0;
    while (used < count) {
        const U8* frame = bytes + used;
        U32 left = count - used;
        U32 payload = frame[0] & 0x7FU;
        U32 size = payload + LINK_OVERHEAD;
        if (payload <= LINK_MAX_PAYLOAD && left < size && !isEnd)
            break;
        if (payload <= LINK_MAX_PAYLOAD && left >= size) {
            Owner owner = ownerOf(link, frame, payload);
            int confirmed = 1;
            if (LINK_WINDOW > 1U && owner != NOBODY && link->outOfStep)
                confirmed = isConfirmed(link, frame + size, left - size, isEnd);
            if (confirmed < 0)
                break;
            if (confirmed && owner != NOBODY) {
                link->outOfStep = 0;
                takeFrame(link, frame, payload, owner);
                LINK_COUNT(link, framesReceived, 1U);
                LINK_COUNT(link, bytesReceived, size);
                used += size;
                continue;
            }
        }
        if (!link->outOfStep) {
            LINK_COUNT(link, crcErrors, 1U);
            if (left >= LINK_OVERHEAD)
                refuse(link, frame);
        }
        link->outOfStep = 1;
        LINK_COUNT(link, bytesSkipped, 1U);
        ++used;
    }
    return used;
}

static void parseInput(Link* link, int isEnd) {
    U32 used = parse(link, link->input, link->inputCount, isEnd);
    link->inputCount = (U8)(link->inputCount - used);
    memmove(link->input, link->input + used, link->inputCount);
}

void Link_receive(Link* link, const U8* bytes, U32 size, int isPacketEnd, U32 nowUs) {
    link->now = nowUs;
    while (size) {
        U32 part = LINK_INPUT_BYTES - link->inputCount;
        if (LINK_WINDOW > 1U && link->inputCount == 0) {
            /* The usual case, a whole frame: it is read where it is. */
            U32 used = parse(link, bytes, size, 0);
            bytes += used;
            size -= used;
        }
        if (part > size)
            part = size;
        memcpy(link->input + link->inputCount, bytes, part);
        link->inputCount = (U8)(link->inputCount + part);
        link->inputAt = nowUs;
        bytes += part;
        size -= part;
        parseInput(link, 0);
    }
    if (isPacketEnd)
        parseInput(link, 1);
}

void Link_pollInput(Link* link) {
    if (link->inputCount && !LINK_BEFORE(link->now, link->inputAt + LINK_FRAME_GAP))
        parseInput(link, 1);
}
