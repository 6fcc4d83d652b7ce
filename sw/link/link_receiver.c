/* SPDX-License-Identifier: MIT
 *
 * link_receiver: orders fragments, assembles messages, and acknowledges.
 */
#include "link.h"

#include <string.h>

void link_resetReceiver(Link* link) {
    Link_Receiver* receiver = &link->receiver;
    memset(link->slots, 0, sizeof link->slots);
    receiver->next = 0;
    receiver->isAssembling = receiver->isHeld = receiver->waiting = 0;
    receiver->ackDue = receiver->ackNow = 0;
    link->open = link->closing = link->closeDue = 0;
}

/* The peer opens or closes a channel. */
static void onChannel(Link* link, U32 channel, int isOpen) {
    U32 bit = 1U << channel;
    if (link->closing & bit) {
        if (!isOpen)
            link->closing = (U8)(link->closing & ~bit); /* the answer to the own closing */
        return;
    }
    if (isOpen == (link->open >> channel & 1))
        return;
    link->open = (U8)(link->open ^ bit);
    if (!isOpen)
        link->closeDue = (U8)(link->closeDue | bit);
    link->port->channel(link->context, (int)channel, isOpen);
}

/* Offers a whole message to the program; one on a channel that was closed here is dropped. The last
 * fragment of a message that the program does not take counts as not received. */
static void deliver(Link* link) {
    Link_Receiver* receiver = &link->receiver;
    receiver->isHeld = 0;
    if (!(link->open >> receiver->channel & 1))
        return;
    if (link->port->message(link->context, receiver->channel, receiver->start, receiver->size) !=
        0) {
        receiver->isHeld = 1;
        --receiver->next;
    } else {
        ++link->statistics.messagesReceived;
    }
}

/* Adds a fragment to its message; a message of one fragment may stand between those of a long one.
 * Returns 0: the fragment does not belong there. */
static int append(Link* link, U32 flags, const U8* data, U32 size) {
    Link_Receiver* receiver = &link->receiver;
    U8* to = link->brief + LINK_HEAD_ROOM;
    receiver->start = to;
    receiver->size = (U16)size;
    receiver->channel = (U8)LINK_CHANNEL(flags);
    if (!(flags & LINK_FIRST) || !(flags & LINK_LAST)) {
        if (receiver->isAssembling == ((flags & LINK_FIRST) != 0))
            return 0;
        if (flags & LINK_FIRST) {
            receiver->longSize = 0;
            receiver->longChannel = receiver->channel;
        }
        if (receiver->channel != receiver->longChannel ||
            size > LINK_MAX_MESSAGE + LINK_ESCAPE + LINK_CHECK - receiver->longSize)
            return 0;
        receiver->start = link->message + LINK_HEAD_ROOM;
        to = receiver->start + receiver->longSize;
        receiver->size = receiver->longSize = (U16)(receiver->longSize + size);
        receiver->isAssembling = !(flags & LINK_LAST);
    }
    memcpy(to, data, size);
    return 1;
}

/* Takes the check off the whole message. Returns 0: it is wrong. */
static int uncheck(Link* link) {
    Link_Receiver* receiver = &link->receiver;
    U32 size = receiver->size - LINK_CHECK;
    if (receiver->size <= LINK_UNCHECKED || !LINK_CODEC(link)->check)
        return 1;
    receiver->size = (U16)size;
    return link_sum(0, receiver->start, size) == LINK_CHECK_AT(receiver->start + size);
}

/* Restores the head of the whole message. Returns 0: the message is malformed. */
static int expand(Link* link) {
    Link_Receiver* receiver = &link->receiver;
    U8* end = receiver->start + receiver->size;
    U8* start =
        link_decompress(&link->heads[0], receiver->channel, receiver->start, receiver->size);
    if (!start)
        return 0;
    receiver->start = start;
    receiver->size = (U16)(end - start);
    return 1;
}

/* Takes the next fragment in order. Returns 0: the peer broke the rules. */
static int accept(Link* link, U32 flags, const U8* data, U32 size) {
    Link_Receiver* receiver = &link->receiver;
    ++receiver->next;
    if (size == 0) {
        onChannel(link, LINK_CHANNEL(flags), (flags & LINK_FIRST) != 0);
        return 1;
    }
    if (!append(link, flags, data, size))
        return 0;
    if (!(flags & LINK_LAST))
        return 1;
    if (!uncheck(link))
        return 0;
    if (link->session.features & LINK_FEATURE_COMPRESSION ? !expand(link)
                                                          : receiver->size > LINK_MAX_MESSAGE)
        return 0;
    deliver(link);
    return 1;
}

