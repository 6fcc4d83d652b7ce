/* SPDX-License-Identifier: MIT
 *
 * link: carries reliable, ordered messages on four channels over a lossy packet radio.
 *
 *     static const Link_Port port = {transmit, random, onMessage, onChannel, onState, 0, 0};
 *     static Link_Buffers buffers;
 *     static const Link_Config config = {&port, 0, 1440, LINK_USE(buffers)};  (90 us per byte)
 *     static Link link;
 *     Link_init(&link, &config);
 *     Link_start(&link, nowUs());                      (onState reports the session)
 *     for (;;) {
 *         Link_receive(&link, bytes, size, nowUs());   (bytes from the radio, if any)
 *         Link_poll(&link, nowUs());
 *         if (Link_openChannel(&link, 0) == LINK_OK)   (once; then any number of messages:)
 *             Link_send(&link, 0, message, 12, 0);
 *         sleep(Link_deadline(&link, nowUs()));        (or until the radio brings something)
 *     }
 *
 * The same source runs in the firmware and in the ground's plugin. Wire format: docs/link.md;
 * limits and times: link_config.h.
 *
 * The layer owns no thread, no clock and no memory: the caller supplies the time in microseconds
 * (32 bits, it may wrap), calls Link_poll when Link_deadline is due, and keeps the Link and its
 * buffers. One Link is used by one thread at a time. A callback may call Link_send,
 * Link_openChannel and Link_closeChannel, and no other function of this layer.
 *
 * LINK_MINIMAL selects the functions of the minimal layer (link_minimal.h), which defines a Link of
 * its own with buffers inside.
 */
#pragma once

#ifdef LINK_MINIMAL
#include "link_frame.h"
#include "link_port.h"
#else
#include "link_search.h"
#endif

typedef struct Link Link; /* its fields are private */

/* Configuration of a link. It is copied; `port` and the buffers must stay valid. */
typedef struct Link_Config {
    const Link_Port* port;
    void* context;    /* passed to the port unchanged */
    U32 byteTimeUs16; /* time of one byte on the slowest part of the path, 1/16 us (111,111 baud:
                       * 1440), for pacing and timers */
#ifndef LINK_MINIMAL
    U8* send;      /* queue of outgoing messages */
    U32 sendBytes; /* its size, bytes: a power of two, at least 1024, at most 32,768. Messages up to
                    * sendBytes - LINK_RESERVE - LINK_CHECK bytes can be sent */
    U8* message;   /* message being assembled: LINK_ROOM(maxMessage) bytes */
    U32 maxMessage;           /* largest message that can arrive, bytes; at most LINK_MAX_MESSAGE */
    Link_Fragment* fragments; /* window of fragments in flight */
    Link_ReorderSlot* slots;  /* fragments that arrived before their turn */
    U32 window;               /* size of both arrays: a power of two, 4 to LINK_WINDOW */
#endif
} Link_Config;

#ifndef LINK_MINIMAL
/* Declares a struct with a link's buffers. */
#define LINK_BUFFERS(sendBytes, maxMessage, window) \
    struct {                                        \
        Link_Fragment fragments[window];            \
        Link_ReorderSlot slots[window];             \
        U8 send[sendBytes];                         \
        U8 message[LINK_ROOM(maxMessage)];          \
    }

/* Sets the fields of a Link_Config starting with `send` to such buffers. */
#define LINK_USE(buffers)                                                              \
    (buffers).send, sizeof(buffers).send, (buffers).message,                           \
        sizeof(buffers).message - LINK_ROOM(0U), (buffers).fragments, (buffers).slots, \
        sizeof(buffers).slots / sizeof(Link_ReorderSlot)

/* Buffers of the sizes in link_config.h. */
typedef LINK_BUFFERS(LINK_SEND_BYTES, LINK_MAX_MESSAGE, LINK_WINDOW) Link_Buffers;
#endif

/* Prepares `link`. */
void Link_init(Link* link, const Link_Config* config);

#ifndef LINK_MINIMAL
/* Limits the size of later frames, bytes, 32 (under a key 59) to LINK_MAX_FRAME: a modem that
 * encrypts splits packets longer than LINK_MAX_ENCRYPTED. The two sides may differ. */
void Link_limitFrame(Link* link, U32 bytes);

