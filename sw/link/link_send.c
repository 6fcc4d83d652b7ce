/* SPDX-License-Identifier: MIT
 *
 * link_send: the send queue, fragments, window, acknowledgements and retransmission.
 *
 * The way is first in, first out. So what was transmitted before the newest transmission that has
 * been acknowledged, and is not acknowledged itself, is lost; the timer covers the tail only.
 */
#include "link.h"

#define SLOT(seq) ((seq)&63U)

void Link_resetSend(Link* link) {
    link->sendBase = link->sendNext = 0;
    link->credit = LINK_WINDOW;
    link->order = 0;
    link->timerRuns = link->hasSample = 0;
    link->timeout = LINK_RTO_FIRST;
    link->cutItem = link->cutOffset = 0;
}

static Link_Item* itemAt(Link* link, U32 index) {
    return &link->items[(link->itemHead + index) % LINK_SEND_MESSAGES];
}

static void popItem(Link* link, Link_Outcome outcome) {
    Link_Item item = *itemAt(link, 0);
    link->itemHead = (link->itemHead + 1U) % LINK_SEND_MESSAGES;
    --link->itemCount;
    link->queueHead = (link->queueHead + item.size) % LINK_SEND_BYTES;
    link->queueUsed -= item.size;
    if (item.kind == LINK_ITEM_MESSAGE) {
        if (outcome == LINK_DELIVERED)
            ++link->statistics.messagesSent;
        if (link->port->outcome)
            link->port->outcome(link->context, item.channel, item.tag, outcome);
    }
}

void Link_dropQueue(Link* link) {
    while (link->itemCount)
        popItem(link, LINK_UNKNOWN);
    link->queueHead = link->queueUsed = link->itemHead = 0;
    Link_resetSend(link);
}

static Link_Status enqueue(Link* link, int channel, Link_ItemKind kind, const U8* data, U32 size,
                           U32 tag) {
    Link_Item* item;
    U32 i, at;
    if (channel < 0 || channel >= LINK_CHANNELS)
        return LINK_CLOSED;
    if (link->state != LINK_STATE_UP)
        return LINK_DOWN;
    if (kind != LINK_ITEM_OPEN && !(link->open >> channel & 1))
        return LINK_CLOSED;
    if (link->itemCount == LINK_SEND_MESSAGES || size > LINK_SEND_BYTES - link->queueUsed) {
        link->wasFull = 1;
        return LINK_FULL;
    }
    item = itemAt(link, link->itemCount++);
    at = (link->queueHead + link->queueUsed) % LINK_SEND_BYTES;
    item->start = at;
    item->size = size;
    item->tag = tag;
    item->channel = (U8)channel;
    item->kind = (U8)kind;
    for (i = 0; i < size; ++i) {
        link->queue[at] = data[i];
        if (++at == LINK_SEND_BYTES)
            at = 0;
    }
    link->queueUsed += size;
    return LINK_OK;
}

Link_Status Link_openChannel(Link* link, int channel, U32 nowUs) {
    Link_Status status = enqueue(link, channel, LINK_ITEM_OPEN, 0, 0, 0);
    (void)nowUs;
    if (status == LINK_OK)
        link->open = (U8)(link->open | 1U << channel);
    return status;
}

Link_Status Link_closeChannel(Link* link, int channel, U32 nowUs) {
    Link_Status status = enqueue(link, channel, LINK_ITEM_CLOSE, 0, 0, 0);
    (void)nowUs;
    if (status == LINK_OK)
        link->open = (U8)(link->open & ~(1U << channel));
    return status;
}

Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag, U32 nowUs) {
    (void)nowUs;
    if (size == 0 || size > LINK_MAX_MESSAGE)
        return LINK_TOO_LONG;
    return enqueue(link, channel, LINK_ITEM_MESSAGE, data, size, tag);
}

/* Fragments that may be in flight. Without credit one goes out all the same, as a probe: its
 * acknowledgement tells when there is credit again. */
static U32 windowLimit(const Link* link) {
    if (link->credit == 0)
        return 1;
    return link->credit < LINK_WINDOW ? link->credit : LINK_WINDOW;
}

