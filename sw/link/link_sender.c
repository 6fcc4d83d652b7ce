/* SPDX-License-Identifier: MIT
 *
 * link_sender: cuts messages into fragments, keeps a window of them in flight, and repeats lost
 * ones.
 */
#include "link.h"

#define IN_FLIGHT(sender) ((sender)->next - (sender)->base)
#define FRAGMENT(link, seq) (&(link)->window[LINK_SLOT(seq)])

Link_Entry* link_offer(Link* link, U32 flags, U32 size) {
    Link_Entry* entry = link_enqueue(&link->queue, flags, size, link->longest);
    if (entry)
        link->sender.hasWork = 1;
    return entry;
}

/* Queues the closings that had no room yet. The peer waits for each before the channel can be
 * opened again. */
static void queueClosings(Link* link) {
    int channel;
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if ((link->closeDue >> channel & 1) && link_offer(link, (U32)channel, 0))
            link->closeDue = (U8)(link->closeDue ^ 1U << channel);
}

/* Ends an entry of the queue, reports a message's outcome, and tells that there is room again. */
static void endEntry(Link* link, U32 index, Link_Outcome outcome) {
    Link_Queue* queue = &link->queue;
    Link_Entry ended = queue->entries[index];
    link_dequeue(queue, index);
    if (ended.size) { /* a message, not an opening or closing */
        link->statistics.messagesSent += outcome == LINK_DELIVERED;
        if (link->port->outcome)
            link->port->outcome(link->context, (int)LINK_CHANNEL(ended.flags), ended.tag, outcome);
    }
    if (queue->wasFull && outcome == LINK_DELIVERED) {
        queue->wasFull = 0;
        queueClosings(link);
        if (link->port->writable)
            link->port->writable(link->context);
    }
}

void link_resetSender(Link* link) {
    Link_Sender* sender = &link->sender;
    while (link->queue.count)
        endEntry(link, link->queue.first, LINK_UNKNOWN);
    link_rewind(&link->queue);
    sender->base = sender->next = 0;
    sender->credit = sender->fullCredit = LINK_LEAST_WINDOW;
    sender->hasWork = sender->hasSample = 0;
    sender->fastest = sender->rto = LINK_RTO_FIRST;
}

/* Cuts the next fragment from the queue into the window. Returns 0: nothing to cut, or no room. */
static int cut(Link* link) {
    Link_Sender* sender = &link->sender;
    Link_Fragment* f = FRAGMENT(link, sender->next);
    U32 inFlight = IN_FLIGHT(sender);
    U32 room = link_room(link);
    /* An acknowledgement that is due leaves in the same packet. */
    U32 reduced = link->receiver.ackNow ? room - LINK_ACK_ROOM(link) : room;
    /* One fragment goes out even without credit: its acknowledgement brings news of credit. */
    if ((inFlight && inFlight >= sender->credit) || inFlight >= LINK_WINDOW ||
        !link_cut(&link->queue, &f->piece, room, reduced,
                  link->session.features & LINK_FEATURE_PIGGYBACK ? link->longest : 0U))
        return 0;
    ++sender->next;
    f->state = LINK_TO_SEND;
    f->tries = 0;
    return 1;
}

/* Returns n: one of n transmissions asks for an acknowledgement, which costs a turn of the air:
 * more often where losses stop the window, or short messages fill the queue before it. */
static U32 askEvery(const Link* link) {
    if (link->sender.isLossy)
        return 5U;
    if (link->queue.count >= LINK_SEND_MESSAGES / 2U)
        return LINK_SEND_MESSAGES / 2U;
    return link->sender.fullCredit / 4U * 3U;
}

/* True if the peer should answer a fragment at once: one of every n, the last one within its
 * credit, and the last one that is sent again. */
