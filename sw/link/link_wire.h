/* SPDX-License-Identifier: MIT
 *
 * link_wire: the wire format (docs/link.md), for the full layer and the minimal one alike.
 */
#ifndef LINK_WIRE_H
#define LINK_WIRE_H

#define LINK_OVERHEAD 5U
#define LINK_MAX_PAYLOAD 95U
#define LINK_VERSION 3U

/* A message that travels in more bytes than these ends with a check over the whole. */
#define LINK_UNCHECKED 20U
#define LINK_CHECK 2U

/* Byte 0 and byte 2 of a frame. */
#define LINK_CONTROL 0x80U
#define LINK_FIRST 0x80U
#define LINK_LAST 0x40U
#define LINK_ACK_NOW 0x20U

/* What a side understands, in bits 1..0 of byte 2 of HELLO and HELLO-ACK; used if both do. */
#define LINK_FEATURE_HEADS 1U
#define LINK_FEATURE_RIDE 2U
#define LINK_NO_SEED 0xFFFFU /* of the checksums outside a session */

typedef enum Link_Kind {
    LINK_KIND_ACK,
    LINK_KIND_HELLO,
    LINK_KIND_HELLO_ACK,
    LINK_KIND_RST,
    LINK_KIND_BYE,
    LINK_KIND_PING,
    LINK_KIND_RIDE,     /* a whole message of one fragment with an acknowledgement */
    LINK_KIND_RIDE_ASK, /* the same with LINK_ACK_NOW */
    LINK_KIND_DATA      /* no control frame */
} Link_Kind;

/* Of two times, or two counts, that wrap. */
#define LINK_BEFORE(a, b) ((S32)((a) - (b)) < 0)

/* link_bytes.c */

/* CRC-16/CCITT; over a frame with its checksum the result is 0. */
U16 Link_crc(U16 seed, const U8* bytes, U32 size);
/* Fletcher's sums of a message: `size` bytes more. */
void Link_sum(U8 sums[2], const U8* bytes, U32 size);
/* 32 bits, the low byte first. */
U32 Link_get32(const U8* p);
void Link_put32(U8* p, U32 value);
/* What both sides compute from their nonces, whoever called first: the seed of a session's
 * checksums; the result is its epoch. */
U32 Link_mixNonces(U32 nonce, U32 peerNonce, U16* seed);

#endif
