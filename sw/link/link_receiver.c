/* SPDX-License-Identifier: MIT
 *
 * link_receiver: orders fragments, assembles messages, and acknowledges them.
 */
#include "link_receiver.h"

#include <stddef.h>
#include <string.h>

#define SLOT(receiver, seq) (&(receiver)->slots[(seq) & (receiver)->mask])

void link_resetReceiver(Link_Receiver* receiver, int isWiped) {
    memset(&receiver->isAssembling, 0, sizeof *receiver - offsetof(Link_Receiver, isAssembling));
    memset(receiver->slots, 0, (receiver->mask + 1U) * sizeof *receiver->slots);
    if (isWiped)
        memset(receiver->message, 0, LINK_HEAD_ROOM + receiver->longest);
}

/* Processes an opening or closing of a channel by the peer. */
static void onChannel(Link_Receiver* receiver, U32 channel, U32 isOpen) {
    const Link_Env* env = &receiver->pacing->env;
    if (link_onPeersChannel(&receiver->channels, channel, isOpen))
        env->port->channel(env->context, (int)channel, (int)isOpen);
}

/* Offers a complete message to the program. Drops the message if this side has closed its channel.
 * If the program does not accept the message, the last fragment of the message counts as not
 * received. */
static void deliver(Link_Receiver* receiver) {
    Link_Env* env = &receiver->pacing->env;
    receiver->isHeld = 0;
    if (!LINK_IS_OPEN(&receiver->channels, receiver->channel))
        return;
    if (env->port->message(env->context, receiver->channel, receiver->start, receiver->size) != 0) {
        receiver->isHeld = 1;
        --receiver->expected;
    } else {
        ++env->statistics.messagesReceived;
    }
}

/* Adds a fragment to the message to which it belongs. A message of one fragment may arrive between
 * the fragments of a long message. Returns 0 if the fragment violates the protocol. */
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
            size > (U32)receiver->longest - receiver->longSize)
            return 0;
        receiver->start = receiver->message + LINK_HEAD_ROOM;
        to = receiver->start + receiver->longSize;
        receiver->size = receiver->longSize = (U16)(receiver->longSize + size);
        receiver->isAssembling = !(flags & LINK_LAST);
    }
    memcpy(to, data, size);
    return 1;
}

/* Removes the check from the complete message. Returns 0 if the check is wrong. */
static int uncheck(Link_Receiver* receiver) {
    U32 size = receiver->size - LINK_CHECK;
    if (receiver->size <= LINK_UNCHECKED || !receiver->pacing->env.codec->check)
        return 1;
    receiver->size = (U16)size;
    return link_sum(0, receiver->start, size) == LINK_CHECK_AT(receiver->start + size);
}

/* Restores the compressed header of the complete message. Returns 0 if the message is malformed. */
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

/* Processes the next fragment in order. Returns 0 if the peer violated the protocol. */
static int accept(Link_Receiver* receiver, U32 flags, const U8* data, U32 size) {
    ++receiver->expected;
    if (size == 0) {
        onChannel(receiver, LINK_CHANNEL(flags), (flags & LINK_FIRST) != 0);
        return 1;
    }
    if (!append(receiver, flags, data, size))
        return 0;
    if (!(flags & LINK_LAST))
        return 1;
    if (!uncheck(receiver))
        return 0;
    if (receiver->pacing->session->features & LINK_FEATURE_COMPRESSION
            ? !expand(receiver)
            : receiver->size > LINK_MAX_MESSAGE)
        return 0;
    deliver(receiver);
    return 1;
}

/* Delivers a complete message from its slot although earlier fragments are missing; the missing
 * fragments belong to other channels. The message stays in its slot if an earlier message of the
 * same channel waits, or if the program does not accept the message now. Returns 0 if the peer
 * violated the protocol. */
static int takeEarly(Link_Receiver* receiver, U32 seq) {
    Link_HeaderCache* heads = &receiver->heads;
    Link_ReorderSlot* slot = SLOT(receiver, seq);
    U32 channel = LINK_CHANNEL(slot->flags);
    U32 request = heads->lastRequest[channel];
    U32 reply = heads->lastReply[channel];
    U32 expected = receiver->expected;
    U32 at;
    for (at = expected; SLOT(receiver, at) != slot; ++at) {
        const Link_ReorderSlot* other = SLOT(receiver, at);
        if (other->flags && other->size != LINK_TAKEN && LINK_CHANNEL(other->flags) == channel)
            return 1;
    }
    /* compensates for the increment in accept, because the number of the expected fragment must not
     * change */
    --receiver->expected;
    if (!accept(receiver, slot->flags, slot->bytes, slot->size))
        return 0;
    receiver->expected = expected;
    if (receiver->isHeld) {
        receiver->isHeld = 0;
        heads->lastRequest[channel] = request;
        heads->lastReply[channel] = reply;
    } else {
        slot->size = LINK_TAKEN;
    }
    return 1;
}

