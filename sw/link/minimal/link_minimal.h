/* SPDX-License-Identifier: MIT
 *
 * link_minimal: defines a Link in the minimal layer. Only link.h includes it.
 */
#pragma once

#include "link_wire.h"

/* No length that a frame may claim goes beyond. */
#define LINK_INPUT_BYTES (0x7FU + LINK_OVERHEAD)

/* Bytes of a frame beside its payload; a constant without keys. */
#define LINK_OVERHEAD_OF(link) (LINK_SECURE ? (link)->overhead : LINK_OVERHEAD)
/* True once a key was given, for good. */
#define LINK_IS_SECURE(link) (LINK_OVERHEAD_OF(link) != LINK_OVERHEAD)

/* With a key: the handshake's parts. */
typedef struct Link_Keyed {
    Link_Secrets secrets;
    Link_Keys keys;                   /* of the session */
    Link_Keys shake;                  /* of its handshake */
    Link_Pair pair;                   /* of the next session */
    U8 nonces[2U * LINK_NONCE_BYTES]; /* of the session: the peer's, the own one */
    U8 nonce[LINK_NONCE_BYTES];       /* own, of the next session */
    U8 slot;                          /* of the session's key */
    U8 isAnswered;                    /* a HELLO was answered with `nonce`, ... */
    U8 isCalled;                      /* a HELLO was sent with it */
    U8 isUnconfirmed;                 /* the peer may not know of the session yet */
    U32 firstAnswer;                  /* ... first at this time */
    U32 lastAnswer;                   /* when a HELLO was last answered, ... */
    U32 lastCall;                     /* and one sent unasked, or a session begun */
    U32 pingsSeen;                    /* number of the peer's newest PING */
    U32 failures;                     /* frames of the session whose tag was wrong */
} Link_Keyed;

/* Small and often used fields come first: a Cortex-M3 reaches them with short instructions. */
struct Link {
    U8 state;    /* Link_State */
    U8 overhead; /* of a frame: of one without a key, or with one */
    /* The fields from here on are 0 when a session begins. */
    U8 channels[LINK_CHANNELS]; /* OPEN, CLOSING, and due fragments */
    U8 ackDue;
    U8 flags;           /* byte 2 of the fragment in flight; 0: there is none */
    U8 channel;         /* channel of the message going out */
    U32 sendNext;       /* number of the fragment in flight, or of the next one: SEQ extended */
    U32 receiveNext;    /* number expected */
    U32 outSize, outAt; /* bytes of the message going out, and acknowledged bytes of it */
    U32 size;           /* bytes of the fragment in flight */
    U32 messageSize;    /* bytes received of the message coming in */
    U32 peerNonce;      /* 0: no session */
    /* End of the fields that begin at 0. */
    U32 nonce, key;
    U32 timerAt; /* time at which the fragment in flight goes out again */
    U32 retryUs; /* time from one transmission of it to the next */
    U32 inputAt, heardAt;
    U32 inputCount;
    const Link_Port* port;
    void* context;
    U32 tag;
    U32 cutAt; /* with a key: when the fragment in flight was first sent */
    U8 input[LINK_INPUT_BYTES];
    U8 frame[LINK_MAX_FRAME]; /* the frame going out */
    U8 out[LINK_MAX_MESSAGE + LINK_CHECK];
    U8 message[LINK_MAX_MESSAGE + LINK_CHECK];
#if LINK_SECURE
    Link_Keyed keyed;
#endif
};

/* Ends the session, if there is one: clears its fields and reports its end. */
void link_lose(Link* link);

/* link_minimal_keyed */

void link_forgetKeys(Link* link);
/* Sends link->frame, which holds its payload, under the session's key. `number` has
 * byte 1 of the header as its lowest byte. */
void link_transmitKeyed(Link* link, U32 header, U32 number);
/* Takes the frame in link->input. Returns 1 if it is of the session, not a PING, and decrypted. */
int link_takeKeyed(Link* link);
