/* SPDX-License-Identifier: MIT
 *
 * link_minimal: defines a Link in the minimal layer. Only link.h includes it.
 */
#ifndef LINK_MINIMAL_H
#define LINK_MINIMAL_H

#include "link_wire.h"

#ifndef LINK_LONGEST
#define LINK_LONGEST                                                            \
    LINK_MAX_PAYLOAD /* bytes of a frame's payload; 90 where the modem encrypts \
                      */
#endif
#ifndef LINK_OUTCOMES
#define LINK_OUTCOMES 0 /* 1: `outcome` and `writable` are called */
#endif

#define LINK_INPUT_BYTES                                                    \
    (0x7FU + LINK_OVERHEAD) /* no length that a frame may claim goes beyond \
                             */

/* Small and often used fields come first: a Cortex-M3 reaches them with short instructions. */
struct Link {
    U8 state; /* Link_State */
    /* The fields from here on are 0 when a session begins. */
    U8 channels[LINK_CHANNELS]; /* OPEN, CLOSING, and what is to be sent */
    U8 sendNext;                /* SEQ of the fragment in flight, or of the next one */
    U8 receiveNext;             /* SEQ expected */
    U8 ackDue;
    U8 flags;           /* byte 2 of the fragment in flight; 0: there is none */
    U8 channel;         /* channel of the message going out */
    U32 outSize, outAt; /* bytes of the message going out, and of it acknowledged */
    U32 size;           /* bytes of the fragment in flight */
    U32 messageSize;    /* bytes received of the message coming in */
    U32 peerNonce;      /* 0: no session */
    /* The fields that begin at 0 end here. */
    U32 nonce, key;
    U32 timerAt; /* time at which the fragment in flight goes out again */
    U32 retryUs; /* time from one transmission of it to the next */
    U32 inputAt, heardAt;
    U32 inputCount;
    const Link_Port* port;
    void* context;
    U32 tag;
    U8 input[LINK_INPUT_BYTES];
    U8 frame[LINK_MAX_FRAME]; /* the frame going out */
    U8 out[LINK_MAX_MESSAGE + LINK_CHECK];
    U8 message[LINK_MAX_MESSAGE + LINK_CHECK];
};

#endif
