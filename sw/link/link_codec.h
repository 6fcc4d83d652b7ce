/* SPDX-License-Identifier: MIT
 *
 * link_codec: seals frames before they are sent, and opens frames that arrive. A codec works on the
 * bytes of one frame with the key and the numbers that the caller supplies. It keeps no state and
 * knows nothing about sessions.
 */
#pragma once

#include "link_crypto.h"
#include "link_frame.h"

/* Secrets of a session. Both are wiped when the session ends. */
typedef struct Link_SessionSecrets {
    Link_Keys keys;                  /* keys of the session's frames */
    Link_Keys handshake;             /* keys of its handshake's frames */
    U8 publicKey[LINK_PUBLIC_BYTES]; /* own public key, as the handshake's frames carry it */
} Link_SessionSecrets;

/* Identity of a session: both nonces, and the values that follow from them. */
typedef struct Link_Identity {
    U32 key;                        /* epoch in bits 31..29, seed of CRCs in bits 15..0 */
    U8 features;                    /* features that both sides have */
    U8 slot;                        /* slot of the key that made the session; 0 without a key */
    U8 isGround;                    /* this side is the ground; 0 without a key */
    U8 nonce[LINK_NONCE_BYTES];     /* own nonce; without a key its first 4 bytes */
    U8 peerNonce[LINK_NONCE_BYTES]; /* the peer's, likewise */
    Link_SessionSecrets secrets;    /* unused without a key */
} Link_Identity;

/* Select the key for frames that this side sends, or that its peer sends. */
#define LINK_OWN_KEY(identity, which) \
    ((identity)->secrets.which.bytes + LINK_KEY_BYTES * (U32)(identity)->isGround)
#define LINK_PEERS_KEY(identity, which) \
    ((identity)->secrets.which.bytes + LINK_KEY_BYTES * (1U ^ (identity)->isGround))

/* Key and numbers of one frame. */
typedef struct Link_Seal {
    const U8* key; /* LINK_KEY_BYTES bytes; ignored by the clear codec */
    U32 session;   /* Link_Identity.key, or its epoch with LINK_NO_SEED */
    U32 number;    /* number with byte 1 of the frame as its lowest byte */
    U32 acked;     /* number that a PIGGYBACK acknowledges; otherwise 0 */
} Link_Seal;

typedef struct Link_Codec {
    U8 overhead;        /* bytes of a frame in addition to its payload */
    U8 nonceBytes;      /* bytes of each side's nonce in the handshake */
    U8 check;           /* bytes of check after a message of more than LINK_UNCHECKED bytes */
    U8 isAuthenticated; /* 1: a valid tag makes a false match negligible; PINGs are numbered */
    U8 sizes[6];        /* payload bytes of control frames up to PING, by Link_Kind */
    /* Adds the session's epoch to `header`, writes it before the payload that `frame` already
     * holds, and completes the frame. Returns its size in bytes. */
    U32 (*seal)(U8* frame, U32 header, const Link_Seal* seal);
    /* Checks a complete frame of at least `overhead` bytes, and decrypts it into `copy`, of
     * LINK_MAX_FRAME bytes. Returns the frame, with the payload's length in its header, in one of
     * the two places; 0 if checksum or tag is wrong. */
    const U8* (*open)(const U8* frame, U8* copy, const Link_Seal* seal);
} Link_Codec;
