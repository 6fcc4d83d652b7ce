/* SPDX-License-Identifier: MIT
 *
 * link_send: the send queue, fragments, window, acknowledgements and retransmission.
 *
 * The way is first in, first out. So what was transmitted before the newest transmission that has
 * been acknowledged, and is not acknowledged itself, is lost; the timer covers the tail only.
 */
#include "link.h"

#define RING(at) ((at) & (LINK_SEND_BYTES - 1U))
#define IN_FLIGHT(link) ((U8)((link)->sendNext - (link)->sendBase))

static Link_Item* itemAt(Link* link, U32 index) {
    return &link->items[(link->itemHead + index) % LINK_SEND_MESSAGES];
}

static void popItem(Link* link, Link_Outcome outcome) {
    Link_Item* item = itemAt(link, 0);
    U32 tag = item->tag;
    link->itemHead = (U8)((link->itemHead + 1U) % LINK_SEND_MESSAGES);
    --link->itemCount;
    link->queueHead += item->size;
    if (item->size == 0)
        return; /* an opening or closing */
    if (outcome == LINK_DELIVERED)
        LINK_COUNT(link, messagesSent, 1U);
    if (link->port->outcome)
        link->port->outcome(link->context, item->flags & 3, tag, outcome);
}

/* A session's state; what is still queued is reported. */
void Link_resetSend(Link* link) {
    while (link->itemCount)
        popItem(link, LINK_UNKNOWN);
    link->cutAt = link->queueTail = link->queueHead;
    link->sendBase = link->sendNext = 0;
    link->credit = link->fullCredit = LINK_WINDOW;
    link->cutItem = link->work = link->hasSample = 0;
    link->cutBegun = 0;
    link->timeout = LINK_RTO_FIRST;
}

/* Adds bytes to the ring, and to the check of their message. */
void Link_put(Link* link, const U8* data, U32 size) {
    Link_sum(link->check, data, size);
    while (size--)
        link->queue[RING(link->queueTail++)] = *data++;
}

/* An entry of the queue for `size` bytes, which the caller puts in. */
static Link_Status enqueue(Link* link, int channel, U32 flags, U32 size, U32 tag) {
    Link_Item* item;
    if (link->itemCount == LINK_SEND_MESSAGES ||
        size > LINK_SEND_BYTES - (link->queueTail - link->queueHead)) {
        link->wasFull = 1;
        return LINK_FULL;
    }
    item = itemAt(link, link->itemCount++);
    item->size = (U16)size;
    item->tag = tag;
    item->flags = (U8)(flags | (U32)channel);
    link->work = 1;
    return LINK_OK;
}

static Link_Status usable(const Link* link, int channel) {
    if (channel < 0 || channel >= LINK_CHANNELS)
        return LINK_CLOSED;
    return link->state == LINK_STATE_UP ? LINK_OK : LINK_DOWN;
}

Link_Status Link_openChannel(Link* link, int channel, U32 nowUs) {
    Link_Status status = usable(link, channel);
    (void)nowUs;
    if (status == LINK_OK && ((link->closing | link->closeDue) >> channel & 1))
        return LINK_FULL;
    if (status == LINK_OK)
        status = enqueue(link, channel, LINK_FIRST, 0, 0);
    if (status == LINK_OK)
        link->open = (U8)(link->open | 1U << channel);
    return status;
}

Link_Status Link_closeChannel(Link* link, int channel, U32 nowUs) {
    Link_Status status = usable(link, channel);
    (void)nowUs;
    if (status == LINK_OK && !(link->open >> channel & 1))
        return LINK_CLOSED;
    if (status == LINK_OK)
        status = enqueue(link, channel, 0, 0, 0);
    if (status == LINK_OK) {
        link->open = (U8)(link->open & ~(1U << channel));
        link->closing = (U8)(link->closing | 1U << channel);
    }
    return status;
}

/* The peer has closed a channel: it waits for our closing before the channel can be opened again.
 */
