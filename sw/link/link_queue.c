/* SPDX-License-Identifier: MIT
 *
 * link_queue: implements the queue as a ring of entries and a ring with the bytes of these entries.
 */
#include "link_queue.h"

#include <string.h>

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

void link_copy(const Link_Queue* queue, const Link_Chunk* chunk, U8* to) {
    U32 at = chunk->start;
    U32 size = chunk->size;
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

int link_wasFull(Link_Queue* queue) {
    int wasFull = queue->wasFull;
    queue->wasFull = 0;
    return wasFull;
}

void link_rewind(Link_Queue* queue, int isWiped) {
    queue->cutAt = queue->tail = queue->head;
    queue->cutEntry = queue->isAhead = 0;
    queue->cutBytes = 0;
    if (isWiped)
        memset(queue->bytes, 0, queue->mask + 1U);
}

/* Finds an entry that may overtake the current long message, and sets `start` to the offset of the
 * entry's bytes. The entry must satisfy four conditions. It has at most `most` bytes. Its channel
 * differs from the channels of all entries that it overtakes. It does not overtake a header that
 * the peer must learn first. The chunk that was cut last does not belong to an entry that has
 * overtaken. Returns 0 if no such entry exists. */
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

int link_cut(Link_Queue* queue, Link_Chunk* chunk, U32 room, U32 reduced, U32 overtaker) {
    Link_Entry* entry;
    U32 left;
    entry = findAhead(queue, overtaker, &chunk->start);
    if (!entry && !reduced)
        return 0;
    queue->isAhead = entry != 0;
    if (entry) {
        entry->flags |= LINK_ENTRY_AHEAD;
        left = room = entry->size;
        chunk->flags = entry->flags & (LINK_FIRST | 3U);
    } else {
        entry = entryAt(queue, queue->cutEntry);
        left = entry->size - queue->cutBytes;
        chunk->start = queue->cutAt;
        chunk->flags = entry->flags & (queue->cutBytes ? 3U : LINK_FIRST | 3U);
        if (queue->cutBytes || left >= room)
            room = reduced;
        if (room > left)
            room = left;
        queue->cutAt += room;
        queue->cutBytes = (U16)(queue->cutBytes + room);
    }
    chunk->size = (U8)room;
    chunk->entry = (U8)(entry - queue->entries);
    if (left != room)
        return 1;
    chunk->flags |= LINK_LAST;
    if (queue->isAhead)
        return 1;
    queue->cutBytes = 0;
    while (++queue->cutEntry < queue->count &&
           ((entry = entryAt(queue, queue->cutEntry))->flags & LINK_ENTRY_AHEAD))
        queue->cutAt += entry->size;
    return 1;
}
