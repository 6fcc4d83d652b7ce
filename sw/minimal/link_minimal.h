/* SPDX-License-Identifier: MIT
 *
 * link_minimal: a small link layer for a side that never starts a handshake. It has the same wire
 * format and functions as the full layer (link.h). It sends one fragment at a time, waits for its
 * acknowledgement, and queues one message (docs/link.md).
 */
#pragma once

#include "link.h"

/* Size of the longest frame that a header can describe, bytes. */
#define LINK_INPUT_BYTES (0x7FU + LINK_OVERHEAD)

/* Small and often used fields come first, so that short Cortex-M3 instructions can reach them. */
struct Link {
    U8 state; /* Link_State */
    /* The following fields are 0 when a session begins. */
    U8 channels[LINK_CHANNELS]; /* state of each channel: OPEN, CLOSING, and fragments to be sent */
    U8 ackDue;
    U8 flags;           /* byte 2 of the fragment in flight; 0 if no fragment is in flight */
    U8 channel;         /* channel of the message that is being sent */
    U32 sendNext;       /* number (extended SEQ) of the fragment in flight, or of the next one */
    U32 receiveNext;    /* number of the fragment that is expected from the peer */
    U32 outSize, outAt; /* size of the message being sent, and number of its acknowledged bytes */
    U32 size;           /* bytes of the fragment in flight */
    U32 messageSize;    /* number of bytes received of the current incoming message */
    U32 peerNonce;      /* nonce of the peer; 0 without a session */
    /* End of the fields that are 0 when a session begins. */
    U32 nonce, key;
    U32 timerAt; /* time at which the fragment in flight is sent again */
    U32 retryUs; /* interval of retransmissions, us */
    U32 inputAt, heardAt;
    U32 inputCount;
    const Link_Port* port;
    void* context;
    U32 tag;
    U8 input[LINK_INPUT_BYTES];
    U8 frame[LINK_MAX_FRAME]; /* frame that is being sent */
    U8 out[LINK_MAX_MESSAGE + LINK_CHECK];
    U8 message[LINK_MAX_MESSAGE + LINK_CHECK];
};
