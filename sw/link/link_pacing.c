/* SPDX-License-Identifier: MIT
 *
 * link_pacing: fills packets with frames, and decides when each packet is sent.
 */
#include "link_pacing.h"

#include <string.h>

/* Free space in a packet below which the packet does not wait for another fragment, bytes. An
 * acknowledgement with a payload of 9 bytes fits into this space. */
#define LEAST(pacing) (pacing->env.codec->overhead + 10U)

/* After the radio had no room, the modem is assumed to be slow for this number of packets. */
#define SLOW 64U

void link_initPacing(Link_Pacing* pacing, const Link_Identity* session, struct Link* owner,
                     U32 byteTimeUs16) {
    pacing->session = session;
    pacing->owner = owner;
    pacing->byteTimeUs16 = byteTimeUs16;
    pacing->radio = &pacing->own;
    link_limitPacket(pacing, LINK_MAX_FRAME);
}

void link_limitUnanswered(Link_Pacing* pacing, U32 packets) {
    pacing->mostWaiting = (U8)packets;
    pacing->radio->waiting = (U8)(pacing->radio->waiting - pacing->waiting);
    pacing->waiting = 0;
}

void link_limitPacket(Link_Pacing* pacing, U32 bytes) {
    pacing->longest = (U8)(bytes - pacing->env.codec->overhead);
}

void link_noteRoundTrip(Link_Pacing* pacing, U32 us) {
    if (us < pacing->fastest)
        pacing->fastest = us;
}

/* Returns the time that a packet takes on the line, including the silence after it, us. */
static U32 lineOf(const Link_Pacing* pacing, U32 size) {
    return (size + LINK_SILENCE) * pacing->byteTimeUs16 >> 4;
}

/* Returns the time that a packet takes on the line or in the modem, whichever is longer, us. `full`
 * is the size of the largest packet. */
static U32 timeOf(U32 line, U32 size, U32 full) {
    U32 modem = size * LINK_BYTE_US +
                (full > LINK_MAX_ENCRYPTED ? LINK_PACKET_US : LINK_PACKET_ENCRYPTED_US);
    return line > modem ? line : modem;
}

U32 link_room(const Link_Pacing* pacing) {
    return (U32)pacing->longest - pacing->packed;
}

/* Passes the packet to a radio that reports results. */
static int handOverAnswered(Link_Pacing* pacing) {
    Link_Unanswered* radio = pacing->radio;
    if (radio->waiting >= pacing->mostWaiting ||
        pacing->env.port->transmit(pacing->env.context, pacing->packet, pacing->packed) != 0)
        return 0;
    radio->owners[(radio->first + radio->waiting++) % LINK_MOST_WAITING] = pacing->owner;
    LINK_NOTE_PACKET(&pacing->backoff, pacing->env.now);
    ++pacing->handed;
    ++pacing->waiting;
    pacing->packed = pacing->heard = 0;
    return 1;
}

/* Passes the packet, which contains at least one frame, to the radio. With `isFollowed`, another
 * packet may follow while a slow modem still holds this one; this packet is then padded to the full
 * size. Otherwise the modem would join both packets, and all later packets would begin in the
 * middle of a frame. */
static int handOver(Link_Pacing* pacing, int isFollowed) {
    U32 size = pacing->packed;
    U32 full = (U32)pacing->longest + pacing->env.codec->overhead;
    U32 line, time, slack;
    if (pacing->mostWaiting)
        return handOverAnswered(pacing);
    if (isFollowed && pacing->slow && (pacing->session->features & LINK_FEATURE_PIGGYBACK)) {
        memset(pacing->packet + size, (int)LINK_FILL, full - size);
        size = full;
    }
    if ((pacing->quietUntil - pacing->env.now - 1U) >> 21 ==
        0) /* with a larger difference, quietUntil is in the past */
        return 0;
    if (pacing->env.port->transmit(pacing->env.context, pacing->packet, size) != 0) {
        pacing->slow = SLOW;
        return 0;
    }
    if (pacing->slow)
        --pacing->slow;
    pacing->env.statistics.bytesSent += size - pacing->packed;
    if (LINK_BEFORE(pacing->paceUntil, pacing->env.now))
        pacing->paceUntil = pacing->env.now;
    line = lineOf(pacing, size);
    time = slack = timeOf(line, size, full);
    pacing->paceUntil += time;
    if (size < full) {
        slack -= line > LINK_SHORT_MARGIN ? line : LINK_SHORT_MARGIN;
        pacing->quietUntil = pacing->env.now + line;
    }
    pacing->slack = slack;
    pacing->early = 0;
    /* on a radio channel, only one side can send at a time; on a cable, both can */
    if (pacing->heard && pacing->fastest > LINK_PACKET_US) {
        U32 heard = pacing->heard;
        U32 wait = timeOf(lineOf(pacing, heard), heard, full) * LINK_HEARD_QUARTERS >> 2;
        pacing->early = (time + wait) / 2U;
        pacing->paceUntil += wait;
    }
    pacing->packed = pacing->heard = 0;
    return 1;
}

