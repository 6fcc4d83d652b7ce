/* SPDX-License-Identifier: MIT
 *
 * link_sender: cuts queued messages into fragments, keeps a window of them in flight, and repeats
 * lost ones. link_queue holds messages, openings and closings until they are delivered, and cuts
 * them into pieces for fragments: in their order, except that a short one may overtake a long one.
 */
#pragma once

#include "link_receiver.h"

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

typedef enum Link_FragmentState { LINK_TO_SEND, LINK_SENT, LINK_ACKED } Link_FragmentState;

/* A fragment that was cut from the queue, until it is acknowledged in order. */
typedef struct Link_Fragment {
    Link_Piece piece;
    U32 firstAt, sentAt; /* times of its first and its last transmission */
    U32 order;           /* number of its last transmission */
    U8 tries;            /* 0, 1, more */
    U8 state;            /* Link_FragmentState */
    U8 packet;           /* of its last transmission, as Link_Output.handed counts */
} Link_Fragment;

typedef struct Link_Sender {
    Link_Output* output;
    Link_Receiver* receiver; /* its acknowledgements ride on fragments */
    Link_Fragment* window;
    U8 mask; /* fragments in the window less one */
    /* The fields from here on are 0 when a session begins. */
    U8 credit, fullCredit; /* fragments that may be in flight: now, and at most so far */
    U8 hasWork;            /* there may be something to send */
    U8 isLossy;            /* the newest acknowledgement had gaps */
    U8 isLate;             /* the timer has expired since the last answer */
    U8 unasked;   /* transmissions since the last request for an acknowledgement, or the last one */
    U8 hasSample; /* srtt and rttvar are valid */
    U32 base, next;        /* numbers whose lowest byte is SEQ: oldest unacknowledged, next new */
    U32 ahead;             /* number of the newest fragment that has overtaken */
    U32 rto, srtt, rttvar; /* microseconds, as RFC 6298 names them */
    U32 timerAt;           /* when the retransmission timer expires */
    U32 order;             /* transmissions so far */
    Link_Heads heads;      /* of messages that were sent */
    /* End of the fields that begin at 0. */
    Link_Queue queue;
} Link_Sender;

/* Adds an entry to the queue, and work to the sender. Returns 0: there is no room. */
Link_Entry* link_offer(Link_Sender* sender, U32 flags, U32 size);
void link_resetSender(Link_Sender* sender);
/* `bitmap` has `size` bytes, as in the frame. */
void link_onAck(Link_Sender* sender, U32 cumulative, U32 credit, const U8* bitmap, U32 size);
/* Takes the radio's answer for a packet: what was in one that is lost goes out again. */
void link_onAnswer(Link_Sender* sender, U32 packet, int isDelivered);
/* Sends fragments that are due. Returns 0: one is so old that the session must end. */
int link_pollSender(Link_Sender* sender);
