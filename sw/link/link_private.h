/* SPDX-License-Identifier: MIT
 *
 * link_private: defines a Link, and declares the functions that the layer's files share, from the
 * bottom to the top. A file calls only functions above its own here. Only link.h includes it.
 */
#ifndef LINK_PRIVATE_H
#define LINK_PRIVATE_H

#include "link_compression.h"
#include "link_queue.h"

#define LINK_FEATURES (LINK_FEATURE_COMPRESSION | LINK_FEATURE_PIGGYBACK)

/* Bytes of the longest acknowledgement. */
#define LINK_ACK_ROOM(link) (LINK_CODEC(link)->overhead + 1U + LINK_BITMAP)

/* The peer's credit in fragments, until its first frame gives it. */
#define LINK_LEAST_WINDOW 8U

#define LINK_SLOT(seq) ((seq) & (LINK_WINDOW - 1U))

/* A codec protects frames: by a checksum (link_clear), or by a tag under a key (link_keyed). */
typedef struct Link_Codec {
    U8 overhead;          /* bytes of a frame beside its payload */
    U8 nonceBytes;        /* of each side's nonce in the handshake */
    U8 check;             /* bytes of check behind a message of more than LINK_UNCHECKED */
    U8 isSure;            /* 1: a frame that was found is no chance; PINGs are numbered */
    U8 endKind, endFlags; /* the frame that tells the peer of a session's end */
    U8 sizes[6];          /* of the payloads of control frames up to PING, by Link_Kind */
    /* Completes a frame, as link_sendFrame gets it. Returns its size in bytes. */
    U32 (*seal)(const Link* link, U8* frame, U32 header, U32 number);
    /* Accepts all whole frames in the bytes; returns the number of bytes used. After a bad frame it
     * goes on at the next byte. The frames that end within the first parser.count bytes were looked
     * at before. `isEnd`: a silence follows, so half a frame will never become whole. */
    U32 (*parse)(Link* link, const U8* bytes, U32 count, int isEnd);
    void (*onHandshake)(Link* link, const U8* frame, Link_Kind kind);
    void (*onPing)(Link* link, const U8* frame); /* 0: an acknowledgement is the answer */
    /* Sends HELLO; or, if `unknown` is a frame of an unknown session, what ends that. */
    void (*call)(Link* link, const U8* unknown);
} Link_Codec;

extern const Link_Codec link_keyed;
U32 link_sealClear(const Link* link, U8* frame, U32 header, U32 number);
U32 link_parseClear(Link* link, const U8* bytes, U32 count, int isEnd);
void link_onClearHandshake(Link* link, const U8* frame, Link_Kind kind);
void link_callClear(Link* link, const U8* unknown);

/* It stands here so that the compiler knows it where it is the only one. */
static const Link_Codec link_clear = {LINK_OVERHEAD,
                                      4U,
                                      LINK_CHECK,
                                      0,
                                      LINK_KIND_RST,
                                      LINK_FEATURES,
                                      {1, 4, 8, 0, 0, 0},
                                      link_sealClear,
                                      link_parseClear,
                                      link_onClearHandshake,
                                      0,
                                      link_callClear};
#define LINK_CODEC(link) (LINK_SECURE ? (link)->codec : &link_clear)

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

/* The watch notes signs of the peer's life. */
typedef struct Link_Watch {
    U32 pingsSent, pingsAnswered; /* numbers of the newest own PING, and up to which that is over */
    U32 askedAt;                  /* when the first PING after that was sent */
    U32 pingsSeen;                /* number of the peer's newest PING */
    U32 provenAt;                 /* the peer lived then or later; without a key: heardAt */
    U32 failures;                 /* frames whose tag was wrong */
} Link_Watch;

typedef enum Link_FragmentState { LINK_TO_SEND, LINK_SENT, LINK_ACKED } Link_FragmentState;

