/* SPDX-License-Identifier: MIT
 *
 * link_config: constants of the link layer that a project may change: in this file, or on the
 * compiler's command line if the constant has an #ifndef. Two peers with different constants are
 * compatible, except for constants marked "both sides". Times are in us, sizes in bytes.
 * Parentheses contain the allowed range.
 */
#pragma once

/* LINK_MINIMAL, if defined, chooses the minimal layer (sw/minimal/link_minimal.h). */
#ifdef LINK_MINIMAL
#define LINK_IS_FULL 0
#else
#define LINK_IS_FULL 1
#endif

/* size of a frame's tag; both sides (4..16; docs/link.md describes the risk of 4) */
#ifndef LINK_TAG
#define LINK_TAG 8U
#endif
#ifndef LINK_OUTCOMES /* minimal layer: 1 if `outcome` and `writable` must be called */
#define LINK_OUTCOMES 0
#endif
/* size of the largest message (1..32,000); a longer one ends the session */
#ifndef LINK_MAX_MESSAGE
#define LINK_MAX_MESSAGE (LINK_IS_FULL ? 8192U : 1024U)
#endif
#ifndef LINK_WINDOW /* number of fragments in flight (a power of two, 8..64) */
#define LINK_WINDOW 64U
#endif
/* Size of the queue of outgoing messages for all channels (a power of two, more than
 * LINK_MAX_MESSAGE and LINK_RESERVE together, at most 32,768). */
#ifndef LINK_SEND_BYTES
#define LINK_SEND_BYTES 16384U
#endif
/* Part of the queue that is reserved for messages of one fragment, so that they need not wait for
 * long messages. */
#define LINK_RESERVE 256U

#ifndef LINK_SEND_MESSAGES /* number of messages, openings and closings in that queue (1..128) */
#define LINK_SEND_MESSAGES 32U
#endif
/* minimal layer: largest payload of a frame (27..95); 90 if the modem encrypts */
#ifndef LINK_LONGEST
#define LINK_LONGEST 95U
#endif

/* Time-out of retransmission: value before the first round trip is measured, and its smallest and
 * largest value. */
#define LINK_RTO_FIRST 600000U
#define LINK_RTO_MIN 60000U /* smallest value (longer than a round trip) */
#define LINK_RTO_MAX 2000000U

/* Delay of an acknowledgement that was not requested; further data restarts the delay (less than
 * LINK_RTO_MIN, otherwise fragments are sent twice). In the middle of a message, LINK_ACK_WITHIN is
 * used instead, because more fragments will arrive. */
#define LINK_ACK_DELAY 30000U
#define LINK_ACK_WITHIN 80000U

/* first interval between HELLOs; each interval is twice the previous one */
#define LINK_HELLO_FIRST 300000U
/* the interval no longer doubles when it has reached this value, that is at 2.4 s */
#define LINK_HELLO_LAST 2000000U
#define LINK_PING_AFTER 5000000U /* silence after which the peer is pinged */
#define LINK_PING_EVERY 200000U  /* interval of pings */
/* silence after which the peer is considered lost (more than LINK_PING_AFTER, below 2^31). The
 * minimal layer uses times with few 1 bits, so that each time fits into an instruction. */
#define LINK_DEAD_AFTER (LINK_IS_FULL ? 9000000U : 0x890000U)

/* Three times that apply with a key, us. If no PING has been answered for LINK_PROOF_AFTER, PINGs
 * are sent at the interval LINK_PROOF_EVERY. If none has been answered for LINK_PROOF_LAST, the
 * peer counts as lost. Other frames do not prove that the peer is there, because an attacker may
 * have recorded them. */
#define LINK_PROOF_AFTER 5000000U
#define LINK_PROOF_EVERY 1000000U
#define LINK_PROOF_LAST 27000000U

/* Age of an unacknowledged fragment at which the session ends (more than LINK_PING_AFTER, below
 * 2^31). Without this limit, the peer could execute a call that its caller has abandoned. */
#define LINK_AGE_LAST 27000000U

/* With a key: shortest interval between answers to HELLO during a session, and lifetime of the
 * nonce in such an answer. A session can be made with the nonce only during its lifetime. */
#define LINK_ANSWER_EVERY 100000U
#define LINK_NONCE_LIFE 9000000U

/* With a key: the session ends, and a new one begins, when one of these numbers is reached:
 * fragments sent (below 2^32 - 256), and frames with a wrong tag. */
#ifndef LINK_LAST_NUMBER
#define LINK_LAST_NUMBER 0xFFFF0000U
#endif
#ifndef LINK_MOST_FAILURES
#define LINK_MOST_FAILURES (LINK_TAG >= 8U ? 0x40000000U : 0x10000U)
#endif

