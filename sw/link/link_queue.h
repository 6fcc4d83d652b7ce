/* SPDX-License-Identifier: MIT
 *
 * link_queue: holds outgoing messages, openings and closings until they are delivered, and cuts
 * them into chunks for fragments. Messages leave in the order in which they were queued, except
 * that a short message may overtake a long one.
 */
#pragma once

#include "link_frame.h"

/* An entry of the queue: a message; or without bytes, the opening (LINK_FIRST) or closing of a
 * channel. */
typedef struct Link_Entry {
    U32 tag;  /* Link_send's */
    U16 size; /* bytes */
    U8 flags; /* flags: LINK_FIRST, the channel, and the LINK_ENTRY_... below */
} Link_Entry;
/* the peer learns a header from this message, so no message may overtake it */
#define LINK_ENTRY_LEARNS 4U
#define LINK_ENTRY_AHEAD 8U /* this message has overtaken earlier entries */
/* the outcome of this entry is known; the entry is removed when all earlier entries have been
 * removed */
#define LINK_ENTRY_ENDED 16U

/* A part of an entry that fits into one fragment. */
typedef struct Link_Chunk {
    U32 start; /* offset of the chunk in the queue's bytes */
    U8 size;   /* bytes */
    U8 flags;  /* flags, as in the frame */
    U8 entry;  /* index of the entry in Link_Queue.entries */
} Link_Chunk;

typedef struct Link_Queue {
    U8 first, count; /* index of the oldest entry; number of entries */
    U8 wasFull;      /* 1: link_enqueue has failed because the queue was full */
    U8 isSummed;     /* 1: link_put computes a check of the newest message */
    U8 isAhead;      /* 1: the newest chunk has overtaken a long message */
    /* entry from which the next chunk in order will be cut, counted from `first` */
    U8 cutEntry;
    U16 cutBytes; /* number of bytes of this entry that have been cut already */
    U32 cutAt;    /* offset of the next chunk in the queue's bytes */
    U32 sums;     /* check of the newest message so far */
    /* number of bytes removed and added so far, not reduced modulo the buffer's size */
    U32 head, tail;
    U32 mask;  /* size of the buffer minus 1 */
    U8* bytes; /* buffer, owned by the caller */
    Link_Entry entries[LINK_SEND_MESSAGES];
} Link_Queue;

/* Initialises a zeroed queue with a buffer of `size` bytes, a power of two. */
#define LINK_INIT_QUEUE(queue, buffer, size) \
    ((queue)->bytes = (buffer), (queue)->mask = (size) - 1U)

/* Adds an entry for `size` bytes; the caller must then append these bytes. `longest` is the size of
 * the largest chunk, bytes. Returns 0 if the queue is full. */
Link_Entry* link_enqueue(Link_Queue* queue, U32 flags, U32 size, U32 longest);

/* Begins to append bytes to the newest entry. If `summed` is 1, link_put computes the check of the
 * message. */
#define LINK_BEGIN_ENTRY(queue, summed) ((queue)->sums = 0, (queue)->isSummed = (U8)(summed))

/* Appends bytes to the newest entry, and updates its check. */
void link_put(Link_Queue* queue, const U8* data, U32 size);

/* Returns whether nothing is left to cut. */
#define LINK_IS_ALL_CUT(queue) ((queue)->cutEntry == (queue)->count)

/* Cuts the next chunk of a queue in which something is left to cut: a whole entry if the entry is
 * shorter than `room` bytes, otherwise at most `reduced` bytes of it. If `reduced` is 0, cuts only
 * an entry that overtakes others. `overtaker` is the size of the largest entry that may overtake,
 * bytes; 0 disables overtaking. Returns 0 if nothing was cut. */
int link_cut(Link_Queue* queue, Link_Chunk* chunk, U32 room, U32 reduced, U32 overtaker);

/* Copies the bytes of a chunk to `to`. */
void link_copy(const Link_Queue* queue, const Link_Chunk* chunk, U8* to);

/* Marks an entry as ended, and removes the oldest entries if they have ended. */
void link_dequeue(Link_Queue* queue, U32 entry);

/* Returns whether link_enqueue had no room since the last call of this function. */
int link_wasFull(Link_Queue* queue);

/* Resets the offsets of an empty queue; wipes its bytes if `isWiped` is not 0. */
void link_rewind(Link_Queue* queue, int isWiped);