int link_flush(Link_Pacing* pacing) {
    return handOver(pacing, pacing->isStream);
}

void link_hear(Link_Pacing* pacing, U32 size) {
    pacing->heard = (U8)size;
    if (pacing->paceUntil - pacing->slack - pacing->env.now < pacing->early)
        pacing->paceUntil = pacing->env.now + pacing->slack;
}

struct Link* link_takeAnswered(Link_Pacing* pacing) {
    Link_Unanswered* radio = pacing->radio;
    struct Link* owner = radio->owners[radio->first];
    if (!radio->waiting)
        return 0;
    --radio->waiting;
    radio->first = (U8)((radio->first + 1U) % LINK_MOST_WAITING);
    return owner;
}

U32 link_paceByAnswer(Link_Pacing* pacing, int isDelivered, U32 silence) {
    Link_Env* env = &pacing->env;
    U32 packet = (U8)(pacing->handed - pacing->waiting--);
    U32 rest =
        link_noteAnswer(&pacing->backoff, env->now, isDelivered, silence, pacing->waiting != 0);
    pacing->paceUntil = env->now;
    /* While the peer calls, a reply must wait for at most one packet of a stream. The next packet
     * of the stream is therefore passed to the radio only shortly before the radio needs it. This
     * is not possible on a slow line, for which more than two packets may wait. */
    pacing->isHeld = 0;
    if (pacing->waiting && pacing->mostWaiting == 2U && LINK_IS_CALLED(&pacing->backoff)) {
        pacing->isHeld = 1;
        pacing->paceUntil += pacing->backoff.usualUs - LINK_HAND_OVER_US;
    }
    if (rest) {
        pacing->paceUntil += env->port->random(env->context) % rest;
        pacing->early = 0xFFFFFFFFU; /* a frame from the peer ends the pause at once */
    }
    return packet;
}

int link_isOpen(Link_Pacing* pacing) {
    if (pacing->packed && pacing->packed + LEAST(pacing) > pacing->longest && !link_flush(pacing))
        return 0;
    if (pacing->mostWaiting && !pacing->packed && pacing->radio->waiting >= pacing->mostWaiting)
        return 0;
    return pacing->packed || !LINK_BEFORE(pacing->env.now + pacing->slack, pacing->paceUntil);
}

/* Seals a frame with its payload in place, and adds the frame to the packet. Returns 1 if the frame
 * was added.
 */
static int sendSealed(Link_Pacing* pacing, U8* frame, U32 header, const Link_Seal* seal) {
    Link_Env* env = &pacing->env;
    U32 size = env->codec->seal(frame, header, seal);
    if (size > link_room(pacing) + env->codec->overhead && !handOver(pacing, 1))
        return 0;
    memcpy(pacing->packet + pacing->packed, frame, size);
    pacing->packed = (U8)(pacing->packed + size);
    ++env->statistics.framesSent;
    env->statistics.bytesSent += size;
    return 1;
}

int link_sendNow(Link_Pacing* pacing, U8* frame, U32 header, const Link_Seal* seal) {
    if (!sendSealed(pacing, frame, header, seal))
        return 0;
    /* if the radio has no room now, the packet with the frame is sent later */
    (void)link_flush(pacing);
    return 1;
}

/* Makes the seal for the session's frames. */
static void makeSeal(const Link_Pacing* pacing, Link_Seal* seal, U32 number, U32 acked) {
    seal->key = LINK_OWN_KEY(pacing->session, keys);
    seal->session = pacing->session->key;
    seal->number = number;
    seal->acked = acked;
}

int link_sendFrame(Link_Pacing* pacing, U8* frame, U32 header, U32 number, U32 acked) {
    Link_Seal seal;
    makeSeal(pacing, &seal, number, acked);
    return sendSealed(pacing, frame, header, &seal);
}

int link_sendControl(Link_Pacing* pacing, U8* frame, U32 byte2, U32 number, U32 size) {
    Link_Seal seal;
    makeSeal(pacing, &seal, number, 0);
    return link_sendNow(pacing, frame, LINK_HEADER_OF(LINK_CONTROL | size, (U8)number, byte2),
                        &seal);
}
