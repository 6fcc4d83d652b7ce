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
 *         sleep(Link_deadline(&link, nowUs()));        (or until bytes arrive from the radio)
 *     }
 *
 * The same source runs in the firmware and in the plugin of the ground station. Wire format:
 * docs/link.md; limits and times: link_config.h.
 *
 * The layer creates no thread, reads no clock and allocates no memory. The caller supplies the time
 * in microseconds (32 bits, which may wrap around), calls Link_poll when Link_deadline is due, and
 * keeps the Link and its buffers. One Link is used by one thread at a time. A callback may call
 * Link_send, Link_openChannel and Link_closeChannel, but no other function of this layer.
 *
 * With LINK_MINIMAL, these are the functions of the minimal layer (link_minimal.h); its Link
 * contains the buffers.
 */
#pragma once

#ifdef LINK_MINIMAL
#include "link_frame.h"
#include "link_port.h"
#else
#include "link_search.h"
#endif

typedef struct Link Link; /* an opaque type: its fields are private */

/* Configuration of a link. Link_init copies it; `port` and the buffers must stay valid. */
typedef struct Link_Config {
    const Link_Port* port;
    void* context; /* value that is passed to the functions of the port */
    /* time that one byte takes on the slowest part of the path, in units of 1/16 us (1440 at
     * 111,111 baud); for pacing and timers */
    U32 byteTimeUs16;
#ifndef LINK_MINIMAL
    U8* send; /* ring for the queue of outgoing messages */
    /* size of `send`, bytes: a power of two, 1024 to 32,768. The largest message that can be sent
     * has sendBytes - LINK_RESERVE - LINK_CHECK bytes */
    U32 sendBytes;
    U8* message; /* buffer for the incoming message: LINK_ROOM(maxMessage) bytes */
    /* size of the largest message that can arrive, bytes; at most LINK_MAX_MESSAGE */
    U32 maxMessage;
    Link_Fragment* fragments; /* array for the fragments in flight */
    Link_ReorderSlot* slots;  /* array for fragments that arrived out of order */
    /* number of elements of both arrays: a power of two, 4 to LINK_WINDOW */
    U32 window;
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

/* Initialises the fields `send` to `window` of a Link_Config with such buffers. */
#define LINK_USE(buffers)                                                              \
    (buffers).send, sizeof(buffers).send, (buffers).message,                           \
        sizeof(buffers).message - LINK_ROOM(0U), (buffers).fragments, (buffers).slots, \
        sizeof(buffers).slots / sizeof(Link_ReorderSlot)

/* Buffers with the default sizes of link_config.h. */
typedef LINK_BUFFERS(LINK_SEND_BYTES, LINK_MAX_MESSAGE, LINK_WINDOW) Link_Buffers;
#endif

/* Initialises `link` with a copy of `config`. */
void Link_init(Link* link, const Link_Config* config);

#ifndef LINK_MINIMAL
/* Limits the size of later frames, bytes: from 32 (with a key, 59) to LINK_MAX_FRAME. A modem that
 * encrypts splits packets longer than LINK_MAX_ENCRYPTED. The two sides of a link may have
 * different limits. */
void Link_limitFrame(Link* link, U32 bytes);

/* Sets the vehicle's key for slot 0 or 1: LINK_KEY_BYTES bytes that both sides share; the bytes are
 * copied. `side` is the vehicle's address, plus LINK_GROUND on the ground. A session is only
 * possible between a ground station and the vehicle with that address, even if others have the key.
 * If `key` is 0, wipes the slot and ends a session that was made with its key. After the first key
 * was set, sessions are authenticated and encrypted, and a peer without the key is always refused.
 * If both slots are wiped later, no session is possible. The layer uses the keys of both slots in
 * turn for its HELLO frames, and answers a HELLO that was made with either key. Call this after
 * Link_init. */
void Link_setKey(Link* link, int slot, const U8* key, U32 side);

/* Returns the slot of the key with which the current session was made; -1 without a session or
 * without a key. */
int Link_keyInUse(const Link* link);
#endif

/* Starts the handshake. Only one side must start the handshake, but both sides may do so; one HELLO
 * is enough to make the session. A side that never calls this function still answers a HELLO. If
 * the peer disappears later, the state returns to CONNECTING. */
void Link_start(Link* link, U32 nowUs);

/* Ends the session: informs the peer, reports LINK_UNKNOWN for messages in flight, and sets the
 * state to IDLE. */
void Link_stop(Link* link, U32 nowUs);

Link_State Link_state(const Link* link);

/* Opens a channel for both directions; the peer learns this through the function `channel` of its
 * port. Returns LINK_OK, LINK_DOWN, LINK_FULL or LINK_CLOSED. */
Link_Status Link_openChannel(Link* link, int channel);

/* Closes a channel after the messages that are already queued. Works even if the queue has no room.
 * Returns LINK_OK, LINK_DOWN, or LINK_CLOSED if the channel was not open. */
Link_Status Link_closeChannel(Link* link, int channel);

#ifndef LINK_MINIMAL
/* Sets how many packets may wait for the radio's result (Link_answer); 0 means that the radio
 * reports no results. Results determine when the next packet is sent, and the contents of a lost
 * packet are sent again at once. If the line to the modem is faster than the radio, two packets
 * keep the radio busy: one is on the air, one waits in the modem. With a line of 111,111 baud,
 * three packets are needed. More packets would delay calls, because a call is sent only after all
 * packets before it. */
void Link_expectAnswers(Link* link, U32 packets);

/* Lets a link share the radio of another link. The packets of both links then wait in one list for
 * the radio's results: a call of Link_answer for either link reports the result of the oldest
 * packet in this list. Call this function after Link_init of both links, and call
 * Link_expectAnswers with the same number for both. */
void Link_shareRadio(Link* link, Link* with);

/* Returns the modem's RN for the current traffic. RN is the smallest exponent of the random wait
 * before the first try of the modem.
 * - 0 if only this side sends, because it need not wait.
 * - LINK_WAIT_SHARED if the peer sends a stream, because two modems would otherwise often begin
 *   packets at the same time. Exception: 0 if both sides send streams and many packets are lost
 *   without retries by the modem, because the modems then seldom begin at the same time. The
 *   exception does not apply to a modem that encrypts.
 * - LINK_WAIT_SHARED if the peer makes calls during a stream of this side, so that the calls get
 *   through.
 * - LINK_WAIT_SHARED if this side sends no stream and packets are lost, so that an interferer does
 *   not hit all of the packets.
 * `transmit` may call this function. */
U32 Link_randomWait(Link* link);

/* Reports the radio's result for the oldest packet that has no result yet: delivered or lost. If
 * the radio sends no result within LINK_ANSWER_LAST, the driver reports a loss. */
void Link_answer(Link* link, int isDelivered, U32 nowUs);
#endif

/* Queues a copy of a message of 1..LINK_MAX_MESSAGE bytes. `tag` is passed to the function
 * `outcome` of the port. */
Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag);

/* Processes bytes from the radio, at least one. The bytes may be split at any place; packet
 * boundaries do not matter. Delivers each message that becomes complete. */
void Link_receive(Link* link, const U8* bytes, U32 size, U32 nowUs);

/* Sends the frames that are due: fragments, acknowledgements, retransmissions and HELLO. */
void Link_poll(Link* link, U32 nowUs);

/* Returns the time until Link_poll must be called, us; 0xFFFFFFFF if no call is needed. */
U32 Link_deadline(const Link* link, U32 nowUs);

/* Returns the counters, which the link continues to update. */
const Link_Statistics* Link_statistics(const Link* link);

#ifndef LINK_MINIMAL
/* Parts of the link, from the lowest layer to the highest. Each part uses only lower parts, and
 * writes only its own fields. */
struct Link {
    Link_Pacing pacing;
    Link_Session session;
    Link_Search search;
};
#endif
