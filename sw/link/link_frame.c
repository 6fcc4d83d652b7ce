/* SPDX-License-Identifier: MIT
 *
 * link_frame: frames: checksum, building, and finding them in a stream of bytes.
 */
#include "link.h"

/* CRC-16/CCITT, polynomial 0x1021, MSB first; four bits at a time, so that the table is small. */
U16 Link_crc(U16 seed, const U8* bytes, U32 size) {
    static const U16 table[16] = {0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50A5, 0x60C6, 0x70E7,
                                  0x8108, 0x9129, 0xA14A, 0xB16B, 0xC18C, 0xD1AD, 0xE1CE, 0xF1EF};
    U32 crc = seed;
    U32 i;
    for (i = 0; i < size; ++i) {
        crc = (crc << 4 & 0xFFF0U) ^ table[crc >> 12 ^ (U32)(bytes[i] >> 4)];
        crc = (crc << 4 & 0xFFF0U) ^ table[crc >> 12 ^ (U32)(bytes[i] & 15U)];
    }
    return (U16)crc;
}

int Link_isBefore(U32 a, U32 b) {
    return (S32)(a - b) < 0;
}

U32 Link_get32(const U8* p) {
    return (U32)p[0] | (U32)p[1] << 8 | (U32)p[2] << 16 | (U32)p[3] << 24;
}

void Link_put32(U8* p, U32 value) {
    p[0] = (U8)value;
    p[1] = (U8)(value >> 8);
    p[2] = (U8)(value >> 16);
    p[3] = (U8)(value >> 24);
}

/* Adds the checksum and hands the frame over. 1: taken. */
int Link_sendFrame(Link* link, U8* frame, U32 payload, U16 seed, U32 now) {
    U32 size = payload + LINK_OVERHEAD;
    U16 crc = Link_crc(seed, frame, size - 2U);
    U32 start = Link_isBefore(link->paceUntil, now) ? now : link->paceUntil;
    frame[size - 2U] = (U8)(crc >> 8);
    frame[size - 1U] = (U8)crc;
    if (link->port->transmit(link->context, frame, size) != 0)
        return 0;
    /* A packet shorter than the longest is followed by the silence that sends it off. */
    link->paceUntil =
        start + ((size + (size < LINK_MAX_FRAME ? 4U : 0U)) * link->byteTimeUs16 >> 4);
    ++link->statistics.framesSent;
    link->statistics.bytesSent += size;
    return 1;
}

U8 Link_controlBits(const Link_Session* session, Link_Kind kind) {
    return (U8)((U32)kind << 5 | (U32)session->epoch << 2);
}

int Link_sendControl(Link* link, Link_Kind kind, U8 byte1, const U8* payload, U32 size, U32 now) {
    U8 frame[LINK_OVERHEAD + 8U];
    U32 i;
    frame[0] = (U8)(LINK_CONTROL | size);
    frame[1] = byte1;
    frame[2] = Link_controlBits(&link->session, kind);
    for (i = 0; i < size; ++i)
        frame[3U + i] = payload[i];
    return Link_sendFrame(
        link, frame, size,
        kind == LINK_KIND_ACK || kind >= LINK_KIND_BYE ? link->session.seed : 0xFFFFU, now);
}

/* Whether a header makes sense now; it keeps chance from passing garbage on to the checksum. */
static int isPlausibleControl(U32 kind, U32 payload) {
    static const U8 sizes[LINK_KINDS] = {1, 4, 8, 0, 0, 0};
    if (kind >= LINK_KINDS)
        return 0;
    return payload == sizes[kind] || (kind == LINK_KIND_ACK && payload == 5U);
}

static int hasGoodCrc(const U8* frame, U32 payload, U16 seed) {
    U32 size = payload + LINK_OVERHEAD;
    return Link_crc(seed, frame, size - 2U) == (U32)((U32)frame[size - 2U] << 8 | frame[size - 1U]);
}

/* A frame of the session, or the first one of a session that a HELLO announced. */
static int belongsToSession(Link* link, const U8* frame, U32 payload, U32 now) {
    U32 epoch = frame[2] >> 2 & 7U;
    if (link->state == LINK_STATE_UP && epoch == link->session.epoch &&
        hasGoodCrc(frame, payload, link->session.seed))
        return 1;
    if (link->hasCandidate && epoch == link->candidate.epoch &&
        hasGoodCrc(frame, payload, link->candidate.seed)) {
        Link_confirmCandidate(link, now);
        return 1;
    }
    return 0;
}

