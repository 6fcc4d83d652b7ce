/* SPDX-License-Identifier: MIT
 *
 * link_sender: cuts messages into fragments, keeps a window of them in flight, and repeats lost
 * ones.
 *
 * The way to the peer keeps the order. So a transmission without acknowledgement is lost when a
 * later one has been acknowledged; only the last ones need the timer.
 */
#include "link.h"

#define IN_FLIGHT(sender) ((sender)->next - (sender)->base)
#define FRAGMENT(link, seq) (&(link)->window[LINK_SLOT(seq)])

/* Longest wait of the timer while the window is full, a round trip in microseconds: only an answer
 * lets the sender go on then. */
#define FULL_WAIT(sender) ((sender)->srtt < LINK_RTO_MIN ? LINK_RTO_MIN : (sender)->srtt)

void link_resetSender(Link* link) {
    Link_Sender* sender = &link->sender;
    while (link->queue.count)
        link_endEntry(link, link_entryAt(link, 0), LINK_UNKNOWN);
    sender->cutAt = link->queue.tail = link->queue.head;
    sender->base = sender->next = 0;
    sender->credit = sender->fullCredit = LINK_LEAST_WINDOW;
    sender->cutEntry = sender->isAhead = sender->hasWork = sender->hasSample = 0;
    sender->cutBytes = 0;
    sender->fastest = sender->rto = LINK_RTO_FIRST;
}

/* Finds a message of one fragment, an opening or a closing that may overtake the present long
 * message: on another channel than all that it overtakes, in the order of the heads that the peer
 * learns, and never two in a row. Sets `start` to the place of its bytes. Returns 0: none. */
static Link_Entry* findAhead(Link* link, U32* start) {
    Link_Sender* sender = &link->sender;
    Link_Entry* entry = link_entryAt(link, sender->cutEntry);
    U32 channels = 0;
    U32 i;
    if (sender->isAhead || entry->size - sender->cutBytes <= link->longest ||
        !(link->session.features & LINK_FEATURE_PIGGYBACK))
        return 0;
    *start = sender->cutAt - sender->cutBytes;
    for (i = sender->cutEntry; !(entry->flags & LINK_ENTRY_LEARNS);) {
        if (!(entry->flags & LINK_ENTRY_AHEAD))
            channels |= 1U << LINK_CHANNEL(entry->flags);
        *start += entry->size;
        if (++i == link->queue.count)
            break;
        entry = link_entryAt(link, i);
        if (entry->size <= link->longest &&
            !(entry->flags & (LINK_ENTRY_AHEAD | LINK_ENTRY_LEARNS)) &&
            !(channels >> LINK_CHANNEL(entry->flags) & 1U))
            return entry;
    }
    return 0;
}

/* Cuts `size` bytes off an entry into the window. */
static void cutOff(Link* link, const Link_Entry* entry, U32 start, U32 size, U32 flags) {
    Link_Fragment* f = FRAGMENT(link, link->sender.next++);
    f->start = start;
    f->size = (U8)size;
    f->flags = (U8)flags;
    f->state = LINK_TO_SEND;
    f->tries = 0;
    f->entry = (U8)(entry - link->entries);
}