/* A fragment that was cut from the queue, until it is acknowledged in order. */
typedef struct Link_Fragment {
    Link_Piece piece;
    U32 firstAt, sentAt; /* times of its first and its last transmission */
    U32 order;           /* number of its last transmission */
    U8 tries;            /* 0, 1, more */
    U8 state;            /* Link_FragmentState */
} Link_Fragment;

typedef struct Link_Sender {
    U32 base, next;        /* numbers whose lowest byte is SEQ: oldest unacknowledged, next new */
    U8 credit, fullCredit; /* fragments that may be in flight: now, and at most so far */
    U8 hasWork;            /* there may be something to send */
    U8 isLossy;            /* the newest acknowledgement had gaps */
    U8 isLate;             /* the timer has expired since the last answer */
    U8 unasked;   /* transmissions since the last request for an acknowledgement, or the last one */
    U8 hasSample; /* srtt and rttvar are valid */
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

/* The link. Small members that are often used come first: short instructions reach them. */
struct Link {
    U8 state;    /* Link_State */
    U8 wanted;   /* Link_start was called */
    U8 longest;  /* payload of the longest frame that is sent */
    U8 open;     /* a bit a channel: messages may be sent */
    U8 closing;  /* closed here, the peer's closing has not come yet */
    U8 closeDue; /* the own closing is not queued yet */
    U8 packed;   /* bytes in the packet */
    U8 heard;    /* bytes of a frame that came since the last packet left */
    Link_Receiver receiver;
    Link_Sender sender;
    U32 now;
    const Link_Codec* codec;
    const Link_Port* port;
    void* context;
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

    U8 packet[LINK_MAX_FRAME];         /* frames that leave together */
    U8 input[2U * LINK_MAX_FRAME];     /* the parser's */
    Link_Fragment window[LINK_WINDOW]; /* the sender's */
    Link_Slot slots[LINK_WINDOW];      /* the receiver's, as is ... */
    U8 message[LINK_HEAD_ROOM + LINK_MAX_MESSAGE + LINK_ESCAPE + LINK_CHECK];
    U8 brief[LINK_HEAD_ROOM + LINK_MAX_PAYLOAD]; /* a message of one fragment */
    Link_Heads heads[2];                         /* of messages that came, and that were sent */
    Link_Queue queue;
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

/* link_sender: fragments, window, retransmission. */

/* Adds an entry to the queue, and work to the sender. Returns 0: there is no room. */
Link_Entry* link_offer(Link* link, U32 flags, U32 size);

void link_resetSender(Link* link);
/* `bitmap`: so many bytes, as in the frame. */
void link_onAck(Link* link, U32 cumulative, U32 credit, const U8* bitmap, U32 size);
/* Returns how long ago the oldest unacknowledged fragment was first sent, in microseconds; 0: all
 * that was sent is acknowledged. */
U32 link_age(const Link* link);
void link_pollSender(Link* link);

/* link_session: handshake, reboots, and a peer that has vanished. */

/* Draws the nonce of the next session. */
void link_drawNonce(Link* link);
/* Prepares the session that the peer's nonce and the own one make. */
void link_makeCandidate(Link* link, const U8* peerNonce, U32 features);
/* Sends a frame with both nonces of a session; 0: HELLO, with the own one of the next session. */
void link_sendHandshake(Link* link, const Link_Session* session, Link_Kind kind, U32 version);
void link_confirmCandidate(Link* link);
void link_endSession(Link* link, Link_State next);
/* Ends a session that the peer's wish or silence has ended. */
void link_lose(Link* link);
/* Ends a session because the peer broke the rules, and informs the peer. */
void link_abort(Link* link);
/* Calls or asks the peer; ends a session that is silent or has lasted too long. */
void link_pollSession(Link* link);

/* link_input: acts upon frames, for the codecs. */

/* True if a header makes sense: most garbage fails here, before the checksum. */
int link_isPlausible(const Link* link, const U8* frame);
/* Acts upon a good frame of `size` bytes, whose header has the payload's length. */
void link_accept(Link* link, const U8* frame, U32 size);
/* Counts a byte where no frame begins. */
void link_skip(Link* link, const U8* frame, U32 left);

#endif
