/* SPDX-License-Identifier: MIT
 *
 * link_frame: the fields of a frame, and the checksums and numbers of the wire format
 * (docs/link.md). The full layer and the minimal layer share this file.
 */
#pragma once

#include "base.h"
#include "link_config.h"

#define LINK_CHANNELS 4
#define LINK_MAX_FRAME 100U    /* largest RF packet, bytes: 5 of overhead, up to 95 of payload */
#define LINK_MAX_ENCRYPTED 95U /* largest RF packet of a modem that encrypts (Link_limitFrame) */
#define LINK_KEY_BYTES 16U
/* flag in `side` of Link_setKey that selects the ground; without it, the vehicle */
#define LINK_GROUND 0x80000000U
#define LINK_KEYS 2 /* number of key slots; two, so that a new key can replace the old one */

#define LINK_VERSION 9U
#define LINK_VERSION_UP 0x80U /* flag in a HELLO with a key: the sender has a session */
#define LINK_HEADER 3U
#define LINK_CRC 2U
#define LINK_BITMAP 8U /* largest bitmap of an acknowledgement, bytes */
#define LINK_OVERHEAD (LINK_HEADER + LINK_CRC)
#define LINK_MAX_PAYLOAD 95U
#define LINK_SECURE_OVERHEAD (LINK_HEADER + LINK_TAG)
#define LINK_TAG_MORE (LINK_TAG - LINK_CRC)
#define LINK_MAX_OVERHEAD (LINK_HEADER + 16U)

/* Byte 0. */
#define LINK_CONTROL 0x80U
#define LINK_LENGTH_OF(header) ((header) & 0x7FU)
#define LINK_LENGTH(frame) LINK_LENGTH_OF((frame)[0])
#define LINK_FILL 0xFFU /* padding byte; stands where a frame would begin */

/* Byte 2 of a data frame: flags, channel and epoch. Byte 2 of a control frame: its kind. */
#define LINK_FIRST 0x80U
#define LINK_LAST 0x40U
#define LINK_ACK_NOW 0x20U
/* bit of EPOCH that is inverted if the frame is a complete message that may be delivered out of
 * order */
#define LINK_READY 0x10U
/* flag of a received frame: it is a complete message that may be delivered out of order */
#define LINK_EARLY 0x100U
#define LINK_CHANNEL(flags) ((flags) & 3U)
#define LINK_EPOCH(frame) ((U32)(frame)[2] >> 2 & 7U)
#define LINK_KIND_BITS(kind) ((U32)(kind) << 5)

/* Makes a number from the three bytes of a header, low byte first. */
#define LINK_HEADER_OF(byte0, byte1, byte2) ((byte0) | (U32)(byte1) << 8 | (U32)(byte2) << 16)
#define LINK_CONTROL_HEADER(kind, byte1, size) \
    LINK_HEADER_OF(LINK_CONTROL | (size), byte1, LINK_KIND_BITS(kind))

/* Features: low bits of byte 2 of HELLO and HELLO-ACK. A session uses the features that both sides
 * set. */
#define LINK_FEATURE_COMPRESSION 1U
#define LINK_FEATURE_PIGGYBACK 2U
#define LINK_FEATURES (LINK_FEATURE_COMPRESSION | LINK_FEATURE_PIGGYBACK)
/* flag in byte 2 of a PING with a key: this PING answers another PING */
#define LINK_PING_ANSWER 1U

typedef enum Link_Kind {
    LINK_KIND_ACK,
    LINK_KIND_HELLO,
    LINK_KIND_HELLO_ACK,
    LINK_KIND_RST,
    LINK_KIND_BYE,
    LINK_KIND_PING,
    LINK_KIND_PIGGYBACK, /* complete message of one fragment, together with an acknowledgement */
    /* like PIGGYBACK, but the receiver must acknowledge at once (LINK_ACK_NOW) */
    LINK_KIND_PIGGYBACK_ASK,
    LINK_KIND_DATA /* value that stands for frames that are not control frames */
} Link_Kind;

#define LINK_KIND_OF(frame) \
    ((frame)[0] & LINK_CONTROL ? (Link_Kind)((frame)[2] >> 5) : LINK_KIND_DATA)

/* Key of a session, computed from both nonces: the epoch is in bits 31..29, the seed of the CRCs in
 * bits 15..0. HELLO, HELLO-ACK and RST have a seed of all ones. */
#define LINK_KEY_EPOCH(key) ((key) >> 29)
#define LINK_EPOCH_KEY(epoch) ((U32)(epoch) << 29)
#define LINK_NO_SEED 0xFFFFU
/* with a key: answer to a HELLO-ACK; has the number of RST, which is only used without a key */
#define LINK_KIND_CONFIRM LINK_KIND_RST
#define LINK_IS_PIGGYBACK(kind) ((U32)(kind) - (U32)LINK_KIND_PIGGYBACK <= 1U)
#define LINK_IS_HANDSHAKE(kind) ((U32)(kind) - (U32)LINK_KIND_HELLO <= 2U)

/* Reads the check of LINK_CHECK bytes at the end of a message of more than LINK_UNCHECKED bytes. */
#define LINK_CHECK_AT(p) ((p)[0] | (U32)(p)[1] << 8)
#define LINK_UNCHECKED 20U
#define LINK_CHECK 2U

/* Returns whether time or count `a` is before `b`. Both may wrap around (serial arithmetic, RFC
 * 1982). */
#define LINK_BEFORE(a, b) ((S32)((a) - (b)) < 0)

/* Returns the CRC-16/CCITT of `size` bytes, with the low 16 bits of `key` as the seed. For an
 * intact frame including its CRC, the result is 0. */
U32 link_crc(U32 key, const U8* bytes, U32 size);

/* Completes a frame with its payload already in `frame`: adds the epoch of `key` to `header`,
 * writes the header before the payload, and appends the CRC. Returns the frame's size in bytes. */
U32 link_seal(U8* frame, U32 header, U32 key);

/* Continues the check of a message with `size` bytes; for the first bytes, `sums` is 0. The check
 * consists of Fletcher's two sums; a message contains the low byte first. */
U32 link_sum(U32 sums, const U8* bytes, U32 size);

/* Read and write 32 bits, low byte first. */
U32 link_get32(const U8* p);
void link_put32(U8* p, U32 value);

/* Returns the key of the session that has these two nonces. Their order does not matter. */
U32 link_sessionKey(U32 nonce, U32 peerNonce);

/* Returns the number nearest to `expected` among the numbers with the lowest byte `byte`. */
U32 link_extend(U32 expected, U32 byte);

/* Returns the bits of EPOCH in which a frame differs from the epoch in `key`. */
U32 link_epochBits(const U8* frame, U32 key);

/* Returns whether a frame has the epoch of this session key and does not belong to a handshake. */
int link_isOfEpoch(const U8* frame, U32 key);
