/* SPDX-License-Identifier: MIT
 *
 * link_private: defines a Link, and declares the functions that the layer's files share, from the
 * bottom to the top. A file calls only functions above its own here. Only link.h includes it.
 */
#ifndef LINK_PRIVATE_H
#define LINK_PRIVATE_H

#include "link_wire.h"

#define LINK_FEATURES (LINK_FEATURE_COMPRESSION | LINK_FEATURE_PIGGYBACK)

/* Rounds of Ascon that the search may spend on a frame. */
#define LINK_ROUNDS_HELLO 48U /* under the keys of both slots */
#define LINK_ROUNDS_HANDSHAKE 136U
#define LINK_ROUNDS_OF(payload) (24U + (payload) / 2U)

/* True once a key was given, for good. */
#define LINK_IS_SECURE(link) (LINK_SECURE && (link)->overhead != LINK_OVERHEAD)

#define LINK_ACK_ROOM(link) \
    ((link)->overhead + 1U + LINK_BITMAP) /* bytes of the longest acknowledgement */

/* The peer's credit in fragments, until its first frame gives it. */
#define LINK_LEAST_WINDOW 8U

#define LINK_SLOT(seq) ((seq) & (LINK_WINDOW - 1U))

#define LINK_HEAD_AT 18U    /* start of the head in a request: behind header and request id */
#define LINK_HEADS 16U      /* request heads that each direction keeps */
#define LINK_HEAD_BYTES 64U /* of one: up to 62, and the encoding's version */
#define LINK_HEAD_ROOM 96U  /* bytes that decompression may add in front of a message */
#define LINK_ESCAPE 1U      /* a byte that marks messages other than Ice's */

/* The identity of a session: both nonces, and the values that follow from them. */
typedef struct Link_Session {
    U8 nonce[LINK_NONCE_BYTES],
        peerNonce[LINK_NONCE_BYTES]; /* only the first four bytes without a key */
    U32 key;
    U8 features; /* features of both sides */
    U8 slot;     /* of the key that the session was made with */
    Link_Keys keys;
} Link_Session;

typedef struct Link_Handshake {
    U8 nonce[LINK_NONCE_BYTES]; /* own, of the next session */
    U32 helloAt, helloEvery;
    Link_Session candidate; /* of a HELLO that was answered; its sender has not confirmed it yet */
    U8 hasCandidate;
    U8 slot;          /* with a key: that of the last HELLO */
    U8 isAnswered;    /* a HELLO was answered with `nonce`, ... */
    U8 isUnconfirmed; /* the peer may not know of the session yet */
    U32 firstAnswer;  /* ... first at this time, ... */
    U32 lastAnswer;   /* last at this one */
} Link_Handshake;

/* The watch notes what a session with a key has seen. */
typedef struct Link_Watch {
    U32 pingsSent, pingsAnswered; /* numbers of the newest own PING, and up to which that is over */
    U32 askedAt;                  /* when the first PING after that was sent */
    U32 pingsSeen;                /* number of the peer's newest PING */
    U32 provenAt;                 /* the last answer proves that the peer lived then or later */
    U32 failures;                 /* frames whose tag was wrong */
} Link_Watch;

/* An entry of the send queue; without bytes it opens (LINK_FIRST) or closes a channel. */
typedef struct Link_Entry {
    U32 tag;
    U16 size;
    U8 flags; /* LINK_FIRST, channel; and these: */
} Link_Entry;
#define LINK_ENTRY_LEARNS 4U /* the peer learns a head from it: it keeps its place */
#define LINK_ENTRY_AHEAD 8U  /* it has overtaken earlier entries */
#define LINK_ENTRY_ENDED 16U /* its outcome is known; it waits for earlier entries */

typedef struct Link_Queue {
    U8 first, count;
    U8 wasFull;     /* Link_send said LINK_FULL */
    U32 sums;       /* check of the message that is being queued */
    U32 head, tail; /* byte counts, not reduced modulo LINK_SEND_BYTES */
} Link_Queue;

typedef enum Link_FragmentState { LINK_TO_SEND, LINK_SENT, LINK_ACKED } Link_FragmentState;

/* A fragment that was cut from the queue, until it is acknowledged in order. */
typedef struct Link_Fragment {
    U32 start;  /* in the queue's bytes */
    U32 sentAt; /* time of its last transmission */
    U32 order;  /* number of its last transmission */
    U8 size, flags;
    U8 tries; /* 0, 1, more */
    U8 state; /* Link_FragmentState */
    U8 entry; /* the one of Link.entries that it was cut from */
} Link_Fragment;

