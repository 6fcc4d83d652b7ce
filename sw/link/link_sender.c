/* SPDX-License-Identifier: MIT
 *
 * link_sender: sends fragments, and sends lost fragments again.
 */
#include "link_sender.h"

#include <stddef.h>
#include <string.h>

/* Credit before the first acknowledgement of the peer, in fragments. */
#define LEAST_WINDOW 8U

/* Size of the longest acknowledgement, bytes. */
#define ACK_ROOM(sender) ((sender)->pacing->env.codec->overhead + 1U + LINK_BITMAP)

#define IN_FLIGHT(sender) ((sender)->next - (sender)->base)
#define FRAGMENT(sender, seq) (&(sender)->window[(seq) & (sender)->mask])

/* Adds an entry to the queue. Returns 0 if the queue has no room. */
static Link_Entry* enqueue(Link_Sender* sender, U32 flags, U32 size) {
    Link_Entry* entry = link_enqueue(&sender->queue, flags, size, sender->pacing->longest);
    if (entry)
        sender->hasWork = 1;
    return entry;
}

int link_queueChannel(Link_Sender* sender, U32 flags) {
    return enqueue(sender, flags, 0) != 0;
}

Link_Status link_queueMessage(Link_Sender* sender, int channel, const U8* data, U32 size, U32 tag) {
    Link_Env* env = &sender->pacing->env;
    Link_Queue* queue = &sender->queue;
    Link_Compressed packed;
    Link_Entry* entry;
    U8 check[LINK_CHECK];
    U32 total, checkSize;
    packed.prefix = packed.middle = packed.tailAt = packed.head = 0;
    if (sender->pacing->session->features & LINK_FEATURE_COMPRESSION)
        link_compress(&sender->heads, channel, data, size, &packed);
    total = packed.prefix + packed.middle + size - packed.tailAt;
    checkSize = total > LINK_UNCHECKED ? env->codec->check : 0U;
    entry = enqueue(sender, LINK_FIRST | (U32)channel, total + checkSize);
    if (!entry)
        return total + checkSize + LINK_RESERVE > queue->mask + 1U ? LINK_TOO_LONG : LINK_FULL;
    entry->tag = tag;
    if (packed.middle)
        entry->flags |= LINK_ENTRY_LEARNS;
    LINK_BEGIN_ENTRY(queue, checkSize != 0);
    link_put(queue, packed.bytes, packed.prefix);
    link_put(queue, data + LINK_HEAD_AT, packed.middle);
    link_put(queue, data + packed.tailAt, size - packed.tailAt);
    if (packed.head)
        link_cacheHeader(&sender->heads, channel, data, packed.head);
    env->statistics.headBytesSaved += size - total;
    check[0] = (U8)queue->sums;
    check[1] = (U8)(queue->sums >> 8);
    link_put(queue, check, checkSize);
    return LINK_OK;
}

/* Queues closings for which the queue had no room before. When the peer has acknowledged the
 * closing of a channel, the channel can be opened again. */
static void queueClosings(Link_Sender* sender) {
    Link_Channels* channels = &sender->receiver->channels;
    U32 channel;
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if ((channels->closeDue >> channel & 1) && link_queueChannel(sender, channel))
            LINK_NOTE_CLOSING(channels, channel);
}

/* Removes an entry from the queue. Reports the outcome of its message, and that the queue has room
 * again. */
static void endEntry(Link_Sender* sender, U32 index, Link_Outcome outcome) {
    Link_Env* env = &sender->pacing->env;
    Link_Queue* queue = &sender->queue;
    Link_Entry ended = queue->entries[index];
    link_dequeue(queue, index);
    if (ended.size) { /* the entry is a message, not an opening or closing */
        env->statistics.messagesSent += outcome == LINK_DELIVERED;
        if (env->port->outcome)
            env->port->outcome(env->context, (int)LINK_CHANNEL(ended.flags), ended.tag, outcome);
    }
    if (outcome == LINK_DELIVERED && link_wasFull(queue)) {
        queueClosings(sender);
        if (env->port->writable)
            env->port->writable(env->context);
    }
}

void link_resetSender(Link_Sender* sender, int isWiped) {
    while (sender->queue.count)
        endEntry(sender, sender->queue.first, LINK_UNKNOWN);
    link_rewind(&sender->queue, isWiped);
    memset(&sender->credit, 0, offsetof(Link_Sender, queue) - offsetof(Link_Sender, credit));
    sender->credit = sender->fullCredit = LEAST_WINDOW;
    sender->rto = LINK_RTO_FIRST;
    LINK_FORGET_ROUND_TRIPS(sender->pacing);
}

/* Cuts the next fragment from the queue and adds it to the window. With `onlyAhead`, only cuts a
 * message that overtakes others. Returns 0 if there is nothing to cut or the window has no room. */
