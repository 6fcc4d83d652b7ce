/* SPDX-License-Identifier: MIT
 *
 * link_sender: queues messages, cuts them into fragments, keeps a window of fragments in flight,
 * and sends lost fragments again.
 */
#pragma once

#include "link_queue.h"
#include "link_receiver.h"

typedef enum Link_FragmentState { LINK_TO_SEND, LINK_SENT, LINK_ACKED } Link_FragmentState;

/* A fragment in the window. A fragment stays in the window until it and all earlier fragments have
 * been acknowledged. */
typedef struct Link_Fragment {
    Link_Chunk chunk;
    U32 firstAt, sentAt; /* times of the first and last transmission, us */
    U32 order;           /* number of its last transmission, as counted by Link_Sender.order */
    U8 tries;            /* number of its transmissions: 0, 1, or 2 for two and more */
    U8 state;            /* state, a Link_FragmentState */
    /* number of the packet that contained its last transmission, as counted by Link_Pacing.handed
     */
    U8 packet;
} Link_Fragment;

typedef struct Link_Sender {
    Link_Pacing* pacing;
    /* receiver of the same link; its acknowledgements may be sent together with fragments */
    Link_Receiver* receiver;
    Link_Fragment* window; /* window of fragments, owned by the caller */
    U8 mask;               /* number of fragments in the window minus 1 */
    /* The following fields are 0 when a session begins. */
    U8 credit;     /* number of fragments that may be in flight now */
    U8 fullCredit; /* largest credit so far */
    U8 hasWork;    /* 1: there may be something to send */
    U8 isLossy;    /* 1: fragments were missing according to the newest acknowledgement */
    U8 isLate;     /* 1: the timer has expired since the last acknowledgement */
    /* number of transmissions since the last acknowledgement arrived or was requested */
    U8 unasked;
    U8 hasSample; /* 1: srtt and rttvar are valid */
    U32 base;     /* number of the oldest unacknowledged fragment; its lowest byte is SEQ */
    U32 next;     /* number of the next new fragment */
    U32 ahead;    /* number of the newest fragment that has overtaken */
    /* rto: time-out; srtt and rttvar: smoothed round trip and its variation, as in RFC 6298; us */
    U32 rto, srtt, rttvar;
    U32 timerAt;            /* time at which the retransmission timer expires, us */
    U32 order;              /* number of transmissions so far */
    Link_HeaderCache heads; /* headers of sent messages, for compression */
    /* End of the fields that are 0 when a session begins. */
    Link_Queue queue;
} Link_Sender;

/* Resets the sender to its state without a session: reports queued messages as LINK_UNKNOWN, and
 * wipes their bytes if `isWiped` is not 0. */
void link_resetSender(Link_Sender* sender, int isWiped);

/* Queues an opening (LINK_FIRST) or a closing of a channel. Returns 0 if the queue has no room. */
int link_queueChannel(Link_Sender* sender, U32 flags);

/* Queues a copy of a message. Returns LINK_OK, LINK_FULL or LINK_TOO_LONG. */
Link_Status link_queueMessage(Link_Sender* sender, int channel, const U8* data, U32 size, U32 tag);

/* Processes an acknowledgement: number, credit, and a bitmap of `size` bytes as in the frame.
 * Returns whether at least one fragment is acknowledged for the first time. */
int link_onAck(Link_Sender* sender, U32 cumulative, U32 credit, const U8* bitmap, U32 size);

/* Processes the radio's result for a packet. The contents of a lost packet are sent again. */
void link_onAnswer(Link_Sender* sender, U32 packet, int isDelivered);

/* Sends the fragments that are due. Returns 0 if a fragment is so old that the session must end. */
int link_pollSender(Link_Sender* sender);