typedef struct Link_Sender {
    U32 base, next;        /* numbers whose lowest byte is SEQ: oldest unacknowledged, next new */
    U8 credit, fullCredit; /* fragments that may be in flight: now, and at most so far */
    U8 hasWork;            /* there may be something to send */
    U8 isLossy;            /* the newest acknowledgement had gaps */
    U8 isLate;             /* the timer has expired since the last answer */
    U8 unasked;   /* transmissions since the last request for an acknowledgement, or the last one */
    U8 hasSample; /* srtt and rttvar are valid */
    U8 isAhead;   /* the newest fragment has overtaken a long message */
    U8 cutEntry;  /* the next fragment in order is of this entry of the queue, ... */
    U16 cutBytes; /* bytes of it that are cut already */
    U32 cutAt;    /* in the queue's bytes */
    U32 rto, srtt, rttvar; /* microseconds, as RFC 6298 names them */
    U32 fastest;           /* round trip of the session */
    U32 timerAt;           /* when the retransmission timer expires */
    U32 order;             /* transmissions so far */
} Link_Sender;

typedef struct Link_Receiver {
    U32 next;        /* number expected */
    U8 isAssembling; /* between F and L */
    U8 isHeld;       /* the message is whole, but the program has not taken it */
    U8 channel;      /* of the message that is whole, ... */
    U8 longChannel;  /* and of the long one that is being put together */
    U8 ackDue, ackNow;
    U8 waiting; /* slots in use */
    U16 size;   /* of the two, as channel */
    U16 longSize;
    U32 ackAt;
    U8* start; /* of the whole message */
} Link_Receiver;

/* A fragment that arrived before its turn. */
typedef struct Link_Slot {
    U8 isUsed, size, flags;
    U8 bytes[LINK_MAX_PAYLOAD];
} Link_Slot;

typedef struct Link_Parser {
    U8 count;
    U8 outOfStep; /* the last bytes were no frame: the next frame needs confirmation */
    U32 at;       /* time of the last byte */
    U32 paidAt;   /* when the rounds that the search has computed are paid for */
} Link_Parser;

/* Request heads that have passed in one direction. */
typedef struct Link_Heads {
    U32 lastRequest[LINK_CHANNELS], lastReply[LINK_CHANNELS];
    U8 next; /* slot that the next new one takes */
    U8 size[LINK_HEADS];
    U8 head[LINK_HEADS][LINK_HEAD_BYTES];
} Link_Heads;

/* A compressed message: bytes[0..prefix), `middle` bytes of its head, the rest from tailAt. `head`
 * is the size of its head; 0: nothing to remember. */
typedef struct Link_Packed {
    U8 bytes[8];
    U32 prefix, middle, tailAt, tail, head;
} Link_Packed;

/* The link. Small members that are often used come first: short instructions reach them. */
struct Link {
    U8 state;    /* Link_State */
    U8 wanted;   /* Link_start was called */
    U8 longest;  /* payload of the longest frame that is sent */
    U8 open;     /* a bit a channel: messages may be sent */
    U8 closing;  /* closed here, the peer's closing has not come yet */
    U8 closeDue; /* the own closing is not queued yet */
    U8 overhead; /* of a frame: of one without a key, or with one */
    U8 packed;   /* bytes in the packet */
    U8 heard;    /* bytes of a frame that came since the last packet left */
    Link_Receiver receiver;
    Link_Sender sender;
    U32 now;
    const Link_Port* port;
    void* context;
    Link_Queue queue;
    U32 byteTimeUs16;
    U32 slack;     /* the next packet is handed over that long before paceUntil */
    U32 paceUntil; /* when the modem will have sent everything handed over */
    U32 early;     /* a heard packet shortens the wait by this at most */
    U32 heardAt, pingAt;
    Link_Session session;
    Link_Parser parser;
    Link_Statistics statistics;
    Link_Handshake handshake;
    Link_Secrets secrets;
    Link_Watch watch;

    U8 packet[LINK_MAX_FRAME];              /* frames that leave together */
    U8 input[2U * LINK_MAX_FRAME];          /* the parser's */
    Link_Fragment window[LINK_WINDOW];      /* the sender's */
    Link_Entry entries[LINK_SEND_MESSAGES]; /* the queue's */
    Link_Slot slots[LINK_WINDOW];           /* the receiver's, as is ... */
    U8 message[LINK_HEAD_ROOM + LINK_MAX_MESSAGE + LINK_ESCAPE + LINK_CHECK];
    U8 brief[LINK_HEAD_ROOM + LINK_MAX_PAYLOAD]; /* a message of one fragment */
    Link_Heads headsOut, headsIn;
    U8 queued[LINK_SEND_BYTES]; /* the queue's */
};

/* link_output: adds header and checksum, puts frames into packets, and hands these to the radio. */

