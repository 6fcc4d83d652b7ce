/* SPDX-License-Identifier: MIT
 *
 * link_private: the fields of a Link, and what the layer's files share. Included by link.h only.
 */
#ifndef LINK_PRIVATE_H
#define LINK_PRIVATE_H

#include "link_wire.h"

/* Payload of the longest frame that is sent. */
#define LINK_LONGEST(link) (LINK_LIMIT ? (U32)(link)->longest : LINK_MAX_PAYLOAD)

#define LINK_FEATURES \
    ((LINK_HEADS ? LINK_FEATURE_HEADS : 0U) | (LINK_RIDE ? LINK_FEATURE_RIDE : 0U))

/* Times in microseconds. */
#define LINK_ACK_DELAY 20000U    /* an acknowledgement waits this long for company */
#define LINK_ACK_EVERY 8U        /* or for so many fragments */
#define LINK_HELLO_FIRST 300000U /* between HELLOs, doubled up to ... */
#define LINK_HELLO_LAST 2000000U
#define LINK_PING_AFTER 5000000U /* silence after which the peer is asked, ... */
#define LINK_PING_EVERY 1000000U /* again, ... */
#define LINK_DEAD_AFTER 9000000U /* and given up */
#define LINK_RTO_FIRST 600000U
#define LINK_RTO_MIN 60000U
#define LINK_RTO_MAX 2000000U
#define LINK_FRAME_GAP 25000U  /* silence on the serial side after which half a frame is dropped */
#define LINK_POLL_EVERY 1000U  /* while the radio has no room */
#define LINK_OFFER_EVERY 5000U /* while nobody takes a message */

#define LINK_SLACK(link) \
    (LINK_MAX_FRAME * (link)->byteTimeUs16 >> 4) /* time of the longest frame */
#define LINK_SLOT(seq) ((seq) & (LINK_WINDOW - 1U))
#define LINK_COUNT(link, counter, by) \
    ((void)(LINK_STATISTICS && ((link)->statistics.counter += (by)) != 0))

#define LINK_HEAD_SLOTS 16U
#define LINK_HEAD_BYTES 64U                    /* of one: up to 62, and the encoding's version */
#define LINK_HEAD_ROOM (LINK_HEADS ? 96U : 0U) /* what may grow in front of a message */
#define LINK_ESCAPE (LINK_HEADS ? 1U : 0U)     /* a byte that marks what is not Ice */

#define LINK_INPUT_BYTES (LINK_WINDOW > 1U ? 2U * LINK_MAX_FRAME : LINK_MAX_FRAME)

/* What must hold for the options of link.h; a negative size stops the compiler. */
typedef char
    Link_Check[LINK_WINDOW >= 1U && LINK_WINDOW <= 64U && !(LINK_WINDOW & (LINK_WINDOW - 1U)) &&
                       !(LINK_SEND_BYTES & (LINK_SEND_BYTES - 1U)) && LINK_SEND_BYTES <= 32768U &&
                       LINK_SEND_BYTES > LINK_MAX_MESSAGE&& LINK_MAX_MESSAGE <= 32000U &&
                       LINK_SEND_MESSAGES >= 1U && LINK_SEND_MESSAGES <= 128U
                   ? 1
                   : -1];

/* What identifies a session: both nonces, and what follows from them. */
typedef struct Link_Session {
    U32 nonce, peerNonce;
    U16 seed;
    U8 epoch, features; /* of both sides */
} Link_Session;

/* An entry of the send queue; without bytes it opens (LINK_FIRST) or closes a channel. */
typedef struct Link_Item {
    U32 tag;
    U16 size;
    U8 flags; /* LINK_FIRST, CH */
} Link_Item;

enum { LINK_TO_SEND, LINK_SENT, LINK_ACKED };

/* A fragment that was cut and is not acknowledged in order. */
typedef struct Link_Fragment {
    U32 start;  /* in the byte ring */
    U32 sentAt; /* last time */
    U32 order;  /* number of its last transmission */
    U8 size, flags;
    U8 tries; /* 0, 1, more */
    U8 state;
} Link_Fragment;

/* Heads that have passed in one direction. */
typedef struct Link_Heads {
    U32 lastRequest[LINK_CHANNELS], lastReply[LINK_CHANNELS];
    U8 next; /* slot that the next new one takes */
    U8 size[LINK_HEAD_SLOTS];
    U8 head[LINK_HEADS ? LINK_HEAD_SLOTS : 1U][LINK_HEAD_BYTES];
} Link_Heads;

