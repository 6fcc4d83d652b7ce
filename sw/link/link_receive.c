/* SPDX-License-Identifier: MIT
 *
 * link_receive: puts fragments in order, messages together, and acknowledges.
 */
#include "link.h"

#include <string.h>

void Link_resetReceive(Link* link) {
    if (LINK_WINDOW > 1U)
        memset(link->slotUsed, 0, sizeof link->slotUsed);
    link->receiveNext = 0;
    link->messageOpen = link->messageHeld = 0;
    link->open = link->closing = link->closeDue = 0;
    link->ackCount = link->ackDue = link->ackNow = 0;
}

/* The peer opens or closes a channel. */
static void onChannel(Link* link, U32 channel, int isOpen) {
    U32 bit = 1U << channel;
    if (link->closing & bit) {
        if (!isOpen)
            link->closing = (U8)(link->closing & ~bit); /* the answer to our closing */
        return;
    }
    if (isOpen == (link->open >> channel & 1))
        return;
    link->open = (U8)(link->open ^ bit);
    if (!isOpen)
        link->closeDue = (U8)(link->closeDue | bit);
    link->port->channel(link->context, (int)channel, isOpen);
}

/* Offers a whole message to the program; one on a channel that was closed here is dropped. What
 * nobody takes is not acknowledged either: its last fragment counts as not yet here. */
static void deliver(Link* link) {
    link->messageHeld = 0;
    if (!(link->open >> link->messageChannel & 1))
        return;
    if (link->port->message(link->context, link->messageChannel, link->messageStart,
                            link->messageSize) != 0) {
        link->messageHeld = 1;
        --link->receiveNext;
    } else {
        LINK_COUNT(link, messagesReceived, 1U);
    }
}

/* A message ends with a check over the whole, unless it is short; it is taken off here. A fragment
 * that lost its end, and had the next one's beginning in its place, is right by its CRC once in
 * 65,536 times. */
static int isWhole(Link* link) {
    U8 sums[2];
    U32 size = link->messageSize - LINK_CHECK;
    if (link->messageSize <= LINK_UNCHECKED)
        return 1;
    sums[0] = sums[1] = 0;
    Link_sum(sums, link->messageStart, size);
    link->messageSize = (U16)size;
    return size <= LINK_MAX_MESSAGE + LINK_ESCAPE &&
           memcmp(sums, link->messageStart + size, LINK_CHECK) == 0;
}

/* One fragment in order. */
static void accept(Link* link, U32 flags, const U8* data, U32 size) {
    ++link->receiveNext;
    if (size == 0) {
        onChannel(link, flags & 3U, (flags & LINK_FIRST) != 0);
        return;
    }
    if (flags & LINK_FIRST) {
        link->messageOpen = 1;
        link->messageSize = 0;
        link->messageChannel = flags & 3U;
    }
    if (!link->messageOpen || (flags & 3U) != link->messageChannel ||
        size > LINK_MAX_MESSAGE + LINK_ESCAPE + LINK_CHECK - link->messageSize) {
        Link_abort(link);
        return;
    }
    memcpy(link->message + LINK_HEAD_ROOM + link->messageSize, data, size);
    link->messageSize = (U16)(link->messageSize + size);
    if (!(flags & LINK_LAST))
        return;
    link->messageOpen = 0;
    link->messageStart = link->message + LINK_HEAD_ROOM;
    if (!isWhole(link)) {
        Link_abort(link);
        return;
    }
    if (LINK_HEADS && (link->session.features & LINK_FEATURE_HEADS) && !Link_unpackHead(link)) {
        Link_abort(link);
        return;
    }
    deliver(link);
}

/* Takes what is in order out of the slots, unless a message is held or the session ends on the way.
 */
static void drain(Link* link) {
    U32 slot;
    for (;;) {
        slot = LINK_SLOT(link->receiveNext);
        if (link->messageHeld || !link->slotUsed[slot])
            return;
        link->slotUsed[slot] = 0;
        accept(link, link->slotFlags[slot], link->slots[slot], link->slotSize[slot]);
    }
}

void Link_onData(Link* link, U32 seq, U32 flags, const U8* data, U32 size) {
    U32 ahead = (U8)(seq - link->receiveNext);
    U32 slot = LINK_SLOT(seq);
    if (!link->ackDue) {
        link->ackDue = 1;
        link->ackAt = link->now + LINK_ACK_DELAY;
    }
    if (++link->ackCount >= LINK_ACK_EVERY || (flags & LINK_ACK_NOW) || ahead != 0)
        link->ackNow = 1;
    if (ahead == 0 && !link->messageHeld) {
        accept(link, flags, data, size); /* the usual case: straight into the message */
        if (LINK_WINDOW > 1U)
            drain(link);
    } else if (LINK_WINDOW > 1U && ahead != 0 && ahead < LINK_WINDOW && !link->slotUsed[slot]) {
        link->slotUsed[slot] = 1;
        link->slotFlags[slot] = (U8)flags;
        link->slotSize[slot] = (U8)size;
        memcpy(link->slots[slot], data, size);
    } else {
        LINK_COUNT(link, duplicates, 1U); /* our acknowledgement was lost, or it is being resent */
        link->ackNow = 1;
    }
}

/* Which of the fragments behind the next expected one have arrived; bit n: SEQ + 1 + n. */
static U32 gaps(const Link* link, U32* used) {
    U32 bitmap = 0;
    U32 i;
    for (i = 0; LINK_WINDOW > 1U && i < LINK_WINDOW; ++i)
        if (link->slotUsed[LINK_SLOT(link->receiveNext + i)]) {
            ++*used;
            if (i > 0 && i <= 32U)
                bitmap |= 1U << (i - 1U);
        }
    return bitmap;
}

/* Whether an acknowledgement is due, and needs no more than the cumulative SEQ. */
int Link_ackMayRide(const Link* link) {
    U32 used = 0;
    return link->ackDue && !link->messageHeld && (link->session.features & LINK_FEATURE_RIDE) &&
           gaps(link, &used) == 0;
}

void Link_ackIsSent(Link* link) {
    LINK_COUNT(link, acksSent, 1U);
    link->ackDue = link->ackNow = link->ackCount = 0;
}

void Link_pollReceive(Link* link) {
    if (!link->messageHeld)
        return;
    ++link->receiveNext;
    deliver(link);
    if (link->messageHeld)
        return;
    link->ackDue = link->ackNow = 1; /* the credit has changed */
    if (LINK_WINDOW > 1U)
        drain(link);
}

void Link_pollAck(Link* link) {
    U8 frame[LINK_OVERHEAD + 5U];
    U32 used = 0;
    U32 bitmap;
    if (!link->ackDue || (!link->ackNow && LINK_BEFORE(link->now, link->ackAt)))
        return;
    bitmap = gaps(link, &used);
    /* A message that nobody takes keeps the window where it is. */
    frame[3] = (U8)(link->messageHeld ? used + 1U : LINK_WINDOW);
    Link_put32(frame + 4, bitmap);
    if (Link_sendControl(link, frame, LINK_KIND_ACK, link->receiveNext, bitmap ? 5U : 1U))
        Link_ackIsSent(link);
}
