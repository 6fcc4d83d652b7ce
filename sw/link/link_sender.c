/* SPDX-License-Identifier: MIT
 *
 * link_sender: cuts messages into fragments, keeps a window of them in flight, and repeats lost
 * ones.
 */
#include "link_sender.h"

#include <stddef.h>
#include <string.h>

/* The peer's credit in fragments, until its first frame gives it. */
#define LEAST_WINDOW 8U

/* Bytes of the longest acknowledgement. */
#define ACK_ROOM(output) (output->codec->overhead + 1U + LINK_BITMAP)

/* Fragments in flight that make a stream. */
#define STREAM 3U

#define IN_FLIGHT(sender) ((sender)->next - (sender)->base)
#define FRAGMENT(sender, seq) (&(sender)->window[(seq) & (sender)->mask])

Link_Entry* link_offer(Link_Sender* sender, U32 flags, U32 size) {
    Link_Entry* entry = link_enqueue(&sender->queue, flags, size, sender->output->longest);
    if (entry)
        sender->hasWork = 1;
    return entry;
}

/* Queues the closings that had no room yet. The peer waits for each before the channel can be
 * opened again. */
static void queueClosings(Link_Sender* sender) {
    Link_Output* output = sender->output;
    int channel;
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if ((output->closeDue >> channel & 1) && link_offer(sender, (U32)channel, 0))
            output->closeDue = (U8)(output->closeDue ^ 1U << channel);
}

/* Ends an entry of the queue, reports a message's outcome, and tells that there is room again. */
static void endEntry(Link_Sender* sender, U32 index, Link_Outcome outcome) {
    const Link_Output* output = sender->output;
    Link_Queue* queue = &sender->queue;
    Link_Entry ended = queue->entries[index];
    link_dequeue(queue, index);
    if (ended.size) { /* a message, not an opening or closing */
        sender->output->statistics.messagesSent += outcome == LINK_DELIVERED;
        if (output->port->outcome)
            output->port->outcome(output->context, (int)LINK_CHANNEL(ended.flags), ended.tag,
                                  outcome);
    }
    if (queue->wasFull && outcome == LINK_DELIVERED) {
        queue->wasFull = 0;
        queueClosings(sender);
        if (output->port->writable)
            output->port->writable(output->context);
    }
}

void link_resetSender(Link_Sender* sender) {
    while (sender->queue.count)
        endEntry(sender, sender->queue.first, LINK_UNKNOWN);
    link_rewind(&sender->queue);
    memset(&sender->credit, 0, offsetof(Link_Sender, queue) - offsetof(Link_Sender, credit));
    sender->credit = sender->fullCredit = LEAST_WINDOW;
    sender->output->fastest = sender->rto = LINK_RTO_FIRST;
}

/* Cuts the next fragment from the queue into the window, or only one that overtakes. Returns 0:
 * nothing to cut, or no room. */
static int cut(Link_Sender* sender, int onlyAhead) {
    Link_Fragment* f = FRAGMENT(sender, sender->next);
    const Link_Output* output = sender->output;
    U32 inFlight = IN_FLIGHT(sender);
    U32 room = link_room(output);
    /* An acknowledgement that is due leaves in the same packet. */
    U32 reduced = sender->receiver->ackNow ? room - ACK_ROOM(output) : room;
    /* One fragment goes out even without credit: its acknowledgement brings news of credit. */
    if ((inFlight && inFlight >= sender->credit) ||
        !link_cut(&sender->queue, &f->piece, room, onlyAhead ? 0 : reduced,
                  output->present.features & LINK_FEATURE_PIGGYBACK ? output->longest : 0U))
        return 0;
    if (sender->queue.isAhead)
        sender->ahead = sender->next;
    ++sender->next;
    f->state = LINK_TO_SEND;
    f->tries = 0;
    return 1;
}

/* Returns n: one of n transmissions asks for an acknowledgement, which costs a turn of the air:
 * more often where losses stop the window, while somebody waits for a message that has overtaken,
 * or where short messages fill the queue before the window. */
static U32 askEvery(const Link_Sender* sender) {
    U32 ahead = sender->ahead;
    if (!sender->output->mostWaiting &&
        (sender->isLossy || (ahead - sender->base < IN_FLIGHT(sender) &&
                             FRAGMENT(sender, ahead)->state != LINK_ACKED)))
        return 5U;
    if (sender->queue.count >= LINK_SEND_MESSAGES / 2U)
        return LINK_SEND_MESSAGES / 2U;
    return sender->fullCredit / 4U * 3U;
}

/* True if the peer should answer a fragment at once: one of every n, the last one within its
 * credit, and the last one that is sent again. */