static int cut(Link_Sender* sender, int onlyAhead) {
    Link_Fragment* f = FRAGMENT(sender, sender->next);
    const Link_Pacing* pacing = sender->pacing;
    U32 inFlight = IN_FLIGHT(sender);
    U32 room = link_room(pacing);
    /* If an acknowledgement is due, the fragment leaves room for it in the same packet. */
    U32 reduced = sender->receiver->ackNow ? room - ACK_ROOM(sender) : room;
    /* Without credit, one fragment in flight is allowed, because its acknowledgement brings new
     * credit. */
    if ((inFlight && inFlight >= sender->credit) ||
        !link_cut(&sender->queue, &f->chunk, room, onlyAhead ? 0 : reduced,
                  pacing->session->features & LINK_FEATURE_PIGGYBACK ? pacing->longest : 0U))
        return 0;
    if (sender->queue.isAhead)
        sender->ahead = sender->next;
    ++sender->next;
    f->state = LINK_TO_SEND;
    f->tries = 0;
    return 1;
}

/* Returns n: one of n transmissions requests an acknowledgement, which takes time on the air. n is
 * smaller if many messages are queued, because short messages fill the queue before the window is
 * full. If the radio reports no results, n is also smaller while losses block the window, or while
 * a message that has overtaken others is not acknowledged yet. */
static U32 askEvery(const Link_Sender* sender) {
    U32 ahead = sender->ahead;
    if (!sender->pacing->mostWaiting &&
        (sender->isLossy || (ahead - sender->base < IN_FLIGHT(sender) &&
                             FRAGMENT(sender, ahead)->state != LINK_ACKED)))
        return 5U;
    if (sender->queue.count >= LINK_SEND_MESSAGES / 2U)
        return LINK_SEND_MESSAGES / 2U;
    return sender->fullCredit / 4U * 3U;
}

/* Returns whether a fragment should request an immediate acknowledgement. This applies to one of
 * every n fragments (askEvery) and to the last fragment that the credit allows. If the radio
 * reports no results, it also applies to the last fragment of a retransmission. */
static int mustAsk(const Link_Sender* sender, U32 seq) {
    if (sender->unasked + 1U >= askEvery(sender) || seq - sender->base + 1U >= sender->credit)
        return 1;
    if (!FRAGMENT(sender, seq)->tries || sender->pacing->mostWaiting)
        return 0;
    while (++seq != sender->next)
        if (FRAGMENT(sender, seq)->state == LINK_TO_SEND)
            return 0;
    return 1;
}

/* Returns whether the peer may deliver a message of one fragment before earlier fragments have
 * arrived. The peer must have all earlier fragments of the channel, and must learn no header from
 * this fragment or from an earlier one in the window. */
static int isReady(const Link_Sender* sender, U32 seq, U32 flags) {
    const Link_Entry* entries = sender->queue.entries;
    const Link_Fragment* f = FRAGMENT(sender, seq);
    while (!(entries[f->chunk.entry].flags & LINK_ENTRY_LEARNS)) {
        if (seq-- == sender->base)
            return 1;
        f = FRAGMENT(sender, seq);
        if (f->state != LINK_ACKED && LINK_CHANNEL(f->chunk.flags) == LINK_CHANNEL(flags))
            break;
    }
    return 0;
}

/* Writes a fragment's payload into a frame. Returns the header of a data frame. If the fragment is
 * a complete short message and an acknowledgement is due, returns the header of a PIGGYBACK. */
static U32 build(const Link_Sender* sender, U32 seq, int isAsked, U8* frame) {
    const Link_Pacing* pacing = sender->pacing;
    const Link_Chunk* chunk = &FRAGMENT(sender, seq)->chunk;
    U8* p = frame + LINK_HEADER;
    U32 flags = chunk->flags;
    U32 size = chunk->size;
    int isWhole = (flags & LINK_FIRST) && (flags & LINK_LAST) && size;
    U32 header = LINK_HEADER_OF(size, (U8)seq, flags | (isAsked ? LINK_ACK_NOW : 0U));
    if (isWhole && size < link_room(pacing) && link_canPiggyback(sender->receiver)) {
        header = LINK_CONTROL_HEADER(isAsked ? LINK_KIND_PIGGYBACK_ASK : LINK_KIND_PIGGYBACK,
                                     (U8)seq, size + 1U) |
                 LINK_HEADER_OF(0U, 0U, LINK_CHANNEL(flags));
        *p++ = (U8)sender->receiver->expected;
    }
    if (isWhole && seq != sender->base && (pacing->session->features & LINK_FEATURE_PIGGYBACK) &&
        isReady(sender, seq, flags))
        header |= LINK_HEADER_OF(0U, 0U, LINK_READY);
    link_copy(&sender->queue, chunk, p);
    return header;
}

