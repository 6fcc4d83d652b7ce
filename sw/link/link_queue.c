/* SPDX-License-Identifier: MIT
 *
 * link_queue: holds the messages, openings and closings that wait to be cut into fragments.
 */
#include "link.h"

Link_Entry* link_entryAt(Link* link, U32 index) {
    return &link->entries[(link->queue.first + index) % LINK_SEND_MESSAGES];
}

/* Appends bytes to the newest entry, and continues its check. */
static void put(Link* link, const U8* data, U32 size) {
    Link_Queue* queue = &link->queue;
    queue->sums = link_sum(queue->sums, data, size);
    while (size--)
        link->queued[LINK_RING(queue->tail++)] = *data++;
}

/* Adds an entry for `size` bytes, which the caller puts in. Returns 0: there is no room. */
static Link_Entry* enqueue(Link* link, U32 flags, U32 size) {
    Link_Queue* queue = &link->queue;
    Link_Entry* entry;
    if (queue->count == LINK_SEND_MESSAGES || size + (size > link->longest ? LINK_RESERVE : 0U) >
                                                  LINK_SEND_BYTES - (queue->tail - queue->head)) {
        queue->wasFull = 1;
        return 0;
    }
    entry = link_entryAt(link, queue->count++);
    entry->size = (U16)size;
    entry->flags = (U8)flags;
    link->sender.hasWork = 1;
    return entry;
}

void link_queueClosings(Link* link) {
    int channel;
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if ((link->closeDue >> channel & 1) && enqueue(link, (U32)channel, 0))
            link->closeDue = (U8)(link->closeDue ^ 1U << channel);
}

void link_endEntry(Link* link, Link_Entry* entry, Link_Outcome outcome) {
    Link_Queue* queue = &link->queue;
    Link_Entry ended = *entry;
    entry->flags |= LINK_ENTRY_ENDED;
    while (queue->count && (link_entryAt(link, 0)->flags & LINK_ENTRY_ENDED)) {
        queue->head += link_entryAt(link, 0)->size;
        queue->first = (U8)((queue->first + 1U) % LINK_SEND_MESSAGES);
        --queue->count;
        --link->sender.cutEntry;
    }
    if (ended.size) { /* a message, not an opening or closing */
        link->statistics.messagesSent += outcome == LINK_DELIVERED;
        if (link->port->outcome)
            link->port->outcome(link->context, (int)LINK_CHANNEL(ended.flags), ended.tag, outcome);
    }
    if (queue->wasFull && outcome == LINK_DELIVERED) {
        queue->wasFull = 0;
        link_queueClosings(link);
        if (link->port->writable)
            link->port->writable(link->context);
    }
}

/* Returns whether the channel can be used, or, without `mustBeOpen`, can be opened. */
static Link_Status check(const Link* link, int channel, int mustBeOpen) {
    if (channel < 0 || channel >= LINK_CHANNELS)
        return LINK_CLOSED;
    if (link->state != LINK_STATE_UP)
        return LINK_DOWN;
    return mustBeOpen && !(link->open >> channel & 1) ? LINK_CLOSED : LINK_OK;
}

Link_Status Link_openChannel(Link* link, int channel) {
    Link_Status status = check(link, channel, 0);
    if (status != LINK_OK)
        return status;
    if (((link->closing | link->closeDue) >> channel & 1) ||
        !enqueue(link, LINK_FIRST | (U32)channel, 0))
        return LINK_FULL;
    link->open = (U8)(link->open | 1U << channel);
    return LINK_OK;
}

Link_Status Link_closeChannel(Link* link, int channel) {
    Link_Status status = check(link, channel, 1);
    if (status != LINK_OK)
        return status;
    if (!enqueue(link, (U32)channel, 0))
        link->closeDue = (U8)(link->closeDue | 1U << channel);
    link->open = (U8)(link->open ^ 1U << channel);
    link->closing = (U8)(link->closing | 1U << channel);
    return LINK_OK;
}

Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag) {
    Link_Queue* queue = &link->queue;
    Link_Status status = check(link, channel, 1);
    int isCompressed = link->session.features & LINK_FEATURE_COMPRESSION;
    Link_Packed packed;
    Link_Entry* entry;
    U8 trailer[LINK_CHECK];
    U32 total, checkSize;
    if (size == 0 || size > LINK_MAX_MESSAGE)
        return LINK_TOO_LONG;
    if (status != LINK_OK)
        return status;
    packed.prefix = packed.middle = packed.tailAt = 0;
    packed.tail = size;
    if (isCompressed)
        link_compress(link, channel, data, size, &packed);
    total = packed.prefix + packed.middle + packed.tail;
    checkSize = total > LINK_UNCHECKED && !LINK_IS_SECURE(link) ? LINK_CHECK : 0;
    entry = enqueue(link, LINK_FIRST | (U32)channel, total + checkSize);
    if (!entry)
        return LINK_FULL;
    entry->tag = tag;
    if (packed.middle)
        entry->flags |= LINK_ENTRY_LEARNS;
    queue->sums = 0;
    put(link, packed.bytes, packed.prefix);
    put(link, data + LINK_HEAD_AT, packed.middle);
    put(link, data + packed.tailAt, packed.tail);
    if (isCompressed) {
        link_note(&link->headsOut, channel, data, size, packed.head);
        link->statistics.headBytesSaved += size - total;
    }
    trailer[0] = (U8)queue->sums;
    trailer[1] = (U8)(queue->sums >> 8);
    put(link, trailer, checkSize);
    return LINK_OK;
}
