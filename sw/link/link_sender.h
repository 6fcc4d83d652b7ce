/* SPDX-License-Identifier: MIT
 *
 * link_sender: cuts queued messages into fragments, keeps a window of them in flight, and repeats
 * lost ones.
 */
#pragma once

#include "link_queue.h"
#include "link_receiver.h"

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
    Link_Fragment window[LINK_WINDOW];
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