/* Sends a fragment. Returns 1 if the fragment is in a packet. */
static int transmit(Link_Sender* sender, U32 seq) {
    Link_Env* env = &sender->pacing->env;
    Link_Fragment* f = FRAGMENT(sender, seq);
    U8 frame[LINK_MAX_FRAME];
    U32 wait = sender->rto;
    int isAsked = mustAsk(sender, seq);
    U32 header = build(sender, seq, isAsked, frame);
    if (!link_sendFrame(sender->pacing, frame, header, seq,
                        header & LINK_CONTROL ? sender->receiver->expected : 0U))
        return 0;
    if (header & LINK_CONTROL)
        link_noteAckSent(sender->receiver);
    if (f->tries)
        ++env->statistics.fragmentsResent;
    else
        f->firstAt = env->now;
    if (f->tries < 2U)
        ++f->tries;
    f->order = ++sender->order;
    f->sentAt = env->now;
    f->state = LINK_SENT;
    f->packet = sender->pacing->handed;
    sender->unasked = (U8)(isAsked ? 0U : sender->unasked + 1U);
    if (IN_FLIGHT(sender) >= sender->fullCredit &&
        /* the window is full, so the sender needs an acknowledgement before it can continue */
        wait > sender->srtt)
        wait = sender->srtt < LINK_RTO_MIN ? LINK_RTO_MIN : sender->srtt;
    sender->timerAt = env->now + wait;
    return 1;
}

/* Adds a measured round trip to the estimate (RFC 6298). */
static void sample(Link_Sender* sender, U32 roundTrip) {
    if (!sender->hasSample) {
        sender->srtt = roundTrip;
        sender->rttvar = roundTrip / 2U;
        sender->hasSample = 1;
    } else {
        U32 error = roundTrip - sender->srtt;
        if (roundTrip < sender->srtt)
            error = 0U - error;
        sender->rttvar += error / 4U - sender->rttvar / 4U;
        sender->srtt += roundTrip / 8U - sender->srtt / 8U;
    }
    link_noteRoundTrip(sender->pacing, roundTrip);
    sender->pacing->env.statistics.roundTripUs = sender->srtt;
}

/* Restarts the retransmission timer after an acknowledgement. */
static void setTimer(Link_Sender* sender) {
    U32 rto = sender->hasSample ? sender->srtt + 2U * sender->rttvar : LINK_RTO_FIRST;
    if (rto < LINK_RTO_MIN)
        rto = LINK_RTO_MIN;
    if (rto > LINK_RTO_MAX)
        rto = LINK_RTO_MAX;
    sender->rto = rto;
    sender->timerAt = sender->pacing->env.now + rto;
}

/* Marks fragments as lost, so that they are sent again: all unacknowledged fragments that were last
 * transmitted before transmission number `order`. */
static void sendAgain(Link_Sender* sender, U32 order) {
    U32 seq;
    for (seq = sender->base; seq != sender->next; ++seq) {
        Link_Fragment* f = FRAGMENT(sender, seq);
        if (f->state == LINK_SENT && LINK_BEFORE(f->order, order)) {
            f->state = LINK_TO_SEND;
            sender->hasWork = 1;
        }
    }
}

/* Marks fragments as acknowledged: the first `advance` fragments, and the fragments in the bitmap.
 * Bit n of the bitmap is 1 if the fragment at advance + 1 + n has arrived. A fragment without
 * acknowledgement counts as lost if it was sent before the newest acknowledged fragment. */
static int markAcked(Link_Sender* sender, U32 advance, const U8* bitmap, U32 size) {
    const Link_Fragment* newest = 0;
    int isNew = 0;
    U32 i;
    for (i = 0; i < IN_FLIGHT(sender); ++i) {
        Link_Fragment* f = FRAGMENT(sender, sender->base + i);
        U32 elapsed = sender->pacing->env.now - f->sentAt;
        U32 bit = i - advance - 1U;
        U32 isHere = i < advance || (bit < 8U * size && (bitmap[bit / 8U] >> bit % 8U & 1));
        if (!isHere || f->state == LINK_ACKED || f->tries == 0)
            continue;
        f->state = LINK_ACKED;
        isNew = 1;
        if (f->tries != 1U && elapsed < sender->srtt - sender->srtt / 4U) {
            /* The time since the newest transmission is too short for a round trip, so the
             * acknowledgement belongs to an earlier transmission. If the radio reports losses, it
             * belongs to the first transmission, and the peer has become slower. */
            elapsed = sender->pacing->env.now - f->firstAt;
            if (sender->pacing->mostWaiting && !sender->pacing->backoff.own.isStream &&
                elapsed < LINK_RTO_FIRST)
                sample(sender, elapsed);
            continue;
        }
        if (!newest || LINK_BEFORE(newest->order, f->order))
            newest = f;
    }
    if (newest) {
        if (newest->tries == 1U && !sender->isLate)
            sample(sender, sender->pacing->env.now - newest->sentAt);
        sender->isLate = sender->unasked = 0;
        setTimer(sender);
        sendAgain(sender, newest->order);
    }
    return isNew;
}