static void answerClosings(Link* link) {
    int channel;
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if ((link->closeDue >> channel & 1) && enqueue(link, channel, 0, 0, 0) == LINK_OK)
            link->closeDue = (U8)(link->closeDue & ~(1U << channel));
}

Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag, U32 nowUs) {
    Link_Status status = usable(link, channel);
    Link_Packed packed;
    U32 total;
    int isChecked;
    (void)nowUs;
    if (size == 0 || size > LINK_MAX_MESSAGE)
        return LINK_TOO_LONG;
    if (status != LINK_OK)
        return status;
    if (!(link->open >> channel & 1))
        return LINK_CLOSED;
    packed.prefix = packed.middle = packed.tailAt = 0;
    packed.tail = size;
    if (LINK_HEADS && (link->session.features & LINK_FEATURE_HEADS))
        Link_packHead(link, channel, data, size, &packed);
    total = packed.prefix + packed.middle + packed.tail;
    isChecked = total > LINK_UNCHECKED;
    if (isChecked)
        total += LINK_CHECK;
    status = enqueue(link, channel, LINK_FIRST, total, tag);
    if (status != LINK_OK)
        return status;
    link->check[0] = link->check[1] = 0;
    if (LINK_HEADS && (link->session.features & LINK_FEATURE_HEADS))
        Link_putPacked(link, channel, data, size, &packed);
    else
        Link_put(link, data, size);
    if (isChecked) {
        U8 check[LINK_CHECK];
        check[0] = link->check[0];
        check[1] = link->check[1];
        Link_put(link, check, LINK_CHECK);
    }
    return LINK_OK;
}

/* Cuts the next fragment from the queue into the window. 0: nothing to cut, or no room. */
static int cut(Link* link) {
    Link_Item* item = itemAt(link, link->cutItem);
    Link_Fragment* f = &link->window[LINK_SLOT(link->sendNext)];
    U32 inFlight = IN_FLIGHT(link);
    U32 left, size;
    /* Without credit one goes out all the same: its acknowledgement tells when there is credit
     * again. */
    if (link->cutItem == link->itemCount || (inFlight && inFlight >= link->credit) ||
        inFlight >= LINK_WINDOW)
        return 0;
    left = item->size - link->cutBegun;
    size = left < LINK_LONGEST(link) ? left : LINK_LONGEST(link);
    f->start = link->cutAt;
    f->size = (U8)size;
    f->flags = item->flags;
    if (link->cutBegun)
        f->flags = f->flags & 3;
    f->state = LINK_TO_SEND;
    f->tries = 0;
    link->cutAt += size;
    link->cutBegun = (U16)(link->cutBegun + size);
    if (left == size) {
        f->flags |= LINK_LAST;
        link->cutBegun = 0;
        ++link->cutItem;
    }
    if (inFlight == 0)
        link->timerAt = link->now + link->timeout;
    ++link->sendNext;
    return 1;
}

/* 1: handed over. A short message that is whole takes an acknowledgement along (LINK_KIND_RIDE). */
static int transmit(Link* link, U8 seq) {
    Link_Fragment* f = &link->window[LINK_SLOT(seq)];
    U8 frame[LINK_MAX_FRAME];
    U8* p = frame + 3;
    U32 size = f->size;
    U32 at = f->start;
    /* The peer should answer at once when the window runs dry or something was lost. */
    U32 ask = f->tries || (U8)(seq - link->sendBase) + 1U >= (LINK_WINDOW * 3U + 3U) / 4U
                  ? LINK_ACK_NOW
                  : 0;
    frame[0] = f->size;
    frame[1] = seq;
    frame[2] = (U8)(f->flags | ask | (U32)link->session.epoch << 2);
    if (LINK_RIDE && (f->flags & LINK_FIRST) && (f->flags & LINK_LAST) && size &&
        size < LINK_LONGEST(link) && Link_ackMayRide(link)) {
        U32 kind = ask ? LINK_KIND_RIDE_ASK : LINK_KIND_RIDE;
        frame[0] = (U8)(LINK_CONTROL | (size + 1U));
        frame[2] = (U8)((frame[2] & 0x1FU) | kind << 5);
        *p++ = link->receiveNext;
    }
    while (size--)
        *p++ = link->queue[RING(at++)];
    if (!Link_sendFrame(link, frame, frame[0] & 0x7FU, link->session.seed))
        return 0;
    if (frame[0] & LINK_CONTROL)
        Link_ackIsSent(link);
    if (f->tries)
        LINK_COUNT(link, fragmentsResent, 1U);
    if (f->tries < 2U)
        ++f->tries;
    f->order = ++link->order;
    f->sentAt = link->now;
    f->state = LINK_SENT;
    at = link->paceUntil + link->timeout / 2U;
    if (LINK_BEFORE(link->timerAt, at))
        link->timerAt = at;
    return 1;
}

