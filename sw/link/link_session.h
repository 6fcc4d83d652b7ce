/* SPDX-License-Identifier: MIT
 *
 * link_session: makes and ends sessions: handshake, reboots, a peer that has vanished; and gives
 * each frame that comes to its part of the layer.
 */
#pragma once

#include "link_sender.h"

/* The watch notes signs of the peer's life. */
typedef struct Link_Watch {
    U32 pingsSent, pingsAnswered; /* numbers of the newest own PING, and up to which that is over */
    U32 askedAt;                  /* when the first PING after that was sent */
    U32 pingsSeen;                /* number of the peer's newest PING */
    U32 provenAt;                 /* the peer lived then or later; without a key: heardAt */
    U32 failures;                 /* frames whose tag was wrong */
} Link_Watch;

typedef struct Link_Session {
    Link_Output* output; /* has the identity of the present session */
    Link_Receiver* receiver;
    Link_Sender* sender;
    U8 state;  /* Link_State */
    U8 wanted; /* Link_start was called */
    U8 hasCandidate;
    U8 keys;          /* slots with a key, a bit each */
    U8 slot;          /* of the key of the last HELLO */
    U8 isAnswered;    /* a HELLO was answered with `nonce`, ... */
    U8 isUnconfirmed; /* the peer may not know of the session yet */
    U32 firstAnswer;  /* ... first at this time, ... */
    U32 lastAnswer;   /* last at this one */
    U32 helloAt, helloEvery, pingAt;
    Link_Watch watch;
    U8 nonce[LINK_NONCE_BYTES]; /* own, of the next session */
    Link_Identity candidate; /* of a HELLO that was answered; its sender has not confirmed it yet */
    Link_Secret secrets[LINK_KEYS];
    Link_Pair pair; /* of the next session */
} Link_Session;

/* Draws the nonce of the next session. */
void link_drawNonce(Link_Session* session);
/* Prepares the session that the peer's nonce and the own one make. */
void link_makeCandidate(Link_Session* session, const U8* peerNonce, U32 features);
/* Sends a frame with both nonces of a session; 0: HELLO, with the own one of the next session. */
void link_sendHandshake(Link_Session* session, const Link_Identity* of, Link_Kind kind,
                        U32 version);
void link_confirmCandidate(Link_Session* session);
/* Ends the session, if there is one: clears its state and reports its end. */
void link_endSession(Link_Session* session, Link_State next);
/* Ends a session that the peer's wish or silence has ended. */
void link_lose(Link_Session* session);
/* Ends the session, if there is one, as this side wishes, and tells the peer. */
void link_abort(Link_Session* session);
/* Calls or asks the peer; ends a session that is silent or has lasted too long. Returns 1: there is
 * one. */
int link_pollSession(Link_Session* session);

/* The input keeps bytes until a frame is whole, and gives each good frame to its part. */
typedef struct Link_Input {
    Link_Output* output;
    Link_Session* session;
    U8 count;     /* bytes kept */
    U8 outOfStep; /* the last bytes were no frame: the next frame needs confirmation */
    U32 at;       /* time of the last byte */
    U32 paidAt;   /* when the rounds that the search has computed are paid for */
    U8 bytes[2U * LINK_MAX_FRAME];
} Link_Input;

/* Takes bytes from the radio. */
void link_takeBytes(Link_Input* input, const U8* bytes, U32 size);
/* Drops half a frame behind which silence has come. */
void link_pollInput(Link_Input* input);

/* For the codecs: */

/* True if a frame, none of the handshake, has the epoch of a session's key. */
int link_isOfEpoch(const U8* frame, U32 key);
/* True if a header makes sense: most garbage fails here, before the checksum. */
int link_isPlausible(const Link_Output* output, const U8* frame);
/* Acts upon a good frame of `size` bytes, whose header has the payload's length. */
void link_accept(Link_Input* input, const U8* frame, U32 size);
/* Counts a byte where no frame begins. */
void link_skip(Link_Input* input, const U8* frame, U32 left);