static int mustAsk(const Link_Sender* sender, U32 seq) {
    if (sender->unasked + 1U >= askEvery(sender) || seq - sender->base + 1U >= sender->credit)
        return 1;
    if (!FRAGMENT(sender, seq)->tries || sender->output->mostWaiting)
        return 0;
    while (++seq != sender->next)
        if (FRAGMENT(sender, seq)->state == LINK_TO_SEND)
            return 0;
    return 1;
}

/* True if the peer may take a message of one fragment although earlier ones are missing: it has all
 * of its channel, and learns no head from what is not in order yet. */
static int isReady(const Link_Sender* sender, U32 seq, U32 flags) {
    const Link_Entry* entries = sender->queue.entries;
    const Link_Fragment* f = FRAGMENT(sender, seq);
    while (!(entries[f->piece.entry].flags & LINK_ENTRY_LEARNS)) {
        if (seq-- == sender->base)
            return 1;
        f = FRAGMENT(sender, seq);
        if (f->state != LINK_ACKED && LINK_CHANNEL(f->piece.flags) == LINK_CHANNEL(flags))
            break;
    }
    return 0;
}

/* Puts a fragment's payload into a frame. Returns the header: of data, or, for a whole short
 * message, of a control frame that takes an acknowledgement along. */
static U32 build(const Link_Sender* sender, U32 seq, int isAsked, U8* frame) {
    const Link_Output* output = sender->output;
    const Link_Piece* piece = &FRAGMENT(sender, seq)->piece;
    U8* p = frame + LINK_HEADER;
    U32 flags = piece->flags;
    U32 size = piece->size;
    int isWhole = (flags & LINK_FIRST) && (flags & LINK_LAST) && size;
    U32 header = LINK_HEADER_OF(size, (U8)seq, flags | (isAsked ? LINK_ACK_NOW : 0U));
    if (isWhole && size < link_room(output) && link_ackMayRide(sender->receiver)) {
        header = LINK_CONTROL_HEADER(isAsked ? LINK_KIND_PIGGYBACK_ASK : LINK_KIND_PIGGYBACK,
                                     (U8)seq, size + 1U) |
                 LINK_HEADER_OF(0U, 0U, LINK_CHANNEL(flags));
        *p++ = (U8)output->expected;
    }
    if (isWhole && seq != sender->base && (output->present.features & LINK_FEATURE_PIGGYBACK) &&
        isReady(sender, seq, flags))
        header |= LINK_HEADER_OF(0U, 0U, LINK_READY);
    link_copy(&sender->queue, piece, p);
    return header;
}

/* Sends a fragment. Returns 1: handed over. */
static int transmit(Link_Sender* sender, U32 seq) {
    Link_Output* output = sender->output;
    Link_Fragment* f = FRAGMENT(sender, seq);
    U8 frame[LINK_MAX_FRAME];
    U32 wait = sender->rto;
    int isAsked = mustAsk(sender, seq);
    U32 header = build(sender, seq, isAsked, frame);
    if (!link_sendFrame(output, frame, header, seq))
        return 0;
    if (header & LINK_CONTROL)
        link_ackIsSent(sender->receiver);
    if (f->tries)
        ++output->statistics.fragmentsResent;
    else
        f->firstAt = output->now;
    if (f->tries < 2U)
        ++f->tries;
    f->order = ++sender->order;
    f->sentAt = output->now;
    f->state = LINK_SENT;
    f->packet = output->handed;
    sender->unasked = (U8)(isAsked ? 0U : sender->unasked + 1U);
    if (IN_FLIGHT(sender) >= sender->fullCredit && wait > sender->srtt) /* only an answer helps */
        wait = sender->srtt < LINK_RTO_MIN ? LINK_RTO_MIN : sender->srtt;
    sender->timerAt = output->now + wait;
    return 1;
}

/* Adds a round trip to the estimate (RFC 6298). */
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
    if (roundTrip < sender->output->fastest)
        sender->output->fastest = roundTrip;
    sender->output->statistics.roundTripUs = sender->srtt;
}

/* Sets the time-out anew, since the peer has answered. */
static void setTimer(Link_Sender* sender) {
    U32 rto = sender->hasSample ? sender->srtt + 2U * sender->rttvar : LINK_RTO_FIRST;
    if (rto < LINK_RTO_MIN)
        rto = LINK_RTO_MIN;
    if (rto > LINK_RTO_MAX)
        rto = LINK_RTO_MAX;
    sender->rto = rto;
    sender->timerAt = sender->output->now + rto;
}

/* Marks fragments that were sent before `order` and not acknowledged as lost: they go out again. */
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

/* Marks acknowledged fragments: `advance` from the base on, and those of the bitmap, whose bit n is
 * for the fragment at advance + 1 + n. Other fragments that were sent before the newest of them are
 * lost. */