/* Cuts the next fragment from the queue into the window. Returns 0: nothing to cut, or no room. */
static int cut(Link* link) {
    Link_Sender* sender = &link->sender;
    Link_Entry* entry = link_entryAt(link, sender->cutEntry);
    Link_Entry* ahead;
    U32 inFlight = IN_FLIGHT(sender);
    U32 flags = entry->flags & (LINK_FIRST | 3U);
    U32 left, size, start;
    /* One fragment goes out even without credit: its acknowledgement brings news of credit. */
    if (sender->cutEntry == link->queue.count || (inFlight && inFlight >= sender->credit) ||
        inFlight >= LINK_WINDOW)
        return 0;
    ahead = findAhead(link, &start);
    sender->isAhead = ahead != 0;
    if (ahead) {
        ahead->flags |= LINK_ENTRY_AHEAD;
        cutOff(link, ahead, start, ahead->size, (ahead->flags & (LINK_FIRST | 3U)) | LINK_LAST);
        return 1;
    }
    left = entry->size - sender->cutBytes;
    size = link_room(link);
    if (link->receiver.ackNow && (sender->cutBytes || left >= size))
        size -= LINK_ACK_ROOM(link); /* it leaves in the same packet */
    if (size > left)
        size = left;
    if (sender->cutBytes)
        flags = LINK_CHANNEL(flags);
    if (left == size)
        flags |= LINK_LAST;
    cutOff(link, entry, sender->cutAt, size, flags);
    sender->cutAt += size;
    sender->cutBytes = (U16)(sender->cutBytes + size);
    if (left != size)
        return 1;
    sender->cutBytes = 0;
    while (++sender->cutEntry < link->queue.count &&
           ((entry = link_entryAt(link, sender->cutEntry))->flags & LINK_ENTRY_AHEAD))
        sender->cutAt += entry->size;
    return 1;
}

/* Returns n: one of n transmissions asks for an acknowledgement, which costs a turn on a
 * half-duplex air. n is great while nothing is lost; but a loss stops the window, and short
 * messages fill the queue before the window. */
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
    const Link_Fragment* f = FRAGMENT(link, seq);
    U8* p = frame + LINK_HEADER;
    U32 size = f->size;
    U32 at = f->start;
    U32 header = LINK_HEADER_OF(size, (U8)seq, f->flags | (isAsked ? LINK_ACK_NOW : 0U));
    if ((f->flags & LINK_FIRST) && (f->flags & LINK_LAST) && size && size < link_room(link) &&
        link_ackMayRide(link)) {
        header = LINK_CONTROL_HEADER(isAsked ? LINK_KIND_PIGGYBACK_ASK : LINK_KIND_PIGGYBACK,
                                     (U8)seq, size + 1U) |
                 LINK_HEADER_OF(0U, 0U, LINK_CHANNEL(f->flags));
        *p++ = (U8)link->receiver.next;
    }
    while (size--)
        *p++ = link->queued[LINK_RING(at++)];
    return header;
}

/* Sends a fragment. Returns 1: handed over. */
static int transmit(Link* link, U32 seq) {
    Link_Sender* sender = &link->sender;
    Link_Fragment* f = FRAGMENT(link, seq);
    U8 frame[LINK_MAX_FRAME];
    int isAsked = mustAsk(link, seq);
    U32 header = build(link, seq, isAsked, frame);
    if (!link_sendFrame(link, frame, header, seq))
        return 0;
    if (header & LINK_CONTROL)
        link_ackIsSent(link);
    if (f->tries)
        ++link->statistics.fragmentsResent;
    if (f->tries < 2U)
        ++f->tries;
    f->order = ++sender->order;
    f->sentAt = link->now;
    f->state = LINK_SENT;
    sender->unasked = (U8)(isAsked ? 0U : sender->unasked + 1U);
    sender->timerAt = link->now + sender->rto;
    if (IN_FLIGHT(sender) >= sender->fullCredit && FULL_WAIT(sender) < sender->rto)
        sender->timerAt = link->now + FULL_WAIT(sender);
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
    U32 rto = sender->srtt + 2U * sender->rttvar;
    if (!sender->hasSample)
        rto = LINK_RTO_FIRST;
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
        if (f->flags & LINK_LAST)
            link_endEntry(link, &link->entries[f->entry], LINK_DELIVERED);
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

void link_pollSender(Link* link) {
    Link_Sender* sender = &link->sender;
    U32 seq;
    if (link->closeDue)
        link_queueClosings(link);
    if (sender->base != sender->next && !LINK_BEFORE(link->now, sender->timerAt)) {
        FRAGMENT(link, sender->base)->state = LINK_TO_SEND; /* its answer tells about the others */
        sender->hasWork = sender->isLate = 1;
        /* The radio loses packets, not a congested network: doubling would only prolong a bad end.
         */
        sender->rto += sender->rto / 4U;
        if (sender->rto > LINK_RTO_MAX)
            sender->rto = LINK_RTO_MAX;
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
