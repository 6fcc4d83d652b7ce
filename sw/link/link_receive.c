/* SPDX-License-Identifier: MIT
 *
 * link_receive: puts fragments in order, messages together, and acknowledges.
 */
#include "link.h"

#define SLOT(seq) ((seq)&63U)

void Link_resetReceive(Link* link) {
    U32 i;
    for (i = 0; i < 64U; ++i)
        link->slotUsed[i] = 0;
    link->receiveNext = 0;
    link->messageSize = 0;
    link->messageOpen = link->messageHeld = 0;
    link->open = 0;
    link->ackCount = 0;
    link->ackDue = link->ackNow = 0;
}

static void setOpen(Link* link, U8 channel, int isOpen) {
    U8 bit = (U8)(1U << channel);
    if (isOpen == ((link->open & bit) != 0))
        return;
    link->open = (U8)(isOpen ? link->open | bit : link->open & ~(U32)bit);
    link->port->channel(link->context, channel, isOpen);
}

/* One fragment in order. 0: its message is whole and nobody takes it now. */
static int accept(Link* link, U8 flags, const U8* data, U32 size) {
    U8 channel = flags & 3U;
    U32 i;
    if (size == 0) {
        setOpen(link, channel, (flags & LINK_FIRST) != 0);
        return 1;
    }
    if (flags & LINK_FIRST) {
        link->messageOpen = 1;
        link->messageSize = 0;
        link->messageChannel = channel;
    }
    /* A sender of ours breaks none of these; one that does loses its message, nothing else. */
    if (!link->messageOpen || channel != link->messageChannel ||
        link->messageSize + size > LINK_MAX_MESSAGE) {
        link->messageOpen = 0;
        return 1;
    }
    for (i = 0; i < size; ++i)
        link->message[link->messageSize++] = data[i];
    if (!(flags & LINK_LAST))
        return 1;
    link->messageOpen = 0;
    if (link->port->message(link->context, channel, link->message, link->messageSize) != 0) {
        link->messageHeld = 1;
        return 0;
    }
    ++link->statistics.messagesReceived;
    return 1;
}

/* Takes what is in order out of the slots, unless a message is held. */
static void drain(Link* link) {
    while (!link->messageHeld && link->slotUsed[SLOT(link->receiveNext)]) {
        U32 slot = SLOT(link->receiveNext);
        Link_State before = link->state;
        link->slotUsed[slot] = 0;
        ++link->receiveNext;
        (void)accept(link, link->slotFlags[slot], link->slots[slot], link->slotSize[slot]);
        if (link->state != before)
            return;
    }
}

void Link_deliverHeld(Link* link, U32 now) {
    if (!link->messageHeld || link->port->message(link->context, link->messageChannel,
                                                  link->message, link->messageSize) != 0)
        return;
    link->messageHeld = 0;
    ++link->statistics.messagesReceived;
    drain(link);
    link->ackDue = link->ackNow = 1; /* the credit has changed */
    link->ackAt = now;
}

void Link_onData(Link* link, const U8* frame, U32 payload, U32 now) {
    U8 seq = frame[1];
    U32 ahead = (U8)(seq - link->receiveNext);
    U32 slot = SLOT(seq);
    U32 i;
    if (!link->ackDue) {
        link->ackDue = 1;
        link->ackAt = now + LINK_ACK_DELAY;
    }
    if (ahead >= LINK_WINDOW || link->slotUsed[slot]) {
        ++link->statistics.duplicates; /* our acknowledgement was lost, or it is being resent */
        link->ackNow = 1;
        return;
    }
    link->slotUsed[slot] = 1;
    link->slotFlags[slot] = frame[2];
    link->slotSize[slot] = (U8)payload;
    for (i = 0; i < payload; ++i)
        link->slots[slot][i] = frame[3U + i];
    if (++link->ackCount >= LINK_ACK_EVERY || (frame[2] & LINK_ACK_NOW) || ahead != 0)
        link->ackNow = 1;
    drain(link);
}

/* 1: sent. */
int Link_sendAck(Link* link, U32 now) {
    U8 payload[5];
    U32 bitmap = 0;
    U32 used = 0;
    U32 i;
    for (i = 0; i < LINK_WINDOW; ++i)
        if (link->slotUsed[SLOT(link->receiveNext + i)]) {
            ++used;
            if (i > 0 && i <= 32U)
                bitmap |= 1U << (i - 1U);
        }
    /* A held message holds what has arrived behind it; the window never moves past it. */
    payload[0] = (U8)(link->messageHeld ? used : LINK_WINDOW);
    Link_put32(payload + 1, bitmap);
    if (!Link_sendControl(link, LINK_KIND_ACK, link->receiveNext, payload, bitmap ? 5U : 1U, now))
        return 0;
    ++link->statistics.acksSent;
    link->ackDue = link->ackNow = 0;
    link->ackCount = 0;
    return 1;
}

void Link_pollReceive(Link* link, U32 now) {
    if (link->inputCount && !Link_isBefore(now, link->inputAt + LINK_FRAME_GAP))
        Link_parse(link, 1, now);
    if (link->state != LINK_STATE_UP)
        return;
    Link_deliverHeld(link, now);
    if (link->ackDue && (link->ackNow || !Link_isBefore(now, link->ackAt)))
        (void)Link_sendAck(link, now);
}

U32 Link_receiveDeadline(const Link* link, U32 now) {
    U32 wait = 0xFFFFFFFFU;
    if (link->inputCount) {
        U32 at = link->inputAt + LINK_FRAME_GAP;
        wait = Link_isBefore(at, now) ? 0 : at - now;
    }
    if (link->state == LINK_STATE_UP && link->ackDue) {
        U32 ack = link->ackNow || Link_isBefore(link->ackAt, now) ? 0 : link->ackAt - now;
        if (ack < wait)
            wait = ack;
    }
    if (link->messageHeld && wait > 5000U)
        wait = 5000U;
    return wait;
}
