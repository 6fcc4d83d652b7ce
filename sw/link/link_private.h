/* SPDX-License-Identifier: MIT
 *
 * link_private: the fields of a Link, and what the layer's files share. Included by link.h only.
 */
#ifndef LINK_PRIVATE_H
#define LINK_PRIVATE_H

#define LINK_OVERHEAD 5U
#define LINK_MAX_PAYLOAD 95U
#define LINK_VERSION 1U

/* Byte 0 and byte 2 of a frame. */
#define LINK_CONTROL 0x80U
#define LINK_FIRST 0x80U
#define LINK_LAST 0x40U
#define LINK_ACK_NOW 0x20U

typedef enum Link_Kind {
    LINK_KIND_ACK,
    LINK_KIND_HELLO,
    LINK_KIND_HELLO_ACK,
    LINK_KIND_RST,
    LINK_KIND_BYE,
    LINK_KIND_PING,
    LINK_KINDS
} Link_Kind;

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
#define LINK_FRAME_GAP 25000U /* silence on the serial side after which half a frame is dropped */

/* What identifies a session: both nonces, and what follows from them. */
typedef struct Link_Session {
    U32 nonce, peerNonce;
    U16 seed;
    U8 epoch;
} Link_Session;

typedef enum Link_ItemKind { LINK_ITEM_MESSAGE, LINK_ITEM_OPEN, LINK_ITEM_CLOSE } Link_ItemKind;

/* An entry of the send queue. */
typedef struct Link_Item {
    U32 start, size; /* in the byte ring */
    U32 tag;
    U8 channel, kind;
} Link_Item;

/* A fragment that was cut and is not acknowledged in order. */
typedef struct Link_Fragment {
    U32 start;                 /* in the byte ring */
    U32 sentAt;                /* last time */
    U32 firstOrder, lastOrder; /* numbers of its first and last transmission */
    U8 size, flags;            /* flags: F, L and CH */
    U8 transmissions;
    U8 acked, lost;
} Link_Fragment;

struct Link {
    const Link_Port* port;
    void* context;
    U32 byteTimeUs16;
    Link_State state;
    int wanted; /* Link_start was called */
    Link_Session session, candidate;
    int hasCandidate; /* a HELLO was answered, its sender has not confirmed yet */
    U32 helloNonce, helloAt, helloEvery;
    U32 heardAt, pingAt;

    /* sending */
    U8 queue[LINK_SEND_BYTES];
    U32 queueHead, queueUsed;
    Link_Item items[LINK_SEND_MESSAGES];
    U32 itemHead, itemCount;
    U32 cutItem, cutOffset; /* the next fragment comes from here: items after head, bytes */
    Link_Fragment window[64];
    U8 sendBase, sendNext; /* oldest unacknowledged, next new */
    U8 credit;
    U8 wasFull; /* Link_send said LINK_FULL */
    U32 order;  /* transmissions so far */
    U32 smoothed, variance, timeout, timerAt;
    int timerRuns, hasSample;
    U32 paceUntil; /* when the serial side will have sent everything handed over */

    /* receiving */
    U8 input[LINK_MAX_FRAME];
    U32 inputCount, inputAt;
    U8 slots[64][LINK_MAX_PAYLOAD];
    U8 slotSize[64], slotFlags[64], slotUsed[64];
    U8 receiveNext;
    U8 message[LINK_MAX_MESSAGE];
    U32 messageSize;
    int messageOpen, messageHeld; /* between F and L; whole, but not taken yet */
    U8 messageChannel;
    U8 open;             /* bit a channel, whoever opened it */
    U32 ackCount, ackAt; /* fragments since the last acknowledgement; when it is due */
    int ackDue, ackNow;

    Link_Statistics statistics;
};

/* frame */
U16 Link_crc(U16 seed, const U8* bytes, U32 size);
int Link_sendFrame(Link* link, U8* frame, U32 payload, U16 seed, U32 now);
int Link_sendControl(Link* link, Link_Kind kind, U8 byte1, const U8* payload, U32 size, U32 now);
int Link_isBefore(U32 a, U32 b);
U32 Link_get32(const U8* p);
void Link_put32(U8* p, U32 value);
void Link_parse(Link* link, int isEnd, U32 now);
U8 Link_controlBits(const Link_Session* session, Link_Kind kind);

/* session */
void Link_onHello(Link* link, const U8* frame, U32 now);
void Link_onHelloAck(Link* link, const U8* frame, U32 now);
void Link_onReset(Link* link, U8 epoch, U32 now);
void Link_confirmCandidate(Link* link, U32 now);
void Link_endSession(Link* link, Link_State next, U32 now);
void Link_pollSession(Link* link, U32 now);
U32 Link_sessionDeadline(const Link* link, U32 now);

/* send */
void Link_resetSend(Link* link);
void Link_dropQueue(Link* link);
void Link_onAck(Link* link, const U8* frame, U32 payload, U32 now);
void Link_pollSend(Link* link, U32 now);
U32 Link_sendDeadline(const Link* link, U32 now);

/* receive */
void Link_resetReceive(Link* link);
void Link_onData(Link* link, const U8* frame, U32 payload, U32 now);
void Link_deliverHeld(Link* link, U32 now);
int Link_sendAck(Link* link, U32 now);
void Link_pollReceive(Link* link, U32 now);
U32 Link_receiveDeadline(const Link* link, U32 now);

#endif