/* Cuts the next fragment from the queue into the window. 0: nothing to cut, or no room. */
static int cut(Link* link) {
    Link_Item* item;
    Link_Fragment* f;
    U32 inFlight = (U8)(link->sendNext - link->sendBase);
    U32 left;
    if (link->cutItem == link->itemCount || inFlight >= windowLimit(link))
        return 0;
    item = itemAt(link, link->cutItem);
    f = &link->window[SLOT(link->sendNext)];
    left = item->size - link->cutOffset;
    f->size = (U8)(left < LINK_MAX_PAYLOAD ? left : LINK_MAX_PAYLOAD);
    f->start = (item->start + link->cutOffset) % LINK_SEND_BYTES;
    f->flags = item->channel;
    if (link->cutOffset == 0 && item->kind != LINK_ITEM_CLOSE)
        f->flags |= LINK_FIRST;
    if (left == f->size)
        f->flags |= LINK_LAST;
    f->transmissions = f->acked = f->lost = 0;
    link->cutOffset += f->size;
    if (f->flags & LINK_LAST) {
        link->cutOffset = 0;
        ++link->cutItem;
    }
    ++link->sendNext;
    return 1;
}

/* 1: handed over. */
static int transmit(Link* link, U8 seq, int askAck, U32 now) {
    Link_Fragment* f = &link->window[SLOT(seq)];
    U8 frame[LINK_MAX_FRAME];
    U32 i, at = f->start;
    frame[0] = f->size;
    frame[1] = seq;
    frame[2] = (U8)(f->flags | (askAck ? LINK_ACK_NOW : 0U) | (U32)link->session.epoch << 2);
    for (i = 0; i < f->size; ++i) {
        frame[3U + i] = link->queue[at];
        if (++at == LINK_SEND_BYTES)
            at = 0;
    }
    if (!Link_sendFrame(link, frame, f->size, link->session.seed, now))
        return 0;
    f->lastOrder = ++link->order;
    if (f->transmissions == 0)
        f->firstOrder = f->lastOrder;
    else
        ++link->statistics.fragmentsResent;
    if (f->transmissions < 255U)
        ++f->transmissions;
    f->lost = 0;
    f->sentAt = now;
    return 1;
}

static void sample(Link* link, U32 roundTrip) {
    if (!link->hasSample) {
        link->smoothed = roundTrip;
        link->variance = roundTrip / 2U;
        link->hasSample = 1;
    } else {
        U32 error =
            roundTrip > link->smoothed ? roundTrip - link->smoothed : link->smoothed - roundTrip;
        link->variance += error / 4U - link->variance / 4U;
        link->smoothed += roundTrip / 8U - link->smoothed / 8U;
    }
    link->timeout = link->smoothed + 4U * link->variance + LINK_ACK_DELAY;
    if (link->timeout < LINK_RTO_MIN)
        link->timeout = LINK_RTO_MIN;
    if (link->timeout > LINK_RTO_MAX)
        link->timeout = LINK_RTO_MAX;
    link->statistics.roundTripUs = link->smoothed;
}

/* Marks a fragment as arrived; returns the number of the transmission that this surely means. */
static U32 acknowledge(Link* link, Link_Fragment* f, U32 now) {
    U32 elapsed = now - f->sentAt;
    f->acked = 1;
    f->lost = 0;
    if (f->transmissions == 1) {
        sample(link, elapsed);
        return f->firstOrder;
    }
    /* Sent again: an answer sooner than a round trip belongs to the first time. */
    return elapsed >= link->smoothed - link->smoothed / 4U ? f->lastOrder : f->firstOrder;
}