static void markAcked(Link_Sender* sender, U32 advance, const U8* bitmap, U32 size) {
    const Link_Fragment* newest = 0;
    U32 i;
    for (i = 0; i < IN_FLIGHT(sender); ++i) {
        Link_Fragment* f = FRAGMENT(sender, sender->base + i);
        U32 elapsed = sender->output->now - f->sentAt;
        U32 bit = i - advance - 1U;
        U32 isHere = i < advance || (bit < 8U * size && (bitmap[bit / 8U] >> bit % 8U & 1));
        if (!isHere || f->state == LINK_ACKED || f->tries == 0)
            continue;
        f->state = LINK_ACKED;
        sender->output->heardAt = sender->output->now;
        if (f->tries != 1U && elapsed < sender->srtt - sender->srtt / 4U) {
            /* Too soon for a round trip: it answers an earlier transmission. Where the radio says
             * what is lost, that was the first one, and the peer of a call takes longer now. */
            elapsed = sender->output->now - f->firstAt;
            if (sender->output->mostWaiting && !sender->output->contention.own.isMuch &&
                elapsed < LINK_RTO_FIRST)
                sample(sender, elapsed);
            continue;
        }
        if (!newest || LINK_BEFORE(newest->order, f->order))
            newest = f;
    }
    if (newest) {
        if (newest->tries == 1U && !sender->isLate)
            sample(sender, sender->output->now - newest->sentAt);
        sender->isLate = sender->unasked = 0;
        setTimer(sender);
        sendAgain(sender, newest->order);
    }
}

void link_onAck(Link_Sender* sender, U32 cumulative, U32 credit, const U8* bitmap, U32 size) {
    U32 advance = (U8)(cumulative - sender->base);
    if (advance > IN_FLIGHT(sender))
        return; /* an old acknowledgement came late */
    sender->credit = (U8)(credit <= sender->mask ? credit : sender->mask + 1U);
    if (sender->fullCredit < sender->credit)
        sender->fullCredit = sender->credit;
    sender->hasWork = 1;
    sender->isLossy = size != 0;
    markAcked(sender, advance, bitmap, size);
    while (advance--) {
        const Link_Fragment* f = FRAGMENT(sender, sender->base++);
        if (f->piece.flags & LINK_LAST)
            endEntry(sender, f->piece.entry, LINK_DELIVERED);
    }
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
        link_oweAck(sender->receiver);
}

/* Finds the next fragment to send: a short message that overtakes, a lost one, or a new one.
 * Returns 0: none. */
static int nextFragment(Link_Sender* sender, U32* seq) {
    int isRepeated = 0;
    for (*seq = sender->base; *seq != sender->next; ++*seq)
        if (FRAGMENT(sender, *seq)->state == LINK_TO_SEND) {
            isRepeated = FRAGMENT(sender, *seq)->tries != 0;
            if (!isRepeated)
                return 1;
            break;
        }
    if (!cut(sender, isRepeated))
        return isRepeated;
    *seq = sender->next - 1U;
    return 1;
}

/* The fragments in flight: repeats the oldest when the timer has expired. Returns 0: it has been
 * sent so long ago that the session must end, or the peer would carry out what is given up here. */
static int pollWindow(Link_Sender* sender, U32 now) {
    Link_Fragment* oldest = FRAGMENT(sender, sender->base);
    U32 age = oldest->tries ? now - oldest->firstAt : 0;
    if (age >= LINK_AGE_LAST)
        return 0;
    if (LINK_BEFORE(now, sender->timerAt) || sender->output->waiting)
        return 1;
    sender->timerAt = now + sender->rto;
    if (sender->output->mostWaiting && sender->output->packed)
        return 1;                 /* it has not left yet */
    oldest->state = LINK_TO_SEND; /* its answer tells about the others */
    sender->hasWork = sender->isLate = 1;
    sender->rto += sender->rto / 4U;
    if (sender->rto > LINK_RTO_MAX)
        sender->rto = LINK_RTO_MAX;
    if (age >= LINK_PING_AFTER) /* or the session ends before long */
        sender->rto = LINK_PING_EVERY;
    sender->timerAt = now + sender->rto;
    return 1;
}

int link_pollSender(Link_Sender* sender) {
    U32 seq;
    sender->output->isStream = IN_FLIGHT(sender) >= STREAM;
    if (sender->output->closeDue)
        queueClosings(sender);
    if (IN_FLIGHT(sender) && !pollWindow(sender, sender->output->now))
        return 0;
    while (sender->hasWork && link_isOpen(sender->output)) {
        sender->hasWork = (U8)nextFragment(sender, &seq);
        if (!sender->hasWork || !transmit(sender, seq))
            break;
        link_pollAck(sender->receiver);
    }
    return 1;
}