int link_onAck(Link_Sender* sender, U32 cumulative, U32 credit, const U8* bitmap, U32 size) {
    U32 advance = (U8)(cumulative - sender->base);
    int isNew;
    if (advance > IN_FLIGHT(sender))
        return 0; /* this acknowledgement is old and arrived late */
    sender->credit = (U8)(credit <= sender->mask ? credit : sender->mask + 1U);
    if (sender->fullCredit < sender->credit)
        sender->fullCredit = sender->credit;
    sender->hasWork = 1;
    sender->isLossy = size != 0;
    isNew = markAcked(sender, advance, bitmap, size);
    while (advance--) {
        const Link_Fragment* f = FRAGMENT(sender, sender->base++);
        if (f->chunk.flags & LINK_LAST)
            endEntry(sender, f->chunk.entry, LINK_DELIVERED);
    }
    return isNew;
}

void link_onAnswer(Link_Sender* sender, U32 packet, int isDelivered) {
    U32 seq;
    if (isDelivered) {
        setTimer(sender);
        return;
    }
    for (seq = sender->base; seq != sender->next; ++seq) {
        Link_Fragment* f = FRAGMENT(sender, seq);
        if (f->state == LINK_SENT && f->packet == packet) {
            f->state = LINK_TO_SEND;
            sender->hasWork = 1;
        }
    }
    if (sender->receiver->packet == packet)
        link_scheduleAck(sender->receiver);
}

/* Finds the next fragment to send: a short message that overtakes others, else a lost fragment,
 * else a new one. Returns 0 if no such fragment exists. */
static int nextFragment(Link_Sender* sender, U32* seq) {
    int isRepeated = 0;
    for (*seq = sender->base; *seq != sender->next; ++*seq)
        if (FRAGMENT(sender, *seq)->state == LINK_TO_SEND) {
            isRepeated = FRAGMENT(sender, *seq)->tries != 0;
            if (!isRepeated)
                return 1;
            break;
        }
    if (LINK_IS_ALL_CUT(&sender->queue) || !cut(sender, isRepeated))
        return isRepeated;
    *seq = sender->next - 1U;
    return 1;
}

/* Sends the oldest fragment in flight again if the timer has expired. Returns 0 if this fragment
 * was first sent so long ago that the session must end. Otherwise the peer could execute a message
 * that its sender has abandoned. */
static int pollWindow(Link_Sender* sender, U32 now) {
    Link_Fragment* oldest = FRAGMENT(sender, sender->base);
    U32 age = oldest->tries ? now - oldest->firstAt : 0;
    if (age >= LINK_AGE_LAST)
        return 0;
    if (LINK_BEFORE(now, sender->timerAt) || sender->pacing->waiting)
        return 1;
    sender->timerAt = now + sender->rto;
    if (sender->pacing->mostWaiting && sender->pacing->packed)
        return 1; /* the packet with the oldest fragment was not sent yet */
    /* one fragment is enough, because its acknowledgement reports the other fragments as well */
    oldest->state = LINK_TO_SEND;
    sender->hasWork = sender->isLate = 1;
    sender->rto += sender->rto / 4U;
    if (sender->rto > LINK_RTO_MAX)
        sender->rto = LINK_RTO_MAX;
    /* retransmissions become frequent, because otherwise the session would soon end */
    if (age >= LINK_PING_AFTER)
        sender->rto = LINK_PING_EVERY;
    sender->timerAt = now + sender->rto;
    return 1;
}

int link_pollSender(Link_Sender* sender) {
    U32 seq;
    LINK_NOTE_IN_FLIGHT(sender->pacing, IN_FLIGHT(sender));
    if (sender->receiver->channels.closeDue)
        queueClosings(sender);
    if (IN_FLIGHT(sender) && !pollWindow(sender, sender->pacing->env.now))
        return 0;
    while (sender->hasWork) {
        if (LINK_IS_HELD(sender->pacing)) {
            if (LINK_IS_ALL_CUT(&sender->queue) || !cut(sender, 1))
                break;
            seq = sender->next - 1U;
        } else {
            if (!link_isOpen(sender->pacing))
                break;
            sender->hasWork = (U8)nextFragment(sender, &seq);
        }
        if (!sender->hasWork || !transmit(sender, seq))
            break;
        link_pollAck(sender->receiver);
    }
    return 1;
}