/* Silence after which an incomplete frame is dropped. */
#define LINK_FRAME_GAP (LINK_IS_FULL ? 25000U : 0x6200U)

/* With a key: limit of the work that is spent on garbage that looks like frames: on average one
 * round of Ascon per LINK_ROUND_EVERY us; at once, at most LINK_ROUNDS_AT_ONCE rounds (at least
 * 168, the cost of one handshake frame). */
#define LINK_ROUND_EVERY 30U
#define LINK_ROUNDS_AT_ONCE 1000U

/* Shortest interval between calls of Link_poll. */
#define LINK_POLL_EVERY 1000U  /* while the radio has no room */
#define LINK_OFFER_EVERY 5000U /* while the program does not accept a message */

/* Pacing (docs/simulation.md): time that the modem needs for a packet in addition to its bytes,
 * without and with encryption; time per byte on the air. */
#define LINK_PACKET_US 7250U
#define LINK_PACKET_ENCRYPTED_US 13450U
#define LINK_BYTE_US 32U

/* Wait before the next packet if a frame was heard, in quarters of the airtime of this frame
 * (docs/link.md). */
#define LINK_HEARD_QUARTERS 7U

/* Additional wait after a short packet. Without it, the modem could still hold the short packet
 * when the next packet arrives, and join both. */
#define LINK_SHORT_MARGIN 1500U

/* largest number of packets that wait for a result of the radio, for all links of the radio
 * together */
#define LINK_MOST_WAITING 4U

/* While the peer calls, the next packet of a stream is passed to the radio this long before the
 * next result of the radio is expected. The value is the time of the packet on a line of 250,000
 * baud (4.2 ms) and a margin. */
#define LINK_HAND_OVER_US 4500U

/* Time after which a driver counts a packet without a result as lost. */
#define LINK_ANSWER_LAST 3000000U

/* Choice of RN (Link_randomWait). The bytes in each span of time are counted; the air carries about
 * 5,000 bytes in a span. A stream begins with a span of at least LINK_SPAN_MANY bytes from one
 * side, and ends with a span of fewer than LINK_SPAN_FEW bytes. A loss affects the choice for a
 * limited time. */
#define LINK_WAIT_SHARED 2U /* RN that the modem has after set-up */
/* share of packets lost without retries above which such losses count as frequent; 65,536 means all
 * packets */
#define LINK_QUICK_MANY 12288U
#define LINK_SPAN 500000U
#define LINK_SPAN_MANY 1000U
#define LINK_SPAN_FEW 500U
#define LINK_LOSS_COUNTS 10000000U

/* Longest pause after a loss if neither side sends a stream: value after the first loss, and limit.
 * Four times the peer's silence is added to the limit. */
#define LINK_REST_FIRST 8000U
#define LINK_REST_LAST 200000U

/* silence after which the modem sends an incomplete packet, in character times */
#define LINK_SILENCE 4U

#if LINK_TAG < 4 || LINK_TAG > 16
#error "LINK_TAG: expected 4 to 16 bytes"
#elif LINK_WINDOW < 8 || LINK_WINDOW > 64 || (LINK_WINDOW & (LINK_WINDOW - 1))
#error "LINK_WINDOW: expected a power of two, 8 to 64"
#elif LINK_MAX_MESSAGE < 1 || LINK_MAX_MESSAGE > 32000
#error "LINK_MAX_MESSAGE: expected 1 to 32000 bytes"
#elif LINK_SEND_BYTES <= LINK_MAX_MESSAGE + LINK_RESERVE || LINK_SEND_BYTES > 32768 || \
    (LINK_SEND_BYTES & (LINK_SEND_BYTES - 1))
#error "LINK_SEND_BYTES: expected a power of two up to 32768, above LINK_MAX_MESSAGE + LINK_RESERVE"
#elif LINK_SEND_MESSAGES < 1 || LINK_SEND_MESSAGES > 128
#error "LINK_SEND_MESSAGES: expected 1 to 128"
#elif LINK_RTO_MIN > LINK_RTO_FIRST || LINK_RTO_FIRST > LINK_RTO_MAX
#error "LINK_RTO_FIRST: expected LINK_RTO_MIN to LINK_RTO_MAX"
#elif LINK_PING_AFTER >= LINK_DEAD_AFTER || LINK_PROOF_AFTER >= LINK_PROOF_LAST
#error "LINK_PING_AFTER, LINK_PROOF_AFTER: expected less than LINK_DEAD_AFTER, LINK_PROOF_LAST"
#endif
