/* SPDX-License-Identifier: MIT
 *
 * link_output: sends frames: checksum or tag, pacing, counts.
 */
#include "link.h"

#include <string.h>

/* Least room in a packet for another fragment with an acknowledgement behind it. */
#define LEAST 32U

/* The time of a packet: on the line, or in the modem, whichever is longer. */
static U32 timeOf(const Link* link, U32 size) {
    U32 line = (size + LINK_SILENCE) * link->byteTimeUs16 >> 4;
    U32 modem = size * LINK_BYTE_US + (link->longest + link->overhead > LINK_MAX_ENCRYPTED
                                           ? LINK_PACKET_US
                                           : LINK_PACKET_ENCRYPTED_US);
    return line > modem ? line : modem;
}

U32 link_room(const Link* link) {
    return (U32)link->longest - link->packed;
}

int link_flush(Link* link) {
    if (!link->packed)
        return 1;
    if (link->port->transmit(link->context, link->packet, link->packed) != 0)
        return 0;
    if (LINK_BEFORE(link->paceUntil, link->now))
        link->paceUntil = link->now;
    link->slack = timeOf(link, link->packed);
    link->paceUntil += link->slack;
    if (link->packed <= link->longest)
        link->slack -= LINK_SHORT_MARGIN;
    link->early = 0;
    if (link->heard && link->sender.fastest > LINK_PACKET_US) { /* a wire needs no turns */
        U32 wait = timeOf(link, link->heard) * LINK_HEARD_QUARTERS >> 2;
        link->early = (timeOf(link, link->packed) + wait) / 2U;
        link->paceUntil += wait;
    }
    link->packed = link->heard = 0;
    return 1;
}

void link_hear(Link* link, U32 size) {
    link->heard = (U8)size;
    if (link->paceUntil - link->slack - link->now < link->early)
        link->paceUntil = link->now + link->slack;
}

int link_isOpen(Link* link) {
    if (link->packed && link->packed + LEAST > link->longest && !link_flush(link))
        return 0;
    return link->packed || !LINK_BEFORE(link->now + link->slack, link->paceUntil);
}

/* Completes a frame under the session's key. Returns its size in bytes. */
static U32 protect(const Link* link, U8* frame, U32 header, U32 number) {
    const U8* key = link->session.keys.send;
    U32 acked = 0;
    if (header & LINK_CONTROL) {
        U32 kind = header >> 21 & 7U;
        if (kind == LINK_KIND_HELLO)
            key = link->secrets.hello[link->handshake.slot];
        if (kind == LINK_KIND_HELLO_ACK)
            key = link->handshake.candidate.keys.send;
        if (kind >= LINK_KIND_PIGGYBACK)
            acked = link->receiver.next;
    }
    return link_protect(frame, header | LINK_KEY_EPOCH(link->session.key) << 18, key, number,
                        acked);
}

int link_sendFrame(Link* link, U8* frame, U32 header, U32 number) {
    U32 key = link->session.key;
    U32 size;
    if (LINK_IS_SECURE(link)) {
        size = protect(link, frame, header, number);
    } else {
        if ((header & LINK_CONTROL) && LINK_IS_HANDSHAKE(header >> 21 & 7U))
            key |= LINK_NO_SEED;
        size = link_seal(frame, header, key);
    }
    if (size > link_room(link) + link->overhead && !link_flush(link))
        return 0;
    memcpy(link->packet + link->packed, frame, size);
    link->packed = (U8)(link->packed + size);
    ++link->statistics.framesSent;
    link->statistics.bytesSent += size;
    return 1;
}

int link_sendControl(Link* link, U8* frame, Link_Kind kind, U32 number, U32 size, U32 flags) {
    U32 header = LINK_CONTROL_HEADER(kind, (U8)number, size) | LINK_HEADER_OF(0U, 0U, flags);
    return link_sendFrame(link, frame, header, number) && link_flush(link);
}
