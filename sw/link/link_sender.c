/* SPDX-License-Identifier: MIT
 *
 * link_sender: cuts messages into fragments, keeps a window of them in flight, and sends again what
 * is lost.
 *
 * The way is first in, first out. So what was transmitted before the newest transmission that has
 * been acknowledged, and is not acknowledged itself, is lost; the timer covers the tail only.
 */
#include "link.h"

#define IN_FLIGHT(sender) ((U8)((sender)->next - (sender)->base))
#define FRAGMENT(link, seq) (&(link)->window[LINK_SLOT(seq)])

/* In flight, these ask the peer for an acknowledgement at once: the window runs dry soon. */
#define ASK_FROM (LINK_WINDOW * 3U / 4U)

void link_resetSender(Link* link) {
    Link_Sender* sender = &link->sender;
    while (link->queue.count)
        link_popEntry(link, LINK_UNKNOWN);
    sender->cutAt = link->queue.tail = link->queue.head;
    sender->base = sender->next = 0;
    sender->credit = sender->fullCredit = LINK_WINDOW;
    sender->cutEntry = sender->hasWork = sender->hasSample = 0;
    sender->cutBytes = 0;
    sender->rto = LINK_RTO_FIRST;
}

/* Cuts the next fragment from the queue into the window. Returns 0: nothing to cut, or no room. */
static int cut(Link* link) {
    Link_Sender* sender = &link->sender;
    const Link_Entry* entry = link_entryAt(link, sender->cutEntry);
    Link_Fragment* f = FRAGMENT(link, sender->next);
    U32 inFlight = IN_FLIGHT(sender);
    U32 left, size;
    /* Without credit one goes out all the same: its acknowledgement tells when there is credit
     * again. */
    if (sender->cutEntry == link->queue.count || (inFlight && inFlight >= sender->credit) ||
        inFlight >= LINK_WINDOW)
        return 0;
    left = entry->size - sender->cutBytes;
    size = left < link->longest ? left : link->longest;
    f->start = sender->cutAt;
    f->size = (U8)size;
    f->flags = entry->flags;
    if (sender->cutBytes)
        f->flags = (U8)LINK_CHANNEL(f->flags);
    f->state = LINK_TO_SEND;
    f->tries = 0;
    sender->cutAt += size;
    sender->cutBytes = (U16)(sender->cutBytes + size);
    if (left == size) {
        f->flags |= LINK_LAST;
        sender->cutBytes = 0;
        ++sender->cutEntry;
    }
    if (inFlight == 0)
        sender->timerAt = link->now + sender->rto;
    ++sender->next;
    return 1;
}

/* Puts a fragment's payload into a frame. Returns the header: of data, or of a control frame that
 * takes an acknowledgement along, as may a short message that is whole. */
static U32 build(const Link* link, U8 seq, U8* frame) {
    const Link_Fragment* f = FRAGMENT(link, seq);
    U8* p = frame + LINK_HEADER;
    U32 size = f->size;
    U32 at = f->start;
    /* The peer should answer at once when the window runs dry or something was lost. */
    int asks = f->tries || (U8)(seq - link->sender.base) + 1U >= ASK_FROM;
    U32 header = LINK_HEADER_OF(size, seq, f->flags | (asks ? LINK_ACK_NOW : 0U));
    if ((f->flags & LINK_FIRST) && (f->flags & LINK_LAST) && size && size < link->longest &&
        link_ackMayRide(link)) {
        header = LINK_CONTROL_HEADER(asks ? LINK_KIND_PIGGYBACK_ASK : LINK_KIND_PIGGYBACK, seq,
                                     size + 1U) |
                 LINK_HEADER_OF(0U, 0U, LINK_CHANNEL(f->flags));
        *p++ = link->receiver.next;
    }
    while (size--)
        *p++ = link->queued[LINK_RING(at++)];
    return header;
}

/* Sends a fragment. Returns 1: handed over. */
static int transmit(Link* link, U8 seq) {
    Link_Sender* sender = &link->sender;
    Link_Fragment* f = FRAGMENT(link, seq);
    U8 frame[LINK_MAX_FRAME];
    U32 header = build(link, seq, frame);
    U32 at;
    if (!link_sendFrame(link, frame, header, link->session.key))
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
    at = link->paceUntil + sender->rto / 2U;
    if (LINK_BEFORE(sender->timerAt, at))
        sender->timerAt = at;
    return 1;
}

