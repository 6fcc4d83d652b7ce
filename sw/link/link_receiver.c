/* SPDX-License-Identifier: MIT
 *
 * link_receiver: orders fragments, assembles messages, and acknowledges.
 */
#include "link_receiver.h"

#include <stddef.h>
#include <string.h>

#define SLOT(receiver, seq) (&(receiver)->slots[(seq) & (receiver)->mask])

void link_resetReceiver(Link_Receiver* receiver) {
    Link_Output* output = receiver->output;
    memset(&receiver->isAssembling, 0,
           offsetof(Link_Receiver, message) - offsetof(Link_Receiver, isAssembling));
    memset(receiver->slots, 0, (receiver->mask + 1U) * sizeof *receiver->slots);
    output->expected = 0;
    output->open = output->closing = output->closeDue = 0;
}

/* The peer opens or closes a channel. */
static void onChannel(Link_Output* output, U32 channel, int isOpen) {
    U32 bit = 1U << channel;
    if (output->closing & bit) {
        if (!isOpen)
            output->closing = (U8)(output->closing & ~bit); /* the answer to the own closing */
        return;
    }
    if (isOpen == (output->open >> channel & 1))
        return;
    output->open = (U8)(output->open ^ bit);
    if (!isOpen)
        output->closeDue = (U8)(output->closeDue | bit);
    output->port->channel(output->context, (int)channel, isOpen);
}

/* Offers a whole message to the program; one on a channel that was closed here is dropped. The last
 * fragment of a message that the program does not take counts as not received. */
static void deliver(Link_Receiver* receiver) {
    Link_Output* output = receiver->output;
    receiver->isHeld = 0;
    if (!(output->open >> receiver->channel & 1))
        return;
    if (output->port->message(output->context, receiver->channel, receiver->start,
                              receiver->size) != 0) {
        receiver->isHeld = 1;
        --output->expected;
    } else {
        ++output->statistics.messagesReceived;
    }
}

/* Adds a fragment to its message; a message of one fragment may stand between those of a long one.
 * Returns 0: the fragment does not belong there. */
static int append(Link_Receiver* receiver, U32 flags, const U8* data, U32 size) {
    U8* to = receiver->brief + LINK_HEAD_ROOM;
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
            size > receiver->longest - receiver->longSize)
            return 0;
        receiver->start = receiver->message + LINK_HEAD_ROOM;
        to = receiver->start + receiver->longSize;
        receiver->size = receiver->longSize = (U16)(receiver->longSize + size);
        receiver->isAssembling = !(flags & LINK_LAST);
    }
    memcpy(to, data, size);
    return 1;
}

/* Takes the check off the whole message. Returns 0: it is wrong. */
static int uncheck(Link_Receiver* receiver) {
    U32 size = receiver->size - LINK_CHECK;
    if (receiver->size <= LINK_UNCHECKED || !receiver->output->codec->check)
        return 1;
    receiver->size = (U16)size;
    return link_sum(0, receiver->start, size) == LINK_CHECK_AT(receiver->start + size);
}

/* Restores the head of the whole message. Returns 0: the message is malformed. */
static int expand(Link_Receiver* receiver) {
    U8* end = receiver->start + receiver->size;
    U8* start =
        link_decompress(&receiver->heads, receiver->channel, receiver->start, receiver->size);
    if (!start)
        return 0;
    receiver->start = start;
    receiver->size = (U16)(end - start);
    return 1;
}

/* Takes the next fragment in order. Returns 0: the peer broke the rules. */
static int accept(Link_Receiver* receiver, U32 flags, const U8* data, U32 size) {
    ++receiver->output->expected;
    if (size == 0) {
        onChannel(receiver->output, LINK_CHANNEL(flags), (flags & LINK_FIRST) != 0);
        return 1;
    }
    if (!append(receiver, flags, data, size))
        return 0;
    if (!(flags & LINK_LAST))
        return 1;
    if (!uncheck(receiver))
        return 0;
    if (receiver->output->present.features & LINK_FEATURE_COMPRESSION
            ? !expand(receiver)
            : receiver->size > LINK_MAX_MESSAGE)
        return 0;
    deliver(receiver);
    return 1;
}

/* Takes a whole message out of its slot before its turn: what is missing is of other channels. It
 * waits for its turn behind an earlier one of its channel that does so, or if the program does not
 * take it now. Returns 0: the peer broke the rules. */
