/* SPDX-License-Identifier: MIT
 *
 * link_port: the functions with which the link layer reaches the radio and the caller's program,
 * the types that they use, and the statistics.
 */
#pragma once

#include "base.h"

typedef enum Link_State {
    LINK_STATE_IDLE,       /* the link was not started, or has ended */
    LINK_STATE_CONNECTING, /* this side sends HELLO until the peer answers */
    LINK_STATE_UP
} Link_State;

typedef enum Link_Outcome {
    LINK_DELIVERED, /* the peer's program has accepted the message */
    /* the session ended before an acknowledgement arrived, so it is unknown whether the message has
     * arrived */
    LINK_UNKNOWN
} Link_Outcome;

typedef enum Link_Status {
    LINK_OK = 0,
    LINK_DOWN, /* no session with the peer */
    /* the send queue has no room, or the channel is still being closed; try again later */
    LINK_FULL,
    LINK_TOO_LONG, /* the message is larger than LINK_MAX_MESSAGE or the queue, or has 0 bytes */
    LINK_CLOSED    /* the channel does not exist, or neither side has opened it */
} Link_Status;

/* Functions that the caller supplies. `context` is Link_Config.context. */
typedef struct Link_Port {
    /* Sends one frame (at most LINK_MAX_FRAME bytes, valid only during the call) as one RF packet
     * of the radio. Returns 0 if the radio accepts the frame. Otherwise the layer offers the frame
     * again later. */
    int (*transmit)(void* context, const U8* frame, U32 size);
    /* Returns 32 bits that the peer cannot guess and that differ after a restart. With a key they
     * must come from a true random source, because keys are derived from them. */
    U32 (*random)(void* context);
    /* Receives a complete message; `data` is valid only during the call. Returns 0 if the program
     * accepts the message. Otherwise the layer keeps the message, offers it again at each poll, and
     * lowers the credit of the peer. */
    int (*message)(void* context, int channel, const U8* data, U32 size);
    /* Reports that the peer has opened (1) or closed (0) a channel. All channels are closed when
     * the session ends. */
    void (*channel)(void* context, int channel, int isOpen);
    /* Reports that the session began or ended. */
    void (*state)(void* context, Link_State state);
    /* Reports the outcome of a message, exactly once; `tag` is the value that was passed to
     * Link_send. The pointers `outcome` and `writable` may be 0. */
    void (*outcome)(void* context, int channel, U32 tag, Link_Outcome outcome);
    /* Reports that the queue has room again, after a function has returned LINK_FULL. */
    void (*writable)(void* context);
} Link_Port;

/* Counters since Link_init, over all sessions. */
typedef struct Link_Statistics {
    U32 framesSent, framesReceived; /* number of frames, of all kinds */
    U32 bytesSent, bytesReceived;   /* number of bytes on the air, including overhead */
    U32 fragmentsResent;            /* number of retransmissions of data fragments */
    U32 acksSent;                   /* number of acknowledgements, also those in a PIGGYBACK */
    /* number of bytes skipped during the search for the next frame */
    U32 bytesSkipped;
    U32 duplicates;                     /* number of fragments that arrived more than once */
    U32 messagesSent, messagesReceived; /* number of messages delivered in each direction */
    U32 sessions;                       /* number of sessions */
    U32 roundTripUs;                    /* smoothed round trip, us; not a counter */
    /* number of bytes saved by compressing the headers of sent messages */
    U32 headBytesSaved;
} Link_Statistics;