/* A message as it goes out: bytes[0..prefix), `middle` bytes of its head, the rest from tailAt. */
typedef struct Link_Packed {
    U8 bytes[8];
    U32 prefix, middle, tailAt, tail;
} Link_Packed;

/* Small and often used fields first: a Cortex-M3 reaches them with short instructions. */
struct Link {
    U8 state;        /* Link_State */
    U8 wanted;       /* Link_start was called */
    U8 hasCandidate; /* a HELLO was answered, its sender has not confirmed yet */
    U8 inputCount;
    U8 longest;            /* Link_limitFrame's, without the overhead */
    U8 outOfStep;          /* no frame where one should begin: the next one needs confirmation */
    U8 sendBase, sendNext; /* oldest unacknowledged, next new */
    U8 credit, fullCredit; /* the peer's: now, and the most it gave */
    U8 work;               /* there may be something to send */
    U8 wasFull;            /* Link_send said LINK_FULL */
    U8 itemHead, itemCount, cutItem; /* the next fragment comes from cutItem, after the head */
    U8 hasSample;
    U8 receiveNext;
    U8 messageOpen, messageHeld; /* between F and L; whole, but not taken yet */
    U8 messageChannel;
    U8 open;                     /* bit a channel: messages may be sent */
    U8 closing;                  /* closed here, the peer's closing has not come yet */
    U8 closeDue;                 /* closed by the peer, our closing is not queued yet */
    U8 check[2];                 /* sums of the message being queued */
    U8 ackDue, ackNow, ackCount; /* ackCount: fragments since the last acknowledgement */
    U16 cutBegun;                /* bytes of cutItem that were cut */
    U16 messageSize;
    U32 now;
    const Link_Port* port;
    void* context;
    U32 byteTimeUs16;
    U32 helloNonce, helloAt, helloEvery;
    U32 heardAt, pingAt;
    U32 paceUntil; /* when the serial side will have sent everything handed over */
    U32 timeout, timerAt, smoothed, variance;
    U32 order;                       /* transmissions so far */
    U32 queueHead, queueTail, cutAt; /* in the byte ring, never reduced */
    U32 inputAt, ackAt;
    U8* messageStart;
    Link_Session session, candidate;
    Link_Statistics statistics;

    Link_Item items[LINK_SEND_MESSAGES];
    Link_Fragment window[LINK_WINDOW];
    U8 input[LINK_INPUT_BYTES];
    U8 slotSize[LINK_WINDOW], slotFlags[LINK_WINDOW], slotUsed[LINK_WINDOW];
    U8 slots[LINK_WINDOW > 1U ? LINK_WINDOW : 1U][LINK_MAX_PAYLOAD];
    Link_Heads headsOut, headsIn;
    U8 message[LINK_HEAD_ROOM + LINK_MAX_MESSAGE + LINK_ESCAPE + LINK_CHECK];
    U8 queue[LINK_SEND_BYTES];
};

/* frame */
int Link_sendFrame(Link* link, U8* frame, U32 payload, U16 seed);
int Link_sendControl(Link* link, U8* frame, Link_Kind kind, U32 byte1, U32 size);
void Link_pollInput(Link* link);

/* session */
void Link_onHandshake(Link* link, const U8* frame, Link_Kind kind);
void Link_confirmCandidate(Link* link);
void Link_endSession(Link* link, Link_State next);
void Link_lose(Link* link);
void Link_abort(Link* link);
void Link_pollSession(Link* link);

/* send */
void Link_resetSend(Link* link);
void Link_put(Link* link, const U8* data, U32 size);
void Link_onAck(Link* link, U32 cumulative, U32 credit, U32 bitmap);
void Link_pollSend(Link* link);

/* receive */
void Link_resetReceive(Link* link);
void Link_onData(Link* link, U32 seq, U32 flags, const U8* data, U32 size);
int Link_ackMayRide(const Link* link);
void Link_ackIsSent(Link* link);
void Link_pollReceive(Link* link);
void Link_pollAck(Link* link);

/* head */
void Link_resetHeads(Link* link);
void Link_packHead(const Link* link, int channel, const U8* m, U32 size, Link_Packed* packed);
void Link_putPacked(Link* link, int channel, const U8* m, U32 size, const Link_Packed* packed);
int Link_unpackHead(Link* link); /* 0: it makes no sense */

#endif
