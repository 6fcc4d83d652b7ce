/* SPDX-License-Identifier: MIT
 *
 * link_port: the link layer's interface to its caller's radio and program, and its statistics.
 */
#pragma once

#include "base.h"

typedef enum Link_State {
    LINK_STATE_IDLE,       /* not started, or ended */
    LINK_STATE_CONNECTING, /* sends HELLO until the peer answers */
    LINK_STATE_UP
} Link_State;

typedef enum Link_Outcome {
    LINK_DELIVERED, /* the peer's program has taken it */
    LINK_UNKNOWN    /* the session ended first: the message may or may not have arrived */
} Link_Outcome;

typedef enum Link_Status {
    LINK_OK = 0,
    LINK_DOWN,     /* no session with the peer */
    LINK_FULL,     /* no room in the send queue, or the channel is still being closed: try later */
    LINK_TOO_LONG, /* more than LINK_MAX_MESSAGE bytes or the queue's size, or 0 bytes */
    LINK_CLOSED    /* the channel does not exist, or neither side has opened it */
} Link_Status;

/* Functions that the caller supplies. `context` is Link_Config.context. */
typedef struct Link_Port {
    /* Hands one frame (at most LINK_MAX_FRAME bytes, valid only during the call) to the radio as
     * one RF packet. Returns 0 if it is taken; otherwise the layer offers it again later. */
    int (*transmit)(void* context, const U8* frame, U32 size);
    /* Returns 32 bits that the peer cannot guess and that differ after a reboot. With a key they
     * must come from a true random source, since keys are derived from them. */
    U32 (*random)(void* context);
    /* Takes a complete message; `data` is valid only during the call. Returns 0 if it is taken.
     * Otherwise the layer keeps it, offers it again at each poll, and lowers the peer's credit. */
    int (*message)(void* context, int channel, const U8* data, U32 size);
    /* Reports that the peer opened (1) or closed (0) a channel. All close when the session ends. */
    void (*channel)(void* context, int channel, int isOpen);
    /* Reports that the session began or ended. */
    void (*state)(void* context, Link_State state);
    /* Reports the outcome of a message, exactly once; `tag` is from Link_send. The pointer may be
     * 0, and so may `writable`. */
    void (*outcome)(void* context, int channel, U32 tag, Link_Outcome outcome);
    /* Reports that there is room again after LINK_FULL. */
    void (*writable)(void* context);
} Link_Port;

/* Counts since Link_init, over all sessions. */
typedef struct Link_Statistics {
    U32 framesSent, framesReceived;     /* frames of all kinds */
    U32 bytesSent, bytesReceived;       /* bytes on the air, payload and overhead */
    U32 fragmentsResent;                /* data fragments sent more than once */
    U32 acksSent;                       /* alone or piggybacked */
    U32 bytesSkipped;                   /* dropped by resynchronisation */
    U32 duplicates;                     /* fragments that had already arrived */
    U32 messagesSent, messagesReceived; /* delivered messages */
    U32 sessions;                       /* number of sessions */
    U32 roundTripUs;                    /* smoothed estimate, not a count */
    U32 headBytesSaved;                 /* bytes saved by compression of heads sent */
} Link_Statistics;
