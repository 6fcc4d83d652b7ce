/* SPDX-License-Identifier: MIT
 *
 * link_pacing: paces packets, and counts.
 */
#include "link_pacing.h"

#include <string.h>

/* Least room in a packet for another fragment with an acknowledgement behind it, whose frame has 9
 * bytes of payload. */
#define LEAST(output) (output->codec->overhead + 10U)

/* Packets for which the modem counts as slow after the radio had no room for one. */
#define SLOW 64U

/* The time of a packet and a silence on the line. */
static U32 lineOf(const Link_Output* output, U32 size) {
    return (size + LINK_SILENCE) * output->byteTimeUs16 >> 4;
}

/* The time of a packet: on the line, or in the modem, whichever is longer. `full`: bytes of the
 * longest one. */
static U32 timeOf(U32 line, U32 size, U32 full) {
    U32 modem = size * LINK_BYTE_US +
                (full > LINK_MAX_ENCRYPTED ? LINK_PACKET_US : LINK_PACKET_ENCRYPTED_US);
    return line > modem ? line : modem;
}

U32 link_room(const Link_Output* output) {
    return (U32)output->longest - output->packed;
}

/* Hands the packet to a radio that answers. */
static int handOverAnswered(Link_Output* output) {
    Link_Pacer* pacer = output->pacer;
    if (pacer->waiting >= output->mostWaiting ||
        output->port->transmit(output->context, output->packet, output->packed) != 0)
        return 0;
    pacer->owners[(pacer->first + pacer->waiting++) % LINK_MOST_WAITING] = output;
    ++output->handed;
    ++output->waiting;
    output->packed = output->heard = 0;
    return 1;
}

/* Hands the packet, in which there is a frame, to the radio, filled up if another may follow while
 * the modem holds it: the modem joins two packets unless the first is full, and from then on all
 * begin inside a frame. */
static int handOver(Link_Output* output, int isFollowed) {
    U32 size = output->packed;
    U32 full = (U32)output->longest + output->codec->overhead;
    U32 line, time, slack;
    if (output->mostWaiting)
        return handOverAnswered(output);
    if (isFollowed && output->slow && (output->present.features & LINK_FEATURE_PIGGYBACK)) {
        memset(output->packet + size, (int)LINK_FILL, full - size);
        size = full;
    }
    if ((output->quietUntil - output->now - 1U) >> 21 == 0) /* more is long ago */
        return 0;
    if (output->port->transmit(output->context, output->packet, size) != 0) {
        output->slow = SLOW;
        return 0;
    }
    if (output->slow)
        --output->slow;
    output->statistics.bytesSent += size - output->packed;
    if (LINK_BEFORE(output->paceUntil, output->now))
        output->paceUntil = output->now;
    line = lineOf(output, size);
    time = slack = timeOf(line, size, full);
    output->paceUntil += time;
    if (size < full) {
        slack -= line > LINK_SHORT_MARGIN ? line : LINK_SHORT_MARGIN;
        output->quietUntil = output->now + line;
    }
    output->slack = slack;
    output->early = 0;
    if (output->heard && output->fastest > LINK_PACKET_US) { /* a wire needs no turns */
        U32 heard = output->heard;
        U32 wait = timeOf(lineOf(output, heard), heard, full) * LINK_HEARD_QUARTERS >> 2;
        output->early = (time + wait) / 2U;
        output->paceUntil += wait;
    }
    output->packed = output->heard = 0;
    return 1;
}

int link_flush(Link_Output* output) {
    return handOver(output, output->isStream);
}

void link_hear(Link_Output* output, U32 size) {
    output->heard = (U8)size;
    if (output->paceUntil - output->slack - output->now < output->early)
        output->paceUntil = output->now + output->slack;
}

int link_isOpen(Link_Output* output) {
    if (output->packed && output->packed + LEAST(output) > output->longest && !link_flush(output))
        return 0;
    if (output->mostWaiting && !output->packed && output->pacer->waiting >= output->mostWaiting)
        return 0;
    return output->packed || !LINK_BEFORE(output->now + output->slack, output->paceUntil);
}

int link_sendFrame(Link_Output* output, U8* frame, U32 header, U32 number) {
    U32 size = output->codec->seal(output, frame, header, number);
    if (size > link_room(output) + output->codec->overhead && !handOver(output, 1))
        return 0;
    memcpy(output->packet + output->packed, frame, size);
    output->packed = (U8)(output->packed + size);
    ++output->statistics.framesSent;
    output->statistics.bytesSent += size;
    return 1;
}

int link_sendControl(Link_Output* output, U8* frame, U32 byte2, U32 number, U32 size) {
    U32 header = LINK_HEADER_OF(LINK_CONTROL | size, (U8)number, byte2);
    if (!link_sendFrame(output, frame, header, number))
        return 0;
    (void)link_flush(output); /* or it leaves with the packet, as soon as the radio has room */
    return 1;
}
