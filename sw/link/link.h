/* SPDX-License-Identifier: MIT
 *
 * link: carries reliable, ordered messages on four channels over a lossy packet radio.
 *
 *     static const Link_Port port = {transmit, random, onMessage, onChannel, onState, 0, 0};
 *     static Link link;
 *     Link_init(&link, &port, 0, 1440);                (a byte takes 90 us)
 *     Link_start(&link, nowUs());                      (onState says when the session is up)
 *     for (;;) {
 *         Link_receive(&link, bytes, size, nowUs());   (bytes from the radio, if any)
 *         Link_poll(&link, nowUs());
 *         if (Link_openChannel(&link, 0) == LINK_OK)   (once; then, as often as wanted:)
 *             Link_send(&link, 0, message, 12, 0);
 *         sleep(Link_deadline(&link, nowUs()));        (or until the radio brings something)
 *     }
 *
 * The same source runs in the firmware and in the ground's plugin. Wire format: docs/link.md;
 * sizes, times and what is built: link_config.h.
 *
 * The layer owns no thread, no clock and no memory: the caller supplies the time in microseconds
 * (32 bits, it may wrap), calls Link_poll when Link_deadline is due, and keeps the Link object.
 * One Link is used by one thread at a time. A callback may call Link_send, Link_openChannel and
 * Link_closeChannel, and no other function of this layer.
 */
#pragma once

#include "link_frame.h"
#include "link_port.h"

#include <stddef.h>

typedef enum Link_Status {
    LINK_OK = 0,
    LINK_DOWN, /* no session with the peer */
    LINK_FULL, /* no room in the send queue now, or the channel is still being closed: try later */
    LINK_TOO_LONG, /* more than LINK_MAX_MESSAGE bytes, or no byte */
    LINK_CLOSED    /* the channel does not exist, or neither side has opened it */
} Link_Status;

typedef struct Link Link; /* complete below, so that callers can place it; its fields are private */

/* Prepares `link`. `port` must stay valid; `byteTimeUs16` is the time of one byte on the slowest
 * part of the way, in 1/16 microseconds (111,111 baud: 1440), used for pacing and timers. */
void Link_init(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16);

#ifndef LINK_MINIMAL
/* Prepares a link of other sizes, which may have LINK_SIZE of them only, aligned as a Link.
 * `sendBytes`, a power of two, takes the place of LINK_SEND_BYTES, so that it sends messages of
 * sendBytes - LINK_RESERVE - LINK_CHECK bytes at most; `maxMessage` that of LINK_MAX_MESSAGE for
 * messages that come; `window` that of LINK_WINDOW. */
void Link_initSmall(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16,
                    U32 sendBytes, U32 maxMessage, U32 window);
#define LINK_SIZE(sendBytes, maxMessage, window)                                         \
    (LINK_FIXED + (sendBytes) + (window) * (sizeof(Link_Fragment) + sizeof(Link_Slot)) + \
     LINK_ROOM(maxMessage))

/* Limits frames to `bytes` from now on, 32 (under a key 59) to LINK_MAX_FRAME: a modem that
 * encrypts splits packets longer than LINK_MAX_ENCRYPTED. The two sides may differ. */
void Link_limitFrame(Link* link, U32 bytes);

/* Gives the vehicle's key, LINK_KEY_BYTES bytes that both sides have, for slot 0 or 1; it is
 * copied. `side` is the vehicle's address, plus LINK_GROUND on the ground: a session is made only
 * between a ground and the vehicle with the address that it means, whoever else has the key.
 * `key` 0 wipes the slot, and ends a session that was made with it. From the first key on
 * sessions are authenticated and encrypted, and a peer without the key is refused. There is no way
 * back: with both slots wiped there is no session. The layer sends HELLO under the keys of both
 * slots in turn and answers one under either. Call it after Link_init. */
void Link_setKey(Link* link, int slot, const U8* key, U32 side);

/* Returns the slot of the key that the present session was made with; -1: there is no session, or
 * one without a key. */