/* Takes a round trip into the estimate (RFC 6298). */
static void sample(Link* link, U32 roundTrip) {
    Link_Sender* sender = &link->sender;
    U32 rto;
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
    rto = sender->srtt + 4U * sender->rttvar + LINK_ACK_DELAY;
    if (rto < LINK_RTO_MIN)
        rto = LINK_RTO_MIN;
    if (rto > LINK_RTO_MAX)
        rto = LINK_RTO_MAX;
    sender->rto = rto;
    link->statistics.roundTripUs = sender->srtt;
}

/* Marks as lost what was sent before `order` and is not acknowledged: it goes out again. */
static void sendAgain(Link* link, U32 order) {
    Link_Sender* sender = &link->sender;
    U8 seq;
    for (seq = sender->base; seq != sender->next; ++seq) {
        Link_Fragment* f = FRAGMENT(link, seq);
        if (f->state == LINK_SENT && LINK_BEFORE(f->order, order)) {
            f->state = LINK_TO_SEND;
            sender->hasWork = 1;
        }
    }
}

/* Marks what is acknowledged: `advance` fragments from the base on, and those of the bitmap, whose
 * bit n is for the fragment at advance + 1 + n. What was transmitted before the newest of them is
 * lost. */
static void markAcked(Link* link, U32 advance, U32 bitmap) {
    Link_Sender* sender = &link->sender;
    U32 newest = 0;
    U32 hasNews = 0;
    U32 i;
    for (i = 0; i < IN_FLIGHT(sender); ++i) {
        Link_Fragment* f = FRAGMENT(link, sender->base + i);
        U32 elapsed = link->now - f->sentAt;
        if (i >= advance && (i == advance || !(bitmap >> (i - advance - 1U) & 1U)))
            continue;
        if (f->state == LINK_ACKED || f->tries == 0)
            continue;
        f->state = LINK_ACKED;
        if (f->tries == 1U)
            sample(link, elapsed);
        else if (elapsed < sender->srtt - sender->srtt / 4U)
            continue; /* sooner than a round trip: this answers an earlier transmission */
        if (!hasNews || LINK_BEFORE(newest, f->order))
            newest = f->order;
        hasNews = 1;
    }
    if (hasNews) {
        sender->timerAt = link->now + sender->rto;
        sendAgain(link, newest);
    }
}

void link_onAck(Link* link, U32 cumulative, U32 credit, U32 bitmap) {
    Link_Sender* sender = &link->sender;
    U32 advance = (U8)(cumulative - sender->base);
    if (advance > IN_FLIGHT(sender))
        return; /* an old one that came late */
    sender->credit = (U8)credit;
    if (sender->fullCredit < credit)
        sender->fullCredit = (U8)credit;
    sender->hasWork = 1;
    markAcked(link, advance, bitmap);
    while (advance--) {
        if (FRAGMENT(link, sender->base++)->flags & LINK_LAST) {
            --sender->cutEntry;
            link_popEntry(link, LINK_DELIVERED);
        }
    }
}

/* Finds what is to be sent next; new fragments are cut as they are wanted. Returns 0: nothing. */
static int nextFragment(Link* link, U8* seq) {
    Link_Sender* sender = &link->sender;
    for (*seq = sender->base; *seq != sender->next; ++*seq)
        if (FRAGMENT(link, *seq)->state == LINK_TO_SEND)
            return 1;
    return cut(link);
}

void link_pollSender(Link* link) {
    Link_Sender* sender = &link->sender;
    U8 seq;
    if (link->closeDue)
        link_queueClosings(link);
    if (sender->base != sender->next && !LINK_BEFORE(link->now, sender->timerAt)) {
        sendAgain(link, sender->order + 1U);
        /* Loss here is the radio's, no congestion: doubling would only prolong a bad tail. */
        sender->rto += sender->rto / 4U;
        if (sender->rto > LINK_RTO_MAX)
            sender->rto = LINK_RTO_MAX;
        sender->timerAt = link->now + sender->rto;
    }
    while (sender->hasWork && !LINK_BEFORE(link->now + link_slack(link), link->paceUntil)) {
        if (!nextFragment(link, &seq))
            sender->hasWork = 0;
        else if (!transmit(link, seq))
            return;
    }
}