/* Acts upon one whole frame. 0: it is none. */
static int takeFrame(Link* link, const U8* frame, U32 payload, U32 now) {
    U32 kind = frame[2] >> 5;
    if (!(frame[0] & LINK_CONTROL)) {
        if ((payload == 0 && !(frame[2] & LINK_LAST)) ||
            !belongsToSession(link, frame, payload, now))
            return 0;
        link->heardAt = now;
        Link_onData(link, frame, payload, now);
        return 1;
    }
    if (!isPlausibleControl(kind, payload))
        return 0;
    if (kind == LINK_KIND_HELLO || kind == LINK_KIND_HELLO_ACK || kind == LINK_KIND_RST) {
        if (!hasGoodCrc(frame, payload, 0xFFFFU))
            return 0;
        if (kind == LINK_KIND_HELLO)
            Link_onHello(link, frame, now);
        else if (kind == LINK_KIND_HELLO_ACK)
            Link_onHelloAck(link, frame, now);
        else
            Link_onReset(link, (U8)(frame[2] >> 2 & 7U), now);
        return 1;
    }
    if (!belongsToSession(link, frame, payload, now))
        return 0;
    link->heardAt = now;
    if (kind == LINK_KIND_ACK)
        Link_onAck(link, frame, payload, now);
    else if (kind == LINK_KIND_BYE)
        Link_endSession(link, link->wanted ? LINK_STATE_CONNECTING : LINK_STATE_IDLE, now);
    else
        link->ackDue = link->ackNow = 1;
    return 1;
}

static void discard(Link* link, U32 count) {
    U32 i;
    link->inputCount -= count;
    for (i = 0; i < link->inputCount; ++i)
        link->input[i] = link->input[i + count];
}

/* Somebody talks in a session that is not known here: say so, but not too often. */
static void refuse(Link* link, U32 now) {
    if (Link_isBefore(now, link->pingAt))
        return;
    link->pingAt = now + LINK_HELLO_FIRST;
    link->session.epoch = (U8)(link->input[2] >> 2 & 7U);
    (void)Link_sendControl(link, LINK_KIND_RST, 0, 0, 0, now);
}

/* Takes all whole frames out of the input. After a bad one it goes on at the next byte; `isEnd`: a
 * silence follows, so half a frame will never become whole. */
void Link_parse(Link* link, int isEnd, U32 now) {
    int inSync = 1;
    while (link->inputCount) {
        U8 frame[LINK_MAX_FRAME];
        U32 payload = link->input[0] & 0x7FU;
        U32 i;
        if (payload <= LINK_MAX_PAYLOAD) {
            U32 size = payload + LINK_OVERHEAD;
            if (link->inputCount < size) {
                if (!isEnd)
                    return;
            } else {
                /* A callback may feed nothing, but it may send: work on a copy. */
                for (i = 0; i < size; ++i)
                    frame[i] = link->input[i];
                if (takeFrame(link, frame, payload, now)) {
                    ++link->statistics.framesReceived;
                    link->statistics.bytesReceived += size;
                    discard(link, size);
                    inSync = 1;
                    continue;
                }
            }
        }
        if (inSync) {
            ++link->statistics.crcErrors;
            if (link->state == LINK_STATE_IDLE && link->inputCount >= LINK_OVERHEAD)
                refuse(link, now);
        }
        inSync = 0;
        ++link->statistics.bytesSkipped;
        discard(link, 1);
    }
}

void Link_receive(Link* link, const U8* bytes, U32 size, int isPacketEnd, U32 nowUs) {
    U32 i;
    for (i = 0; i < size; ++i) {
        link->input[link->inputCount++] = bytes[i];
        link->inputAt = nowUs;
        if (link->inputCount == LINK_MAX_FRAME ||
            link->inputCount >= (link->input[0] & 0x7FU) + LINK_OVERHEAD)
            Link_parse(link, 0, nowUs);
    }
    if (isPacketEnd)
        Link_parse(link, 1, nowUs);
}