int Link_keyInUse(const Link* link);
#endif

/* Starts the handshake. Both sides may do so; either one's HELLO makes the session. A side that
 * never calls it still answers a HELLO. After the peer has vanished the layer goes back to
 * CONNECTING. */
void Link_start(Link* link, U32 nowUs);

/* Ends the session: tells the peer, reports messages in flight as LINK_UNKNOWN, goes to IDLE. */
void Link_stop(Link* link, U32 nowUs);

Link_State Link_state(const Link* link);

/* Opens a channel, for both directions; the peer's `channel` callback says so. Returns LINK_OK,
 * LINK_DOWN, LINK_FULL or LINK_CLOSED. */
Link_Status Link_openChannel(Link* link, int channel);

/* Closes a channel behind the messages that were sent before; it needs no room in the queue.
 * Returns LINK_OK, LINK_DOWN, or LINK_CLOSED: it was not open. */
Link_Status Link_closeChannel(Link* link, int channel);

#ifndef LINK_MINIMAL
/* Says how many packets may wait for the radio's answer (Link_answer) from now on; 0: it gives
 * none. The answers pace packets, and what a lost one held goes out again at once. Two fill the
 * air, if the line to the modem is faster: one is on the air, one behind it. A line of 111,111 baud
 * needs three. A call waits for all of them. */
void Link_expectAnswers(Link* link, U32 packets);

/* Has a link use the same radio as another: their packets wait for its answers together, and a call
 * of Link_answer for either is for the oldest of all. It follows Link_init of both; each one's
 * Link_expectAnswers says the same. */
void Link_shareRadio(Link* link, Link* with);

/* Returns the modem's RN that suits what is sent and heard now: the least exponent of its random
 * wait before the first try. Who talks alone does not wait (next to nothing where the modem
 * encrypts: a packet takes 16 ms instead of 10 then, and one that an interferer of a fixed period
 * has hit would be hit again and again). Two streams wait longest, or they would begin together;
 * but not where many packets are lost without failed tries: the far modem had no work with them,
 * so the two seldom begin together. A stream during which the peer calls leaves room for the
 * calls. So does who sends little where packets are lost: an interferer would meet all that is
 * sent at fixed times. `transmit` may call it. */
U32 Link_randomWait(Link* link);

/* Reports the radio's answer for the oldest packet that has none: its peer has it, or it is lost.
 * The driver says so, too, if the radio does not answer (LINK_ANSWER_LAST). */
void Link_answer(Link* link, int isDelivered, U32 nowUs);
#endif

/* Queues a copy of a message of 1..LINK_MAX_MESSAGE bytes. `tag` is for the `outcome` callback. */
Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag);

/* Takes bytes from the radio, at least one, in any portions: packet boundaries do not matter.
 * Calls back with the messages that they complete. */
void Link_receive(Link* link, const U8* bytes, U32 size, U32 nowUs);

/* Sends due frames: fragments, acknowledgements, retransmissions, HELLO. */
void Link_poll(Link* link, U32 nowUs);

/* Returns the time in microseconds until Link_poll must be called; 0xFFFFFFFF: no need. */
U32 Link_deadline(const Link* link, U32 nowUs);

/* Returns the counts, which go on counting. */
const Link_Statistics* Link_statistics(const Link* link);

#ifdef LINK_MINIMAL
#include "link_minimal.h"
#else
#include "link_session.h"

/* The parts, from the bottom to the top: each knows those below it only. */
struct Link {
    Link_Output output;
    Link_Session session;
    Link_Input input;
    Link_Receiver receiver;
    Link_Sender sender;
    /* In a small link these are behind its shorter queue. */
    Link_Fragment window[LINK_WINDOW];
    Link_Slot slots[LINK_WINDOW];
    U8 message[LINK_ROOM(LINK_MAX_MESSAGE)];
};
/* Bytes of a link that has none of those, and no queue. */
#define LINK_FIXED (offsetof(Link, sender) + offsetof(Link_Sender, queue.bytes))
#endif
