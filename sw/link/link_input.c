/* SPDX-License-Identifier: MIT
 *
 * link_input: gives each good frame to its part of the layer.
 */
#include "link.h"

int link_isPlausible(const Link* link, const U8* frame) {
    const Link_Codec* codec = LINK_CODEC(link);
    U32 payload = LINK_LENGTH(frame) + LINK_OVERHEAD - codec->overhead;
    Link_Kind kind = LINK_KIND_OF(frame);
    if (kind == LINK_KIND_DATA)
        return payload != 0 || (frame[2] & LINK_LAST);
    if (kind > LINK_KIND_PING)
        return payload >= 2U;
    if (kind == LINK_KIND_ACK)
        return payload - 1U <= LINK_BITMAP;
    return payload == codec->sizes[kind];
}

static int onPiggyback(Link* link, const U8* frame) {
    const U8* payload = frame + LINK_HEADER;
    U32 flags = LINK_FIRST | LINK_LAST | LINK_CHANNEL(frame[2]);
    if (LINK_KIND_OF(frame) == LINK_KIND_PIGGYBACK_ASK)
        flags |= LINK_ACK_NOW;
    /* A peer sends no such frame while a message is held: the whole window is open. */
    link_onAck(link, payload[0], link->sender.fullCredit, 0, 0);
    return link_onData(link, frame[1], flags, payload + 1, LINK_LENGTH(frame) - 1U);
}

void link_accept(Link* link, const U8* frame, U32 size) {
    const U8* payload = frame + LINK_HEADER;
    U32 duplicates = link->statistics.duplicates;
    Link_Kind kind = LINK_KIND_OF(frame);
    int isFair = 1;
    link->parser.outOfStep = 0;
    link_hear(link, size);
    ++link->statistics.framesReceived;
    link->statistics.bytesReceived += size;
    if (LINK_IS_HANDSHAKE(kind)) {
        LINK_CODEC(link)->onHandshake(link, frame, kind);
        return;
    }
    link->handshake.isUnconfirmed = 0;
    if (!LINK_BEFORE(link->now, link->pingAt))
        link->pingAt = link->now; /* or it would in time be so old that it reads as a future time */
    if (kind == LINK_KIND_DATA) {
        isFair = link_onData(link, frame[1], frame[2], payload, LINK_LENGTH(frame));
    } else if (kind == LINK_KIND_ACK) {
        link_onAck(link, frame[1], payload[0], payload + 1, LINK_LENGTH(frame) - 1U);
    } else if (kind == LINK_KIND_BYE) {
        link_lose(link);
    } else if (kind == LINK_KIND_PING && LINK_CODEC(link)->onPing) {
        LINK_CODEC(link)->onPing(link, frame);
    } else if (kind == LINK_KIND_PING) {
        link->receiver.ackDue = link->receiver.ackNow = 1;
    } else {
        isFair = onPiggyback(link, frame);
    }
    /* What was heard before may be an attacker's recording, and is no sign of life; link_onAck and
     * the codec look themselves. */
    if (kind >= LINK_KIND_PIGGYBACK && duplicates == link->statistics.duplicates)
        link->heardAt = link->now;
    if (!isFair)
        link_abort(link);
}

/* The first byte behind a frame may be of an unknown session, whose peer gets an answer, but not
 * too often. */
void link_skip(Link* link, const U8* frame, U32 left) {
    if (!link->parser.outOfStep && left >= LINK_CODEC(link)->overhead &&
        link->state == LINK_STATE_IDLE && link->now - link->pingAt >= LINK_HELLO_FIRST) {
        link->pingAt = link->now;
        LINK_CODEC(link)->call(link, frame);
    }
    link->parser.outOfStep = 1;
    ++link->statistics.bytesSkipped;
}
