/* SPDX-License-Identifier: MIT
 *
 * link_port: what the link layer needs from its caller, reports to him, and counts.
 */
#pragma once

#include "base.h"

typedef enum Link_State {
    LINK_STATE_IDLE,       /* not started, or given up */
    LINK_STATE_CONNECTING, /* sends HELLO until the peer answers */
    LINK_STATE_UP
} Link_State;

typedef enum Link_Outcome {
    LINK_DELIVERED, /* the peer's program has taken it */
    LINK_UNKNOWN    /* the session ended first: it may or may not have arrived */
} Link_Outcome;

/* A port gives the layer what it needs from outside. `context` is passed back unchanged. */
typedef struct Link_Port {
    /* Hands one frame (at most LINK_MAX_FRAME bytes, valid during the call only) to the radio as
     * one RF packet. Returns 0: taken; other: no room now, the layer offers it again later. */
    int (*transmit)(void* context, const U8* frame, U32 size);
    /* Returns 32 bits that the peer cannot guess and that differ after a reboot. With a key: bits
     * of a true random source, since keys follow from them. */
    U32 (*random)(void* context);
    /* Takes a whole message; `data` is valid during the call only. Returns 0: taken; other: no room
     * now. Then the layer keeps it, offers it again at each poll, and lowers the peer's credit. */
    int (*message)(void* context, int channel, const U8* data, U32 size);
    /* Tells that the peer opened (1) or closed (0) a channel. All close when the session ends. */
    void (*channel)(void* context, int channel, int isOpen);
    /* Tells that the session came up or ended. */
    void (*state)(void* context, Link_State state);
    /* Reports the outcome of a message, exactly once; `tag` is Link_send's. May be 0, as may
     * `writable`. */
    void (*outcome)(void* context, int channel, U32 tag, Link_Outcome outcome);
    /* Tells that room appeared after LINK_FULL. */
    void (*writable)(void* context);
} Link_Port;

/* The counts run from Link_init on, over all sessions. */
typedef struct Link_Statistics {
    U32 framesSent, framesReceived;     /* of all kinds */
    U32 bytesSent, bytesReceived;       /* on the air, payload and overhead */
    U32 fragmentsResent;                /* data fragments sent more than once */
    U32 acksSent;                       /* alone or piggybacked */
    U32 bytesSkipped;                   /* dropped by resynchronisation */
    U32 duplicates;                     /* fragments that had already arrived */
    U32 messagesSent, messagesReceived; /* delivered ones */
    U32 sessions;                       /* times the link came up */
    U32 roundTripUs;                    /* the smoothed estimate, not a count */
    U32 headBytesSaved;                 /* bytes saved by compression of heads sent */
} Link_Statistics;