void Link_onAck(Link* link, const U8* frame, U32 payload, U32 now) {
    U8 cumulative = frame[1];
    U32 inFlight = (U8)(link->sendNext - link->sendBase);
    U32 advance = (U8)(cumulative - link->sendBase);
    U32 bitmap = payload == 5U ? Link_get32(frame + 4) : 0;
    U32 newest = 0;
    U32 i;
    if (advance > inFlight)
        return; /* an old one that came late */
    link->credit = frame[3];
    for (i = 0; i < inFlight; ++i) {
        Link_Fragment* f = &link->window[SLOT(link->sendBase + i)];
        int arrived = i < advance || (i > advance && i - advance - 1U < 32U &&
                                      (bitmap >> (i - advance - 1U) & 1U));
        if (arrived && !f->acked && f->transmissions) {
            U32 order = acknowledge(link, f, now);
            if (order > newest)
                newest = order;
        }
    }
    for (i = 0; i < inFlight; ++i) {
        Link_Fragment* f = &link->window[SLOT(link->sendBase + i)];
        if (!f->acked && f->transmissions && f->lastOrder < newest)
            f->lost = 1;
    }
    for (i = 0; i < advance; ++i) {
        U8 flags = link->window[SLOT(link->sendBase)].flags;
        ++link->sendBase;
        if (flags & LINK_LAST) {
            --link->cutItem;
            popItem(link, LINK_DELIVERED);
        }
    }
    if (newest)
        link->timerAt = now + link->timeout;
    link->timerRuns = link->sendBase != link->sendNext;
    if (link->wasFull && advance) {
        link->wasFull = 0;
        if (link->port->writable)
            link->port->writable(link->context);
    }
}

/* What is to be sent next, and whether there is anything. New fragments are cut as they are wanted.
 */
static int nextFragment(Link* link, U8* seq) {
    U8 s;
    for (s = link->sendBase; s != link->sendNext; ++s) {
        Link_Fragment* f = &link->window[SLOT(s)];
        if (f->lost || f->transmissions == 0) {
            *seq = s;
            return 1;
        }
    }
    *seq = link->sendNext;
    return cut(link);
}

static int mayHandOver(const Link* link, U32 now) {
    U32 slack = LINK_MAX_FRAME * link->byteTimeUs16 >> 4; /* one frame waits behind the one sent */
    return !Link_isBefore(now + slack, link->paceUntil);
}

static void onTimeout(Link* link, U32 now) {
    U8 s;
    for (s = link->sendBase; s != link->sendNext; ++s) {
        Link_Fragment* f = &link->window[SLOT(s)];
        if (!f->acked && f->transmissions)
            f->lost = 1;
    }
    link->timeout = link->timeout < LINK_RTO_MAX / 2U ? link->timeout * 2U : LINK_RTO_MAX;
    link->timerAt = now + link->timeout;
}

void Link_pollSend(Link* link, U32 now) {
    U8 seq;
    if (link->state != LINK_STATE_UP)
        return;
    if (link->timerRuns && !Link_isBefore(now, link->timerAt))
        onTimeout(link, now);
    while (mayHandOver(link, now) && nextFragment(link, &seq)) {
        U32 ahead = (U8)(seq - link->sendBase);
        /* The peer should answer at once when the window runs dry or something was lost. */
        int ask = link->window[SLOT(seq)].transmissions != 0 || ahead + 1U >= LINK_WINDOW * 3U / 4U;
        if (!transmit(link, seq, ask, now))
            return;
        if (!link->timerRuns) {
            link->timerRuns = 1;
            link->timerAt = now + link->timeout;
        }
        if (Link_isBefore(link->timerAt, link->paceUntil + link->timeout / 2U))
            link->timerAt = link->paceUntil + link->timeout / 2U;
    }
}

U32 Link_sendDeadline(const Link* link, U32 now) {
    U32 wait = 0xFFFFFFFFU;
    U32 inFlight = (U8)(link->sendNext - link->sendBase);
    int hasWork = link->cutItem != link->itemCount && inFlight < windowLimit(link);
    U8 s;
    if (link->state != LINK_STATE_UP)
        return wait;
    if (link->timerRuns)
        wait = Link_isBefore(link->timerAt, now) ? 0 : link->timerAt - now;
    for (s = link->sendBase; s != link->sendNext && !hasWork; ++s)
        hasWork = link->window[SLOT(s)].lost || link->window[SLOT(s)].transmissions == 0;
    if (hasWork) {
        U32 slack = LINK_MAX_FRAME * link->byteTimeUs16 >> 4;
        U32 pace = mayHandOver(link, now) ? 0 : link->paceUntil - slack - now;
        if (pace < 1000U)
            pace = 1000U; /* the radio had no room: ask again in a moment */
        if (pace < wait)
            wait = pace;
    }
    return wait;
}
