/* SPDX-License-Identifier: MIT
 *
 * link_pacing: the lowest part: puts frames into packets, and says when each is handed to the
 * radio: while few wait for its answer, or else when the modem has sent those before.
 */
#pragma once

#include "link_frame.h"
#include "link_port.h"

#define LINK_FEATURES (LINK_FEATURE_COMPRESSION | LINK_FEATURE_PIGGYBACK)

typedef struct Link_Output Link_Output;
struct Link_Session;
struct Link_Input;

/* A codec protects frames: by a checksum (link_clear), or by a tag under a key (link_keyed). */
typedef struct Link_Codec {
    U8 overhead;   /* bytes of a frame beside its payload */
    U8 nonceBytes; /* of each side's nonce in the handshake */
    U8 check;      /* bytes of check behind a message of more than LINK_UNCHECKED */
    U8 isSure;     /* 1: a frame that was found is no chance; PINGs are numbered */
    U8 sizes[6];   /* of the payloads of control frames up to PING, by Link_Kind */
    /* Completes a frame, as link_sendFrame gets it. Returns its size in bytes. */
    U32 (*seal)(const Link_Output* output, U8* frame, U32 header, U32 number);
    /* Accepts all whole frames in the bytes; returns the number of bytes used. After a bad frame it
     * goes on at the next byte. The frames that end within the first input->count bytes were looked
     * at before. `isEnd`: a silence follows, so half a frame will never become whole. */
    U32 (*parse)(struct Link_Input* input, const U8* bytes, U32 count, int isEnd);
    void (*onHandshake)(struct Link_Session* session, const U8* frame, Link_Kind kind);
    /* 0: an acknowledgement is the answer. */
    void (*onPing)(struct Link_Session* session, const U8* frame);
    /* Sends HELLO; or, if `unknown` is a frame of an unknown session, what ends that. */
    void (*call)(struct Link_Session* session, const U8* unknown);
} Link_Codec;

extern const Link_Codec link_clear, link_keyed;

/* The identity of a session: both nonces, and the values that follow from them. */
typedef struct Link_Identity {
    U32 key;
    U8 features; /* features of both sides */
    U8 slot;     /* of the key that the session was made with */
    U8 nonce[LINK_NONCE_BYTES],
        peerNonce[LINK_NONCE_BYTES]; /* only the first four bytes without a key */
    Link_Keys keys;
    Link_Keys shake;          /* under a key: of the handshake's frames */
    U8 open[LINK_OPEN_BYTES]; /* and what they carry: the half of the own pair */
} Link_Identity;

/* Link_Talk is how much one side has sent; Link_randomWait decides by both sides'. */
typedef struct Link_Talk {
    U32 before; /* bytes before the present span */
    U8 isMuch;
} Link_Talk;

typedef struct Link_Contention {
    Link_Talk own, peers;
    U32 since, messages; /* begin of the span, and messages heard before it */
    U32 lostAt;
    U8 hasLost;  /* a packet, at lostAt */
    U8 isCalled; /* by the peer, during a stream */
    U8 isBusy;   /* the radio has had a packet since its last answer, at answeredAt */
    U32 answeredAt;
    U32 rest;    /* after the next loss, at most */
    U32 usualUs; /* mean time of a packet that arrives */
    U32 quick;   /* share of the last packets, of 65,536, lost in no more than that time */
} Link_Contention;

/* Packets that wait for a radio's answers. Links over one radio share a pacer. */
typedef struct Link_Pacer {
    U8 first, waiting;                             /* number of the oldest; how many there are */
    struct Link_Output* owners[LINK_MOST_WAITING]; /* by their numbers, whose they are */
} Link_Pacer;

/* A key that this side sends with, or its peer. */
#define LINK_OWN_KEY(output, keys) ((keys).bytes + LINK_KEY_BYTES * (U32)(output)->isGround)
#define LINK_PEERS_KEY(output, keys) ((keys).bytes + LINK_KEY_BYTES * (1U ^ (output)->isGround))

/* Small members that are often used come first in each part: short instructions reach them. */
struct Link_Output {
    U8 longest;         /* payload of the longest frame that is sent */
    U8 packed;          /* bytes in the packet */
    U8 heard;           /* bytes of a frame that came since the last packet left */
    U8 open;            /* a bit a channel: messages may be sent */
    U8 closing;         /* closed here, the peer's closing has not come yet */
    U8 closeDue;        /* the own closing is not queued yet */
    U8 isStream;        /* several fragments are on their way: packets follow each other */
    U8 slow;            /* not 0: the modem waits for the air now and then, and may hold packets */
    U8 mostWaiting;     /* packets that may wait in the pacer; 0: the radio gives no answers */
    U8 isGround;        /* under a key: this side is */
    U8 handed, waiting; /* own packets handed over, modulo 256, and those without an answer */
    U32 now;
    Link_Pacer* pacer;
    const Link_Codec* codec;
    const Link_Port* port;
    void* context;
    U32 expected; /* number of the next fragment from the peer: acknowledgements say it */
    U32 heardAt;  /* when the peer was last heard to live */
    U32 byteTimeUs16;
    U32 fastest;    /* round trip of the session */
    U32 slack;      /* the next packet is handed over that long before paceUntil */
    U32 paceUntil;  /* when the modem will have sent everything handed over */
    U32 early;      /* a heard packet shortens the wait by this at most */
    U32 quietUntil; /* the silence behind a short packet ends, so that the modem sends it */
    const U8* call; /* key of the frame of the handshake that is being sent */
    Link_Statistics statistics;
    Link_Identity present;
    U8 packet[LINK_MAX_FRAME]; /* frames that leave together */
    Link_Pacer own;            /* unless another link's is used */
    Link_Contention contention;
};

/* True if a fragment may go out now: the packet has room, or the modem has for a new one. */
int link_isOpen(Link_Output* output);
/* Notes that a frame of `size` bytes came. */
void link_hear(Link_Output* output, U32 size);
/* Bytes of payload that a frame may have to fit into the packet, at least if link_isOpen. */
U32 link_room(const Link_Output* output);
/* Hands the packet, in which there is a frame, to the radio. Returns 0: it had no room, the packet
 * stays. */
int link_flush(Link_Output* output);
/* Puts a frame whose payload is in place into the packet. `number` has byte 1 of the header as its
 * lowest byte. Returns 1: taken. */
int link_sendFrame(Link_Output* output, U8* frame, U32 header, U32 number);
/* Sends at once a control frame whose payload of `size` bytes is in place; byte 1 is the lowest
 * byte of `number`. Returns 1: taken. */
int link_sendControl(Link_Output* output, U8* frame, U32 byte2, U32 number, U32 size);