static int mustAsk(const Link* link, U32 seq) {
    const Link_Sender* sender = &link->sender;
    if (sender->unasked + 1U >= askEvery(link) || seq - sender->base + 1U >= sender->credit)
        return 1;
    if (!FRAGMENT(link, seq)->tries)
        return 0;
    while (++seq != link->sender.next)
        if (FRAGMENT(link, seq)->state == LINK_TO_SEND)
            return 0;
    return 1;
}

/* Puts a fragment's payload into a frame. Returns the header: of data, or, for a whole short
 * message, of a control frame that takes an acknowledgement along. */
static U32 build(const Link* link, U32 seq, int isAsked, U8* frame) {
    const Link_Piece* piece = &FRAGMENT(link, seq)->piece;
    U8* p = frame + LINK_HEADER;
    U32 flags = piece->flags;
    U32 size = piece->size;
    U32 header = LINK_HEADER_OF(size, (U8)seq, flags | (isAsked ? LINK_ACK_NOW : 0U));
    if ((flags & LINK_FIRST) && (flags & LINK_LAST) && size && size < link_room(link) &&
        link_ackMayRide(link)) {
        header = LINK_CONTROL_HEADER(isAsked ? LINK_KIND_PIGGYBACK_ASK : LINK_KIND_PIGGYBACK,
                                     (U8)seq, size + 1U) |
                 LINK_HEADER_OF(0U, 0U, LINK_CHANNEL(flags));
        *p++ = (U8)link->receiver.next;
    }
    link_copy(&link->queue, piece, p);
    return header;
}

/* Sends a fragment. Returns 1: handed over. */
static int transmit(Link* link, U32 seq) {
    Link_Sender* sender = &link->sender;
    Link_Fragment* f = FRAGMENT(link, seq);
    U8 frame[LINK_MAX_FRAME];
    U32 wait = sender->rto;
    int isAsked = mustAsk(link, seq);
    U32 header = build(link, seq, isAsked, frame);
    if (!link_sendFrame(link, frame, header, seq))
        return 0;
    if (header & LINK_CONTROL)
        link_ackIsSent(link);
    if (f->tries)
        ++link->statistics.fragmentsResent;
    else
        f->firstAt = link->now;
    if (f->tries < 2U)
        ++f->tries;
    f->order = ++sender->order;
    f->sentAt = link->now;
    f->state = LINK_SENT;
    sender->unasked = (U8)(isAsked ? 0U : sender->unasked + 1U);
    if (IN_FLIGHT(sender) >= sender->fullCredit && wait > sender->srtt) /* only an answer helps */
        wait = sender->srtt < LINK_RTO_MIN ? LINK_RTO_MIN : sender->srtt;
    sender->timerAt = link->now + wait;
    return 1;
}

/* Adds a round trip to the estimate (RFC 6298). */
static void sample(Link* link, U32 roundTrip) {
    Link_Sender* sender = &link->sender;
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
    if (roundTrip < sender->fastest)
        sender->fastest = roundTrip;
    link->statistics.roundTripUs = sender->srtt;
}

/* Sets the time-out anew, since the peer has answered. */
static void setTimer(Link* link) {
    Link_Sender* sender = &link->sender;
    U32 rto = sender->hasSample ? sender->srtt + 2U * sender->rttvar : LINK_RTO_FIRST;
    if (rto < LINK_RTO_MIN)
        rto = LINK_RTO_MIN;
    if (rto > LINK_RTO_MAX)
        rto = LINK_RTO_MAX;
    sender->rto = rto;
    sender->timerAt = link->now + rto;
}

/* Marks fragments that were sent before `order` and not acknowledged as lost: they go out again. */
static void sendAgain(Link* link, U32 order) {
    Link_Sender* sender = &link->sender;
    U32 seq;
    for (seq = sender->base; seq != sender->next; ++seq) {
        Link_Fragment* f = FRAGMENT(link, seq);
        if (f->state == LINK_SENT && LINK_BEFORE(f->order, order)) {
            f->state = LINK_TO_SEND;
            sender->hasWork = 1;
        }
    }
}