static int takeEarly(Link_Receiver* receiver, U32 seq) {
    Link_Heads* heads = &receiver->heads;
    Link_Slot* slot = SLOT(receiver, seq);
    U32 channel = LINK_CHANNEL(slot->flags);
    U32 request = heads->lastRequest[channel];
    U32 reply = heads->lastReply[channel];
    U32 expected = receiver->output->expected;
    U32 at;
    for (at = expected; SLOT(receiver, at) != slot; ++at) {
        const Link_Slot* other = SLOT(receiver, at);
        if (other->flags && other->size != LINK_TAKEN && LINK_CHANNEL(other->flags) == channel)
            return 1;
    }
    --receiver->output->expected; /* what is acknowledged in order stays so */
    if (!accept(receiver, slot->flags, slot->bytes, slot->size))
        return 0;
    receiver->output->expected = expected;
    if (receiver->isHeld) {
        receiver->isHeld = 0;
        heads->lastRequest[channel] = request;
        heads->lastReply[channel] = reply;
    } else {
        slot->size = LINK_TAKEN;
    }
    return 1;
}

/* Takes fragments in order out of the slots, unless a message is held. Returns 0: the peer broke
 * the rules. */
static int drain(Link_Receiver* receiver) {
    for (;;) {
        Link_Slot* slot = SLOT(receiver, receiver->output->expected);
        U32 flags = slot->flags;
        if (receiver->isHeld || !flags)
            return 1;
        slot->flags = 0;
        --receiver->waiting;
        if (slot->size == LINK_TAKEN)
            ++receiver->output->expected;
        else if (!accept(receiver, flags, slot->bytes, slot->size))
            return 0;
    }
}

int link_onData(Link_Receiver* receiver, U32 seq, U32 flags, const U8* data, U32 size) {
    U32 ahead = (U8)(seq - receiver->output->expected);
    Link_Slot* slot = SLOT(receiver, seq);
    receiver->ackDue = 1;
    receiver->ackAt =
        receiver->output->now + (flags & LINK_LAST ? LINK_ACK_DELAY : LINK_ACK_WITHIN);
    if (flags & LINK_ACK_NOW)
        receiver->ackNow = 1;
    if (ahead == 0 && !receiver->isHeld) /* the usual case: straight into the message */
        return accept(receiver, flags, data, size) && drain(receiver);
    if (ahead != 0 && ahead <= receiver->mask && !slot->flags) {
        ++receiver->waiting;
        slot->flags = (U8)(flags | LINK_ACK_NOW);
        slot->size = (U8)size;
        memcpy(slot->bytes, data, size);
        if ((flags & LINK_FIRST) && (flags & LINK_LAST)) {
            receiver->ackNow = 1; /* a short message waits for a missing fragment */
            if ((flags & LINK_EARLY) && size && !receiver->isHeld)
                return takeEarly(receiver, seq);
        }
    } else {
        ++receiver->output->statistics
              .duplicates; /* the acknowledgement was lost, or it is being resent */
        receiver->ackNow = 1;
    }
    return 1;
}

/* Notes the arrived fragments behind the next expected one; bit n: SEQ + 1 + n. Returns the size in
 * bytes up to the last one. */
static U32 gaps(const Link_Receiver* receiver, U8* bitmap) {
    U32 size = 0;
    U32 i;
    memset(bitmap, 0, LINK_BITMAP);
    for (i = 0; i < receiver->mask; ++i)
        if (SLOT(receiver, receiver->output->expected + 1U + i)->flags) {
            size = i / 8U + 1U;
            bitmap[i / 8U] = (U8)(bitmap[i / 8U] | 1U << i % 8U);
        }
    return size;
}

void link_oweAck(Link_Receiver* receiver) {
    receiver->ackDue = receiver->ackNow = 1;
}

int link_ackMayRide(const Link_Receiver* receiver) {
    return receiver->ackDue && !receiver->isHeld && !receiver->waiting &&
           (receiver->output->present.features & LINK_FEATURE_PIGGYBACK);
}

void link_ackIsSent(Link_Receiver* receiver) {
    ++receiver->output->statistics.acksSent;
    receiver->ackDue = receiver->ackNow = 0;
    receiver->packet = receiver->output->handed;
}

int link_pollReceiver(Link_Receiver* receiver) {
    if (!receiver->isHeld)
        return 1;
    ++receiver->output->expected;
    deliver(receiver);
    if (receiver->isHeld)
        return 1;
    link_oweAck(receiver); /* the credit has changed */
    return drain(receiver);
}

void link_pollAck(Link_Receiver* receiver) {
    U8 frame[LINK_MAX_OVERHEAD + 1U + LINK_BITMAP];
    U8* payload = frame + LINK_HEADER;
    Link_Output* output;
    U32 size;
    if (!receiver->ackDue ||
        (!receiver->ackNow && LINK_BEFORE(receiver->output->now, receiver->ackAt)))
        return;
    output = receiver->output;
    size = gaps(receiver, payload + 1);
    /* A message that the program does not take stops the window. */
    payload[0] = (U8)((receiver->isHeld ? receiver->waiting : receiver->mask) + 1U);
    if (link_sendControl(output, frame, LINK_KIND_BITS(LINK_KIND_ACK), output->expected, size + 1U))
        link_ackIsSent(receiver);
}