static void sample(Link* link, U32 roundTrip) {
    U32 timeout;
    if (!link->hasSample) {
        link->smoothed = roundTrip;
        link->variance = roundTrip / 2U;
        link->hasSample = 1;
    } else {
        U32 error = roundTrip - link->smoothed;
        if (roundTrip < link->smoothed)
            error = 0U - error;
        link->variance += error / 4U - link->variance / 4U;
        link->smoothed += roundTrip / 8U - link->smoothed / 8U;
    }
    timeout = link->smoothed + 4U * link->variance + LINK_ACK_DELAY;
    if (timeout < LINK_RTO_MIN)
        timeout = LINK_RTO_MIN;
    if (timeout > LINK_RTO_MAX)
        timeout = LINK_RTO_MAX;
    link->timeout = timeout;
    if (LINK_STATISTICS)
        link->statistics.roundTripUs = link->smoothed;
}

/* What was sent before `order` and is not acknowledged goes out again. */
static void sendAgain(Link* link, U32 order) {
    U8 s;
    for (s = link->sendBase; s != link->sendNext; ++s) {
        Link_Fragment* f = &link->window[LINK_SLOT(s)];
        if (f->state == LINK_SENT && LINK_BEFORE(f->order, order)) {
            f->state = LINK_TO_SEND;
            link->work = 1;
        }
    }
}

void Link_onAck(Link* link, U32 cumulative, U32 credit, U32 bitmap) {
    U32 advance = (U8)(cumulative - link->sendBase);
    U32 newest = 0;
    U32 hasNews = 0;
    U32 i;
    if (advance > IN_FLIGHT(link))
        return; /* an old one that came late */
    link->credit = (U8)credit;
    if (link->fullCredit < credit)
        link->fullCredit = (U8)credit;
    link->work = 1;
    for (i = 0; i < IN_FLIGHT(link); ++i) {
        Link_Fragment* f = &link->window[LINK_SLOT(link->sendBase + i)];
        U32 elapsed = link->now - f->sentAt;
        if (i >= advance) {
            if (LINK_WINDOW == 1U)
                break;
            if (i == advance || !(bitmap >> (i - advance - 1U) & 1U))
                continue;
        }
        if (f->state == LINK_ACKED || f->tries == 0)
            continue;
        f->state = LINK_ACKED;
        if (f->tries == 1U)
            sample(link, elapsed);
        else if (elapsed < link->smoothed - link->smoothed / 4U)
            continue; /* sooner than a round trip: this answers an earlier transmission */
        if (!hasNews || LINK_BEFORE(newest, f->order))
            newest = f->order;
        hasNews = 1;
    }
    if (hasNews) {
        link->timerAt = link->now + link->timeout;
        if (LINK_WINDOW > 1U)
            sendAgain(link, newest);
    }
    while (advance--) {
        U32 flags = link->window[LINK_SLOT(link->sendBase++)].flags;
        if (flags & LINK_LAST) {
            --link->cutItem;
            popItem(link, LINK_DELIVERED);
        }
        if (link->wasFull) {
            link->wasFull = 0;
            if (link->port->writable)
                link->port->writable(link->context);
        }
    }
}

/* What is to be sent next, and whether there is anything. New fragments are cut as they are wanted.
 */
static int nextFragment(Link* link, U8* seq) {
    for (*seq = link->sendBase; *seq != link->sendNext; ++*seq)
        if (link->window[LINK_SLOT(*seq)].state == LINK_TO_SEND)
            return 1;
    return cut(link);
}

void Link_pollSend(Link* link) {
    U8 seq;
    if (link->closeDue)
        answerClosings(link);
    if (link->sendBase != link->sendNext && !LINK_BEFORE(link->now, link->timerAt)) {
        sendAgain(link, link->order + 1U);
        /* Loss here is the radio's, no congestion: doubling would only prolong a bad tail. */
        link->timeout += link->timeout / 4U;
        if (link->timeout > LINK_RTO_MAX)
            link->timeout = LINK_RTO_MAX;
        link->timerAt = link->now + link->timeout;
    }
    /* One frame may wait behind the one that is being sent. */
    while (link->work && !LINK_BEFORE(link->now + LINK_SLACK(link), link->paceUntil)) {
        if (!nextFragment(link, &seq))
            link->work = 0;
        else if (!transmit(link, seq))
            return;
    }
}