/* Processes fragments from the slots that are now in order, unless a message waits for the
 * program. Returns 0 if the peer violated the protocol. */
static int drain(Link_Receiver* receiver) {
    for (;;) {
        Link_ReorderSlot* slot = SLOT(receiver, receiver->expected);
        U32 flags = slot->flags;
        if (receiver->isHeld || !flags)
            return 1;
        slot->flags = 0;
        --receiver->waiting;
        if (slot->size == LINK_TAKEN)
            ++receiver->expected;
        else if (!accept(receiver, flags, slot->bytes, slot->size))
            return 0;
    }
}

int link_onData(Link_Receiver* receiver, U32 seq, U32 flags, const U8* data, U32 size) {
    U32 ahead = (U8)(seq - receiver->expected);
    Link_ReorderSlot* slot = SLOT(receiver, seq);
    receiver->ackDue = 1;
    receiver->ackAt =
        receiver->pacing->env.now + (flags & LINK_LAST ? LINK_ACK_DELAY : LINK_ACK_WITHIN);
    if (flags & LINK_ACK_NOW)
        receiver->ackNow = 1;
    /* the usual case: the fragment is the expected one and is appended to its message without a
     * copy in a slot */
    if (ahead == 0 && !receiver->isHeld)
        return accept(receiver, flags, data, size) && drain(receiver);
    if (ahead != 0 && ahead <= receiver->mask && !slot->flags) {
        ++receiver->waiting;
        slot->flags = (U8)(flags | LINK_ACK_NOW);
        slot->size = (U8)size;
        memcpy(slot->bytes, data, size);
        if ((flags & LINK_FIRST) && (flags & LINK_LAST)) {
            /* acknowledges at once, because a short message waits for a missing fragment */
            receiver->ackNow = 1;
            if ((flags & LINK_EARLY) && size && !receiver->isHeld)
                return takeEarly(receiver, seq);
        }
    } else {
        ++receiver->pacing->env.statistics
              .duplicates; /* a duplicate: the earlier acknowledgement was lost or is late */
        receiver->ackNow = 1;
    }
    return 1;
}

/* Writes the bitmap of the fragments that arrived after a missing one: bit n stands for fragment
 * SEQ + 1 + n. Returns the size of the bitmap in bytes, up to its last set bit. */
static U32 gaps(const Link_Receiver* receiver, U8* bitmap) {
    U32 size = 0;
    U32 i;
    memset(bitmap, 0, LINK_BITMAP);
    for (i = 0; i < receiver->mask; ++i)
        if (SLOT(receiver, receiver->expected + 1U + i)->flags) {
            size = i / 8U + 1U;
            bitmap[i / 8U] = (U8)(bitmap[i / 8U] | 1U << i % 8U);
        }
    return size;
}

void link_scheduleAck(Link_Receiver* receiver) {
    receiver->ackDue = receiver->ackNow = 1;
}

int link_canPiggyback(const Link_Receiver* receiver) {
    return receiver->ackDue && !receiver->isHeld && !receiver->waiting &&
           (receiver->pacing->session->features & LINK_FEATURE_PIGGYBACK);
}

void link_noteAckSent(Link_Receiver* receiver) {
    ++receiver->pacing->env.statistics.acksSent;
    receiver->ackDue = receiver->ackNow = 0;
    receiver->packet = receiver->pacing->handed;
}

int link_pollReceiver(Link_Receiver* receiver) {
    if (!receiver->isHeld)
        return 1;
    ++receiver->expected;
    deliver(receiver);
    if (receiver->isHeld)
        return 1;
    link_scheduleAck(receiver); /* informs the peer of the new credit */
    return drain(receiver);
}

void link_pollAck(Link_Receiver* receiver) {
    U8 frame[LINK_MAX_OVERHEAD + 1U + LINK_BITMAP];
    U8* payload = frame + LINK_HEADER;
    U32 size;
    if (!receiver->ackDue ||
        (!receiver->ackNow && LINK_BEFORE(receiver->pacing->env.now, receiver->ackAt)))
        return;
    size = gaps(receiver, payload + 1);
    /* The credit: while a message waits for the program, the peer may send no further fragments. */
    payload[0] = (U8)((receiver->isHeld ? receiver->waiting : receiver->mask) + 1U);
    if (link_sendControl(receiver->pacing, frame, LINK_KIND_BITS(LINK_KIND_ACK), receiver->expected,
                         size + 1U))
        link_noteAckSent(receiver);
}
