/* SPDX-License-Identifier: MIT
 *
 * link_queue: holds outgoing messages, openings and closings until they are delivered, and cuts
 * them into chunks for fragments. They leave in their order, except that a short one may overtake a
 * long one.
 */
#pragma once

#include "link_frame.h"

/* A message; without bytes an entry opens (LINK_FIRST) or closes a channel. */
typedef struct Link_Entry {
    U32 tag;  /* Link_send's */
    U16 size; /* bytes */
    U8 flags; /* LINK_FIRST, channel, LINK_ENTRY_... */
} Link_Entry;
#define LINK_ENTRY_LEARNS 4U /* the peer learns a header from it: it must stay in order */
#define LINK_ENTRY_AHEAD 8U  /* it has overtaken earlier entries */
#define LINK_ENTRY_ENDED 16U /* its outcome is known; it waits for earlier entries */

/* Part of an entry, for one fragment. */
typedef struct Link_Chunk {
    U32 start; /* offset in the queue's bytes */
    U8 size;   /* bytes */
    U8 flags;  /* flags, as in the frame */
    U8 entry;  /* index in Link_Queue.entries */
} Link_Chunk;

typedef struct Link_Queue {
    U8 first, count; /* index of the oldest entry; number of entries */
    U8 wasFull;      /* 1: link_enqueue found no room */
    U8 isSummed;     /* 1: the newest message gets a check */
    U8 isAhead;      /* 1: the newest chunk has overtaken a long message */
    U8 cutEntry;     /* entry of the next chunk in order, counted from `first` */
    U16 cutBytes;    /* bytes of that entry that are cut already */
    U32 cutAt;       /* offset of that chunk */
    U32 sums;        /* check of the newest message so far */
    U32 head, tail;  /* bytes removed and added so far, not reduced modulo the buffer's size */
    U32 mask;        /* size of the buffer less one */
    U8* bytes;       /* the caller's buffer */
    Link_Entry entries[LINK_SEND_MESSAGES];
} Link_Queue;

/* Prepares a zeroed queue with a buffer of `size` bytes, a power of two. */
#define LINK_INIT_QUEUE(queue, buffer, size) \
    ((queue)->bytes = (buffer), (queue)->mask = (size) - 1U)

/* Adds an entry for `size` bytes, which the caller appends. `longest`: largest chunk, bytes.
 * Returns 0 without room. */
Link_Entry* link_enqueue(Link_Queue* queue, U32 flags, U32 size, U32 longest);

/* Begins the bytes of the newest entry. `isSummed`: link_put computes its check. */
#define LINK_BEGIN_ENTRY(queue, summed) ((queue)->sums = 0, (queue)->isSummed = (U8)(summed))

/* Appends bytes to the newest entry, and continues its check. */
void link_put(Link_Queue* queue, const U8* data, U32 size);

/* Cuts the next chunk: a whole entry if it is shorter than `room` bytes, otherwise at most
 * `reduced` bytes. If `reduced` is 0, only an entry that overtakes is cut. `overtaker`: largest
 * entry that may overtake, bytes; 0 disables overtaking. Returns 0 if nothing was cut. */
int link_cut(Link_Queue* queue, Link_Chunk* chunk, U32 room, U32 reduced, U32 overtaker);

/* Copies the bytes of a chunk. */
void link_copy(const Link_Queue* queue, const Link_Chunk* chunk, U8* to);

/* Ends an entry, and removes the oldest entries that have ended. */
void link_dequeue(Link_Queue* queue, U32 entry);

/* Returns whether link_enqueue has found no room since the last call. */
int link_wasFull(Link_Queue* queue);

/* Forgets the bytes of an empty queue, and wipes them if `isWiped`. */
void link_rewind(Link_Queue* queue, int isWiped);
