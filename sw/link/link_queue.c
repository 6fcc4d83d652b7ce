/* SPDX-License-Identifier: MIT
 *
 * link_queue: a ring of entries and a ring of their bytes.
 */
#include "link_sender.h"

static Link_Entry* entryAt(Link_Queue* queue, U32 index) {
    return &queue->entries[(queue->first + index) % LINK_SEND_MESSAGES];
}

Link_Entry* link_enqueue(Link_Queue* queue, U32 flags, U32 size, U32 longest) {
    Link_Entry* entry;
    if (queue->count == LINK_SEND_MESSAGES || size + (size > longest ? LINK_RESERVE : 0U) >
                                                  queue->mask + 1U - (queue->tail - queue->head)) {
        queue->wasFull = 1;
        return 0;
    }
    entry = entryAt(queue, queue->count++);
    entry->size = (U16)size;
    entry->flags = (U8)flags;
    return entry;
}

void link_put(Link_Queue* queue, const U8* data, U32 size) {
    U32 mask = queue->mask;
    if (queue->isSummed)
        queue->sums = link_sum(queue->sums, data, size);
    while (size--)
        queue->bytes[queue->tail++ & mask] = *data++;
}

void link_copy(const Link_Queue* queue, const Link_Piece* piece, U8* to) {
    U32 at = piece->start;
    U32 size = piece->size;
    U32 mask = queue->mask;
    while (size--)
        *to++ = queue->bytes[at++ & mask];
}

void link_dequeue(Link_Queue* queue, U32 entry) {
    Link_Entry* first;
    queue->entries[entry].flags |= LINK_ENTRY_ENDED;
    while (queue->count && ((first = entryAt(queue, 0))->flags & LINK_ENTRY_ENDED)) {
        queue->head += first->size;
        queue->first = (U8)((queue->first + 1U) % LINK_SEND_MESSAGES);
        --queue->count;
        --queue->cutEntry;
    }
}

void link_rewind(Link_Queue* queue) {
    queue->cutAt = queue->tail = queue->head;
    queue->cutEntry = queue->isAhead = 0;
    queue->cutBytes = 0;
}

/* Finds an entry of at most `most` bytes that may overtake the present long message: on another
 * channel than all that it overtakes, in the order of the heads that the peer learns, and never two
 * in a row. Sets `start` to the place of its bytes. Returns 0: none. */
static Link_Entry* findAhead(Link_Queue* queue, U32 most, U32* start) {
    Link_Entry* entry = entryAt(queue, queue->cutEntry);
    U32 channels = 0;
    U32 i;
    if (queue->isAhead || !most || entry->size - queue->cutBytes <= (int)most)
        return 0;
    *start = queue->cutAt - queue->cutBytes;
    for (i = queue->cutEntry; !(entry->flags & LINK_ENTRY_LEARNS);) {
        if (!(entry->flags & LINK_ENTRY_AHEAD))
            channels |= 1U << LINK_CHANNEL(entry->flags);
        *start += entry->size;
        if (++i == queue->count)
            break;
        entry = entryAt(queue, i);
        if (entry->size <= most && !(entry->flags & (LINK_ENTRY_AHEAD | LINK_ENTRY_LEARNS)) &&
            !(channels >> LINK_CHANNEL(entry->flags) & 1U))
            return entry;
    }
    return 0;
}

int link_cut(Link_Queue* queue, Link_Piece* piece, U32 room, U32 reduced, U32 overtaker) {
    Link_Entry* entry;
    U32 left;
    if (queue->cutEntry == queue->count)
        return 0;
    entry = findAhead(queue, overtaker, &piece->start);
    if (!entry && !reduced)
        return 0;
    queue->isAhead = entry != 0;
    if (entry) {
        entry->flags |= LINK_ENTRY_AHEAD;
        left = room = entry->size;
        piece->flags = entry->flags & (LINK_FIRST | 3U);
    } else {
        entry = entryAt(queue, queue->cutEntry);
        left = entry->size - queue->cutBytes;
        piece->start = queue->cutAt;
        piece->flags = entry->flags & (queue->cutBytes ? 3U : LINK_FIRST | 3U);
        if (queue->cutBytes || left >= room)
            room = reduced;
        if (room > left)
            room = left;
        queue->cutAt += room;
        queue->cutBytes = (U16)(queue->cutBytes + room);
    }
    piece->size = (U8)room;
    piece->entry = (U8)(entry - queue->entries);
    if (left != room)
        return 1;
    piece->flags |= LINK_LAST;
    if (queue->isAhead)
        return 1;
    queue->cutBytes = 0;
    while (++queue->cutEntry < queue->count &&
           ((entry = entryAt(queue, queue->cutEntry))->flags & LINK_ENTRY_AHEAD))
        queue->cutAt += entry->size;
    return 1;
}
