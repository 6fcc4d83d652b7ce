/* SPDX-License-Identifier: MIT
 *
 * link: reliable, ordered messages on four channels over a lossy packet radio.
 * Wire format: docs/link.md. The same source runs in the firmware and in the ground plugin.
 *
 * The layer owns no thread, no clock and no memory: the caller supplies the time in microseconds
 * (32 bits, it may wrap), calls Link_poll when Link_deadline is due, and keeps the Link object.
 * One Link is used by one thread at a time. A callback may call Link_send, Link_openChannel and
 * Link_closeChannel, and no other function of this layer.
 */
#ifndef LINK_H
#define LINK_H

#include "base.h"

#define LINK_CHANNELS 4
#define LINK_MAX_FRAME 100U    /* bytes of one RF packet: 5 of overhead and up to 95 of payload */
#define LINK_MAX_ENCRYPTED 95U /* of one that the modem encrypts (Link_limitFrame) */

/* Options, for the compiler's command line; any two settings understand each other. LINK_MINIMAL
 * chooses the minimal layer (link_minimal.c), which has only LINK_MAX_MESSAGE of them and its own
 * LINK_LONGEST (for Link_limitFrame) and LINK_OUTCOMES; Link_start does nothing there: the peer
 * calls. */
#ifdef LINK_MINIMAL
#ifndef LINK_MAX_MESSAGE
#define LINK_MAX_MESSAGE 1024U
#endif
#endif
#ifndef LINK_WINDOW
#define LINK_WINDOW 32U /* fragments in flight, a power of two up to 64; 1: stop and wait */
#endif
#ifndef LINK_HEADS
#define LINK_HEADS 1 /* heads of IceP messages are sent once (link_head.c, 2.3 KiB of tables) */
#endif
#ifndef LINK_RIDE
#define LINK_RIDE 1 /* acknowledgements ride on short messages */
#endif
#ifndef LINK_STATISTICS
#define LINK_STATISTICS 1
#endif
#ifndef LINK_LIMIT
#define LINK_LIMIT 1 /* Link_limitFrame has an effect */
#endif
#ifndef LINK_MAX_MESSAGE
#define LINK_MAX_MESSAGE \
    8192U /* bytes of one message; a longer one from the peer ends the session */
#endif
#ifndef LINK_SEND_BYTES
#define LINK_SEND_BYTES \
    16384U /* queue of outgoing messages, shared by the channels; a power of two */
#endif
#ifndef LINK_SEND_MESSAGES
#define LINK_SEND_MESSAGES 32U /* messages, openings and closings in that queue, at most 128 */
#endif

typedef enum Link_Status {
    LINK_OK = 0,
    LINK_DOWN, /* no session with the peer */
    LINK_FULL, /* no room in the send queue now, or the channel is still being closed: try later */
    LINK_TOO_LONG, /* more than LINK_MAX_MESSAGE bytes, or none */
    LINK_CLOSED    /* there is no such channel, or neither side has opened it */
} Link_Status;

typedef enum Link_State {
    LINK_STATE_IDLE,       /* not started, or given up */
    LINK_STATE_CONNECTING, /* HELLO is being sent until the peer answers */
    LINK_STATE_UP
} Link_State;

typedef enum Link_Outcome {
    LINK_DELIVERED, /* the peer's program has taken it */
    LINK_UNKNOWN    /* the session ended first: it may or may not have arrived */
} Link_Outcome;

/* What the layer needs from its surroundings. `context` is passed back unchanged. */
typedef struct Link_Port {
    /* Hands one frame (at most LINK_MAX_FRAME bytes, valid during the call only) to the radio as
     * one RF packet. 0: taken; other: no room now, the layer offers it again at the next poll. */
    int (*transmit)(void* context, const U8* frame, U32 size);
    /* 32 bits that the peer cannot guess and that differ after a reboot. */
    U32 (*random)(void* context);
    /* A whole message has arrived; `data` is valid during the call only. 0: taken; other: no room
     * now. Then the layer keeps it, offers it again at each poll, and lowers the peer's credit. */
    int (*message)(void* context, int channel, const U8* data, U32 size);
    /* The peer opened or closed a channel (1, 0). All channels close when the session ends. */
    void (*channel)(void* context, int channel, int isOpen);
    /* The session came up or ended. */
    void (*state)(void* context, Link_State state);
    /* What became of a message: `tag` is what Link_send was given. Exactly one call a message.
     * May be 0, as may `writable`. */
    void (*outcome)(void* context, int channel, U32 tag, Link_Outcome outcome);
    /* Room appeared after LINK_FULL. */
    void (*writable)(void* context);
} Link_Port;

typedef struct Link Link; /* complete below, so that callers can place it; its fields are private */

typedef struct Link_Statistics {
    U32 framesSent, framesReceived; /* all kinds */
    U32 bytesSent, bytesReceived;   /* on the air, payload and overhead */
    U32 fragmentsResent;            /* data fragments sent more than once */
    U32 acksSent;
    U32 crcErrors, bytesSkipped; /* what resynchronisation threw away */
    U32 duplicates;              /* fragments that had already arrived */
    U32 messagesSent, messagesReceived;
    U32 sessions;       /* times the link came up */
    U32 roundTripUs;    /* smoothed estimate */
    U32 headBytesSaved; /* by link_head.c, of what was sent */
} Link_Statistics;

/* Prepares `link`. `port` must stay valid; `byteTimeUs16` is the time of one byte on the slowest
 * part of the way, in 1/16 microseconds (111,111 baud: 1440), used for pacing and timers. */
void Link_init(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16);

/* Bytes of the longest frame from now on, 32..LINK_MAX_FRAME: a modem that encrypts splits what is
 * longer than LINK_MAX_ENCRYPTED. The two sides may differ. */
void Link_limitFrame(Link* link, U32 bytes);

/* Starts the handshake. Both sides may do so; either one's HELLO makes the session. A side that
 * never calls it still answers a HELLO. After the peer has vanished the layer goes back to
 * CONNECTING. */
void Link_start(Link* link, U32 nowUs);

/* Ends the session: tells the peer, reports messages in flight as LINK_UNKNOWN, goes to IDLE. */
void Link_stop(Link* link, U32 nowUs);

Link_State Link_state(const Link* link);

/* Opens a channel, for both directions; the peer's `channel` callback says so. LINK_OK, LINK_DOWN,
 * LINK_FULL. */
Link_Status Link_openChannel(Link* link, int channel, U32 nowUs);

/* Closes a channel behind the messages that were sent before. LINK_CLOSED: it was not open. */
Link_Status Link_closeChannel(Link* link, int channel, U32 nowUs);

/* Queues a copy of a message of 1..LINK_MAX_MESSAGE bytes. */
Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag, U32 nowUs);

/* Bytes from the radio, in any portions: packet boundaries are not relied upon.
 * `isPacketEnd` is 1 where the caller knows that a packet or a silence ends here (a hint for
 * resynchronisation after corruption), else 0. */
void Link_receive(Link* link, const U8* bytes, U32 size, int isPacketEnd, U32 nowUs);

/* Sends what is due: fragments, acknowledgements, retransmissions, HELLO. */
void Link_poll(Link* link, U32 nowUs);

/* When Link_poll must be called at the latest, in microseconds from now; 0xFFFFFFFF: no need. */
U32 Link_deadline(const Link* link, U32 nowUs);

const Link_Statistics* Link_statistics(const Link* link);

#ifdef LINK_MINIMAL
#include "minimal/link_minimal.h"
#else
#include "link_private.h"
#endif

#endif
