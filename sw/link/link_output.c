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
    U32 modem =
        size * LINK_BYTE_US + (link->longest + LINK_CODEC(link)->overhead > LINK_MAX_ENCRYPTED
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

int link_sendFrame(Link* link, U8* frame, U32 header, U32 number) {
    U32 size = LINK_CODEC(link)->seal(link, frame, header, number);
    if (size > link_room(link) + LINK_CODEC(link)->overhead && !link_flush(link))
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
