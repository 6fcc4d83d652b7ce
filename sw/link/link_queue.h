/* SPDX-License-Identifier: MIT
 *
 * link_queue: holds messages, openings and closings until they are delivered, and cuts them into
 * pieces for fragments: in their order, except that a short one may overtake a long one.
 */
#pragma once

#include "link_wire.h"

/* An entry; without bytes it opens (LINK_FIRST) or closes a channel. */
typedef struct Link_Entry {
    U32 tag;
    U16 size;
    U8 flags; /* LINK_FIRST, channel; and these: */
} Link_Entry;
#define LINK_ENTRY_LEARNS 4U /* the peer learns a head from it: it keeps its place */
#define LINK_ENTRY_AHEAD 8U  /* it has overtaken earlier entries */
#define LINK_ENTRY_ENDED 16U /* its outcome is known; it waits for earlier entries */

/* A part of an entry, for one fragment. */
typedef struct Link_Piece {
    U32 start;      /* in the queue's bytes */
    U8 size, flags; /* as in the frame */
    U8 entry;       /* of Link_Queue.entries */
} Link_Piece;

typedef struct Link_Queue {
    U8 first, count;
    U8 wasFull;     /* link_enqueue found no room */
    U8 isSummed;    /* the message that is being queued gets a check */
    U8 isAhead;     /* the newest piece has overtaken a long message */
    U8 cutEntry;    /* the next piece in order is of this entry, counted from `first`, ... */
    U16 cutBytes;   /* bytes of it that are cut already */
    U32 cutAt;      /* where that piece begins */
    U32 sums;       /* that check */
    U32 head, tail; /* byte counts, not reduced modulo LINK_SEND_BYTES */
    U32 mask;
    Link_Entry entries[LINK_SEND_MESSAGES];
    U8 bytes[LINK_SEND_BYTES]; /* a smaller link has mask + 1 of them, then its other memory */
} Link_Queue;

/* Adds an entry for `size` bytes, which the caller puts in. `longest`: bytes of one piece at most.
 * Returns 0: there is no room. */
Link_Entry* link_enqueue(Link_Queue* queue, U32 flags, U32 size, U32 longest);
/* Appends bytes to the newest entry, and continues its check. */
void link_put(Link_Queue* queue, const U8* data, U32 size);
/* Cuts the next piece, of at most `room` bytes, or of `reduced` where it is not a whole message;
 * with 0 for `reduced` only an entry that overtakes.
 * `overtaker`: bytes of an entry that may overtake, at most; 0: none may. Returns 0: all is cut. */
int link_cut(Link_Queue* queue, Link_Piece* piece, U32 room, U32 reduced, U32 overtaker);
/* Copies the bytes of a piece. */
void link_copy(const Link_Queue* queue, const Link_Piece* piece, U8* to);
/* Ends an entry, and removes all first ones that have ended. */
void link_dequeue(Link_Queue* queue, U32 entry);
/* Forgets the bytes of an empty queue. */
void link_rewind(Link_Queue* queue);