/* True if a fragment may go out now: the packet has room, or the modem has for a new one. */
int link_isOpen(Link* link);
/* Notes that a frame of so many bytes came. */
void link_hear(Link* link, U32 size);
/* Bytes of payload that a frame may have to fit into the packet, at least if link_isOpen. */
U32 link_room(const Link* link);
/* Hands the packet to the radio. Returns 0: it had no room, the packet stays. */
int link_flush(Link* link);
/* Puts a frame whose payload is in place into the packet. `number` has byte 1 of the header as its
 * lowest byte. Returns 1: taken. */
int link_sendFrame(Link* link, U8* frame, U32 header, U32 number);
/* Sends at once a control frame whose payload of `size` bytes is in place; byte 1 is the lowest
 * byte of `number`. `flags`: the low bits of byte 2. Returns 1: taken. */
int link_sendControl(Link* link, U8* frame, Link_Kind kind, U32 number, U32 size, U32 flags);

/* link_compression: heads of IceP messages are sent once. */

void link_resetHeads(Link* link);
/* Compresses the message: changes `packed`, which stands for the unchanged one on entry. */
void link_compress(const Link* link, int channel, const U8* m, U32 size, Link_Packed* packed);
/* Remembers the head of a message that has passed, on both sides alike. */
void link_note(Link_Heads* heads, int channel, const U8* m, U32 size, U32 head);
/* Restores the message that link->receiver holds. Returns 0: it is malformed. */
int link_decompress(Link* link);

/* link_receiver: order, messages, acknowledgements. A function with an int returns 0 if the peer
 * broke the rules: then nothing it sent can be trusted, and the session must end. */

void link_resetReceiver(Link* link);
int link_onData(Link* link, U32 seq, U32 flags, const U8* data, U32 size);
/* Offers a held message again. */
int link_pollReceiver(Link* link);
/* True if an acknowledgement is due, and a piggybacked one says all of it. */
int link_ackMayRide(const Link* link);
void link_ackIsSent(Link* link);
void link_pollAck(Link* link);

/* link_queue: messages that wait to be sent; Link_send, Link_openChannel, Link_closeChannel. */

#define LINK_RING(at) ((at) & (LINK_SEND_BYTES - 1U))
Link_Entry* link_entryAt(Link* link, U32 index);
/* Ends an entry, removes all entries that wait for nothing any more, reports a message's outcome,
 * and tells that there is room again. */
void link_endEntry(Link* link, Link_Entry* entry, Link_Outcome outcome);
/* Queues the closings that had no room yet. The peer waits for each before the channel can be
 * opened again. */
void link_queueClosings(Link* link);

/* link_sender: fragments, window, retransmission. */

void link_resetSender(Link* link);
/* `bitmap`: so many bytes, as in the frame. */
void link_onAck(Link* link, U32 cumulative, U32 credit, const U8* bitmap, U32 size);
void link_pollSender(Link* link);

/* link_session: handshake, reboots, and a peer that has vanished. */

void link_onHandshake(Link* link, const U8* frame, Link_Kind kind);
void link_sendHello(Link* link, U32 version);
/* Sends HELLO, with two keys under each in turn. */
void link_call(Link* link);
/* Bytes of a nonce in the frames of the handshake. */
U32 link_nonceBytes(const Link* link);
/* Draws the nonce of the next session. */
void link_drawNonce(Link* link);
/* Prepares the session that the peer's nonce and the own one make. */
void link_makeCandidate(Link* link, const U8* peerNonce, U32 features);
/* Sends a frame with both nonces. */
void link_sendHandshake(Link* link, const Link_Session* session, Link_Kind kind);
void link_confirmCandidate(Link* link);
void link_endSession(Link* link, Link_State next);
/* Ends a session that the peer's wish or silence has ended. */
void link_lose(Link* link);
/* Ends a session because the peer broke the rules, and informs the peer. */
void link_abort(Link* link);
void link_pollSession(Link* link);

/* link_keyed: the handshake with a key, and proofs that the peer lives. */

/* Returns whether a frame of the handshake is fresh and relevant, which takes no round of Ascon. */
int link_isOfUse(const Link* link, const U8* frame, Link_Kind kind);
/* Returns whether such a frame is authentic, and decrypts it. */
int link_isGenuine(Link* link, U8* frame, Link_Kind kind);
/* Acts upon such a frame. */
void link_onGenuine(Link* link, const U8* frame, Link_Kind kind);
void link_onPing(Link* link, const U8* frame);
void link_pollKeyed(Link* link);

/* link_input: finds frames in the bytes, and acts upon them; Link_receive. */

void link_pollInput(Link* link);

#endif