/* Sets the vehicle's key for slot 0 or 1: LINK_KEY_BYTES bytes shared by both sides; they are
 * copied. `side` is the vehicle's address, plus LINK_GROUND on the ground: a session is only
 * possible between a ground station and the vehicle with that address, even if others have the key.
 * `key` 0 wipes the slot, and ends a session made with it. After the first key, sessions are
 * authenticated and encrypted, and a peer without the key is refused permanently: with both slots
 * wiped no session is possible. The layer sends HELLO under the keys of both slots in turn and
 * answers a HELLO under either. Call it after Link_init. */
void Link_setKey(Link* link, int slot, const U8* key, U32 side);

/* Returns the slot of the key that made the current session; -1 without a session or a key. */
int Link_keyInUse(const Link* link);
#endif

/* Starts the handshake. Both sides may do so; the HELLO of either makes the session. A side that
 * never calls it still answers a HELLO. After the peer has vanished, the state is CONNECTING
 * again. */
void Link_start(Link* link, U32 nowUs);

/* Ends the session: informs the peer, reports messages in flight as LINK_UNKNOWN, goes to IDLE. */
void Link_stop(Link* link, U32 nowUs);

Link_State Link_state(const Link* link);

/* Opens a channel for both directions; the peer's `channel` callback reports it. Returns LINK_OK,
 * LINK_DOWN, LINK_FULL or LINK_CLOSED. */
Link_Status Link_openChannel(Link* link, int channel);

/* Closes a channel after the messages that were sent before; needs no room in the queue. Returns
 * LINK_OK, LINK_DOWN, or LINK_CLOSED if it was not open. */
Link_Status Link_closeChannel(Link* link, int channel);

#ifndef LINK_MINIMAL
/* Sets how many packets may wait for the radio's result (Link_answer); 0: the radio reports none.
 * Results pace packets, and the contents of a lost packet are sent again at once. Two packets fill
 * the air if the line to the modem is faster: one is on the air, one waits in the modem. A line of
 * 111,111 baud needs three. A call waits for all of them. */
void Link_expectAnswers(Link* link, U32 packets);

/* Lets a link share the radio of another: their packets wait for its answers together, and a call
 * of Link_answer for either is for the oldest packet of all. Call it after Link_init of both; give
 * both the same Link_expectAnswers. */
void Link_shareRadio(Link* link, Link* with);

/* Returns the modem's RN for the current traffic: the smallest exponent of the random wait before
 * its first try.
 * - 0 for a lone sender: it need not wait. 1 if the modem encrypts: a packet then takes 16 ms
 *   instead of 10, and without a random wait an interferer of a fixed period that hits one packet
 *   hits the next ones too.
 * - LINK_WAIT_BOTH for two streams, which would begin together otherwise; unless many packets are
 *   lost without failed tries, which shows that the two seldom begin together.
 * - LINK_WAIT_SHARED for a stream during which the peer calls, so that calls get through; and for a
 *   side that sends little while packets are lost, so that an interferer does not meet all of them.
 * `transmit` may call it. */
U32 Link_randomWait(Link* link);

/* Reports the radio's result for the oldest packet without one: delivered or lost. The driver also
 * reports a loss if the radio does not report (LINK_ANSWER_LAST). */
void Link_answer(Link* link, int isDelivered, U32 nowUs);
#endif

/* Queues a copy of a message of 1..LINK_MAX_MESSAGE bytes. `tag` is for the `outcome` callback. */
Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag);

/* Takes bytes from the radio, at least one, in any portions: packet boundaries do not matter.
 * Reports the messages that they complete. */
void Link_receive(Link* link, const U8* bytes, U32 size, U32 nowUs);

/* Sends due frames: fragments, acknowledgements, retransmissions, HELLO. */
void Link_poll(Link* link, U32 nowUs);

/* Returns the time until Link_poll must be called, us; 0xFFFFFFFF: it need not be called. */
U32 Link_deadline(const Link* link, U32 nowUs);

/* Returns the counts, which continue to count. */
const Link_Statistics* Link_statistics(const Link* link);

#ifndef LINK_MINIMAL
/* Parts of the link, from bottom to top: each uses only parts below it, and writes only its
 * fields. */
struct Link {
    Link_Pacing pacing;
    Link_Session session;
    Link_Search search;
};
#endif