/* Takes fragments in order out of the slots, unless a message is held. Returns 0: the peer broke
 * the rules. */
static int drain(Link* link) {
    Link_Receiver* receiver = &link->receiver;
    for (;;) {
        Link_Slot* slot = &link->slots[LINK_SLOT(receiver->next)];
        if (receiver->isHeld || !slot->isUsed)
            return 1;
        slot->isUsed = 0;
        --receiver->waiting;
        if (!accept(link, slot->flags, slot->bytes, slot->size))
            return 0;
    }
}

int link_onData(Link* link, U32 seq, U32 flags, const U8* data, U32 size) {
    Link_Receiver* receiver = &link->receiver;
    U32 ahead = (U8)(seq - receiver->next);
    Link_Slot* slot = &link->slots[LINK_SLOT(seq)];
    receiver->ackDue = 1;
    receiver->ackAt = link->now + (flags & LINK_LAST ? LINK_ACK_DELAY : LINK_ACK_WITHIN);
    if (flags & LINK_ACK_NOW)
        receiver->ackNow = 1;
    if (ahead == 0 && !receiver->isHeld) /* the usual case: straight into the message */
        return accept(link, flags, data, size) && drain(link);
    if (ahead != 0 && ahead < LINK_WINDOW && !slot->isUsed) {
        slot->isUsed = 1;
        ++receiver->waiting;
        slot->flags = (U8)flags;
        slot->size = (U8)size;
        memcpy(slot->bytes, data, size);
        if ((flags & LINK_FIRST) && (flags & LINK_LAST))
            receiver->ackNow = 1; /* a short message waits for a missing fragment */
    } else {
        ++link->statistics.duplicates; /* the acknowledgement was lost, or it is being resent */
        receiver->ackNow = 1;
    }
    return 1;
}

/* Notes the arrived fragments behind the next expected one; bit n: SEQ + 1 + n. Returns the size in
 * bytes up to the last one. */
static U32 gaps(const Link* link, U8* bitmap) {
    U32 size = 0;
    U32 i;
    memset(bitmap, 0, LINK_BITMAP);
    for (i = 0; i < LINK_WINDOW - 1U; ++i)
        if (link->slots[LINK_SLOT(link->receiver.next + 1U + i)].isUsed) {
            size = i / 8U + 1U;
            bitmap[i / 8U] = (U8)(bitmap[i / 8U] | 1U << i % 8U);
        }
    return size;
}

int link_ackMayRide(const Link* link) {
    const Link_Receiver* receiver = &link->receiver;
    return receiver->ackDue && !receiver->isHeld && !receiver->waiting &&
           (link->session.features & LINK_FEATURE_PIGGYBACK);
}

void link_ackIsSent(Link* link) {
    ++link->statistics.acksSent;
    link->receiver.ackDue = link->receiver.ackNow = 0;
}

int link_pollReceiver(Link* link) {
    Link_Receiver* receiver = &link->receiver;
    if (!receiver->isHeld)
        return 1;
    ++receiver->next;
    deliver(link);
    if (receiver->isHeld)
        return 1;
    receiver->ackDue = receiver->ackNow = 1; /* the credit has changed */
    return drain(link);
}

void link_pollAck(Link* link) {
    const Link_Receiver* receiver = &link->receiver;
    U8 frame[LINK_MAX_OVERHEAD + 1U + LINK_BITMAP];
    U8* payload = frame + LINK_HEADER;
    U32 size;
    if (!receiver->ackDue || (!receiver->ackNow && LINK_BEFORE(link->now, receiver->ackAt)))
        return;
    size = gaps(link, payload + 1);
    /* A message that the program does not take stops the window. */
    payload[0] = (U8)(receiver->isHeld ? receiver->waiting + 1U : LINK_WINDOW);
    if (link_sendControl(link, frame, LINK_KIND_ACK, receiver->next, size + 1U, 0))
        link_ackIsSent(link);
}