/* Marks acknowledged fragments: `advance` from the base on, and those of the bitmap, whose bit n is
 * for the fragment at advance + 1 + n. Other fragments that were sent before the newest of them are
 * lost. */
static void markAcked(Link* link, U32 advance, const U8* bitmap, U32 size) {
    Link_Sender* sender = &link->sender;
    const Link_Fragment* newest = 0;
    U32 i;
    for (i = 0; i < IN_FLIGHT(sender); ++i) {
        Link_Fragment* f = FRAGMENT(link, sender->base + i);
        U32 elapsed = link->now - f->sentAt;
        U32 bit = i - advance - 1U;
        U32 isHere = i < advance || (bit < 8U * size && (bitmap[bit / 8U] >> bit % 8U & 1));
        if (!isHere || f->state == LINK_ACKED || f->tries == 0)
            continue;
        f->state = LINK_ACKED;
        link->heardAt = link->now;
        if (f->tries != 1U && elapsed < sender->srtt - sender->srtt / 4U)
            continue; /* too soon for a round trip: it answers an earlier transmission */
        if (!newest || LINK_BEFORE(newest->order, f->order))
            newest = f;
    }
    if (newest) {
        if (newest->tries == 1U && !sender->isLate)
            sample(link, link->now - newest->sentAt);
        sender->isLate = sender->unasked = 0;
        setTimer(link);
        sendAgain(link, newest->order);
    }
}

void link_onAck(Link* link, U32 cumulative, U32 credit, const U8* bitmap, U32 size) {
    Link_Sender* sender = &link->sender;
    U32 advance = (U8)(cumulative - sender->base);
    if (advance > IN_FLIGHT(sender))
        return; /* an old acknowledgement came late */
    sender->credit = (U8)(credit < LINK_WINDOW ? credit : LINK_WINDOW);
    if (sender->fullCredit < sender->credit)
        sender->fullCredit = sender->credit;
    sender->hasWork = 1;
    sender->isLossy = size != 0;
    markAcked(link, advance, bitmap, size);
    while (advance--) {
        const Link_Fragment* f = FRAGMENT(link, sender->base++);
        if (f->piece.flags & LINK_LAST)
            endEntry(link, f->piece.entry, LINK_DELIVERED);
    }
}

/* Finds the next fragment to send, and cuts a new one if necessary. Returns 0: none. */
static int nextFragment(Link* link, U32* seq) {
    Link_Sender* sender = &link->sender;
    for (*seq = sender->base; *seq != sender->next; ++*seq)
        if (FRAGMENT(link, *seq)->state == LINK_TO_SEND)
            return 1;
    return cut(link);
}

U32 link_age(const Link* link) {
    const Link_Sender* sender = &link->sender;
    const Link_Fragment* oldest = FRAGMENT(link, sender->base);
    return IN_FLIGHT(sender) && oldest->tries ? link->now - oldest->firstAt : 0;
}

void link_pollSender(Link* link) {
    Link_Sender* sender = &link->sender;
    U32 seq;
    if (link->closeDue)
        queueClosings(link);
    if (sender->base != sender->next && !LINK_BEFORE(link->now, sender->timerAt)) {
        FRAGMENT(link, sender->base)->state = LINK_TO_SEND; /* its answer tells about the others */
        sender->hasWork = sender->isLate = 1;
        sender->rto += sender->rto / 4U;
        if (sender->rto > LINK_RTO_MAX)
            sender->rto = LINK_RTO_MAX;
        if (link_age(link) >= LINK_PING_AFTER) /* or the session ends before long */
            sender->rto = LINK_PING_EVERY;
        sender->timerAt = link->now + sender->rto;
    }
    while (sender->hasWork && link_isOpen(link)) {
        if (!nextFragment(link, &seq)) {
            sender->hasWork = 0;
            return;
        }
        if (!transmit(link, seq))
            return;
        link_pollAck(link);
    }
}
