/* SPDX-License-Identifier: MIT
 *
 * link_frame: names the fields of a frame, and declares checksums and numbers of the wire format
 * (docs/link.md). The full layer and the minimal one share it.
 */
#pragma once

#include "base.h"
#include "link_config.h"
#include "link_port.h"

#define LINK_CHANNELS 4
#define LINK_MAX_FRAME 100U    /* bytes of one RF packet: 5 of overhead and up to 95 of payload */
#define LINK_MAX_ENCRYPTED 95U /* the same if the modem encrypts (Link_limitFrame) */
#define LINK_KEY_BYTES 16U
/* The role of this side in Link_setKey, beside the vehicle's address; without it: the vehicle's. */
#define LINK_GROUND 0x80000000U
#define LINK_KEYS 2 /* slots for keys, so that a new key can replace the old one */

#define LINK_VERSION 9U
#define LINK_VERSION_UP 0x80U /* with it: HELLO of a side that has a session, under a key */
#define LINK_HEADER 3U
#define LINK_CRC 2U
#define LINK_BITMAP 8U /* bytes of an acknowledgement's bitmap, at most */
#define LINK_OVERHEAD (LINK_HEADER + LINK_CRC)
#define LINK_MAX_PAYLOAD 95U
#define LINK_SECURE_OVERHEAD (LINK_HEADER + LINK_TAG)
#define LINK_TAG_MORE (LINK_TAG - LINK_CRC)
#define LINK_MAX_OVERHEAD (LINK_HEADER + 16U)

/* Byte 0. */
#define LINK_CONTROL 0x80U
#define LINK_LENGTH_OF(header) ((header)&0x7FU)
#define LINK_LENGTH(frame) LINK_LENGTH_OF((frame)[0])
#define LINK_FILL 0xFFU /* in its place: no frame, but a byte that fills a packet up */

/* Byte 2: the flags of data frames, the channel and epoch, the kind of control frames. */
#define LINK_FIRST 0x80U
#define LINK_LAST 0x40U
#define LINK_ACK_NOW 0x20U
#define LINK_READY 0x10U  /* inverted: a whole message that may be taken before its turn */
#define LINK_EARLY 0x100U /* the same among the flags of a frame that came */
#define LINK_CHANNEL(flags) ((flags)&3U)
#define LINK_EPOCH(frame) ((U32)(frame)[2] >> 2 & 7U)
#define LINK_KIND_BITS(kind) ((U32)(kind) << 5)

/* The three bytes of a header as a number, the low byte first. */
#define LINK_HEADER_OF(byte0, byte1, byte2) ((byte0) | (U32)(byte1) << 8 | (U32)(byte2) << 16)
#define LINK_CONTROL_HEADER(kind, byte1, size) \
    LINK_HEADER_OF(LINK_CONTROL | (size), byte1, LINK_KIND_BITS(kind))

/* A feature is a low bit of byte 2 of HELLO and HELLO-ACK; it is used if both sides set it. */
#define LINK_FEATURE_COMPRESSION 1U
#define LINK_FEATURE_PIGGYBACK 2U
#define LINK_PING_ANSWER 1U /* with a key: the same bit of a PING that answers one */

typedef enum Link_Kind {
    LINK_KIND_ACK,
    LINK_KIND_HELLO,
    LINK_KIND_HELLO_ACK,
    LINK_KIND_RST,
    LINK_KIND_BYE,
    LINK_KIND_PING,
    LINK_KIND_PIGGYBACK,     /* a whole message of one fragment, with an acknowledgement */
    LINK_KIND_PIGGYBACK_ASK, /* the same, with LINK_ACK_NOW */
    LINK_KIND_DATA           /* not a control frame */
} Link_Kind;

#define LINK_KIND_OF(frame) \
    ((frame)[0] & LINK_CONTROL ? (Link_Kind)((frame)[2] >> 5) : LINK_KIND_DATA)

/* A session's key, of both nonces: bits 31..29 are the epoch, bits 15..0 the seed of the CRCs. The
 * seed of HELLO, HELLO-ACK and RST is all ones. */
#define LINK_KEY_EPOCH(key) ((key) >> 29)
#define LINK_EPOCH_KEY(epoch) ((U32)(epoch) << 29)
#define LINK_NO_SEED 0xFFFFU
#define LINK_KIND_CONFIRM LINK_KIND_RST /* with a key: the answer to HELLO-ACK; there is no RST */
#define LINK_IS_RIDE(kind) ((U32)(kind) - (U32)LINK_KIND_PIGGYBACK <= 1U)
#define LINK_IS_HANDSHAKE(kind) ((U32)(kind) - (U32)LINK_KIND_HELLO <= 2U)

/* A message of more than LINK_UNCHECKED bytes ends with LINK_CHECK bytes of check. */
#define LINK_CHECK_AT(p) ((p)[0] | (U32)(p)[1] << 8)
#define LINK_UNCHECKED 20U
#define LINK_CHECK 2U

/* True if time or count `a` precedes `b`; both may wrap (serial arithmetic, RFC 1982). */
#define LINK_BEFORE(a, b) ((S32)((a) - (b)) < 0)

/* Returns the CRC-16/CCITT of `size` bytes from the low 16 bits of `key` on; over a frame with its
 * own CRC the result is 0. */
U32 link_crc(U32 key, const U8* bytes, U32 size);

/* Writes header and CRC around the payload that `frame` already holds; the epoch of `key` is added
 * to `header`. Returns the frame's length in bytes. */
U32 link_seal(U8* frame, U32 header, U32 key);

/* Continues a message's check over `size` bytes more, from 0 on: Fletcher's two sums, which a
 * message carries low byte first. */
U32 link_sum(U32 sums, const U8* bytes, U32 size);

/* Read and write 32 bits, the low byte first. */
U32 link_get32(const U8* p);
void link_put32(U8* p, U32 value);

/* Returns the key of the session of two nonces, in either order. */
U32 link_sessionKey(U32 nonce, U32 peerNonce);

/* link_crypto derives a session's keys, link_codec_keyed encrypts frames under them (docs/link.md).
 */

#define LINK_NONCE_BYTES 8U /* of each side's nonce in a secure handshake */
#define LINK_OPEN_BYTES 32U /* of the open half of a pair, which HELLO-ACK and CONFIRM carry */
#define LINK_OPEN_AT (LINK_HEADER + 2U * LINK_NONCE_BYTES)          /* its place there, encrypted */
#define LINK_ANSWER_BYTES (2U * LINK_NONCE_BYTES + LINK_OPEN_BYTES) /* of their payload */

/* The keys of a session: of what the vehicle sends, then of what the ground sends. */
typedef struct Link_Keys {
    U8 bytes[2U * LINK_KEY_BYTES];
} Link_Keys;

/* A secret of a Link, which follows from a given key and the vehicle's address. */
typedef struct Link_Secret {
    U8 key[LINK_KEY_BYTES];
    U8 hello[LINK_KEY_BYTES]; /* of HELLOs; it follows from the first */
} Link_Secret;

/* A pair makes the keys of one session, and is wiped then: who learns the secrets later, from
 * either side, cannot make them. */
typedef struct Link_Pair {
    U8 isMade;
    U8 own[LINK_OPEN_BYTES], open[LINK_OPEN_BYTES];
} Link_Pair;

/* Makes a secret of the vehicle's key and address. */
void link_makeSecret(Link_Secret* secret, const U8* key, U32 address);

/* Makes the keys of the handshake of both sides' nonces, LINK_NONCE_BYTES each. */
void link_deriveKeys(const Link_Secret* secret, const U8* vehicles, const U8* grounds,
                     Link_Keys* keys);

/* Makes a pair, if there is none, of 32 random bytes. It takes long (docs/link.md), and so does
 * link_mixKeys: both are called only for a peer that has the key, once a session. */
void link_makePair(Link_Pair* pair, const Link_Port* port, void* context);

/* Makes the handshake's keys those of the session, with the peer's half of its pair. Wipes the own
 * half; `open` stays. */
void link_mixKeys(Link_Keys* keys, Link_Pair* pair, const U8* peerOpen);

/* Encrypts or decrypts bytes in their place, and computes their tag of 16 bytes. */
void link_cipher(const U8* key, const U8* nonce, U8* bytes, U32 size, int isDecryption, U8* tag);

/* Returns the number whose lowest byte is `byte`, as near to the expected one as can be. */
U32 link_extend(U32 expected, U32 byte);

/* Writes the header, which comes with its epoch and the payload's length, encrypts the payload that
 * `frame` already holds, and adds the tag. `number` has byte 1 as its lowest byte; `acked`
 * has the first byte of the payload of a PIGGYBACK. Returns the frame's length in bytes. */
U32 link_protect(U8* frame, U32 header, const U8* key, U32 number, U32 acked);

/* Decrypts the payload of a whole frame, of LINK_SECURE_OVERHEAD bytes at least, in its place, and
 * gives its header the payload's length. Returns 0: its tag is wrong; then all of it is wiped. */
int link_unprotect(U8* frame, const U8* key, U32 number, U32 acked);
