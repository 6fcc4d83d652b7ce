/* SPDX-License-Identifier: MIT
 *
 * link_codec: seals frames before they are sent, and opens frames that arrive. A codec works on the
 * bytes of one frame, with a key and numbers from the caller. It has no state and does not depend
 * on sessions.
 */
#pragma once

#include "link_crypto.h"
#include "link_frame.h"

/* Keys of a session, which are wiped when the session ends. */
typedef struct Link_SessionSecrets {
    Link_Keys keys;      /* keys for the session's frames */
    Link_Keys handshake; /* keys for the handshake's frames */
    /* public key of this side, as it is sent in frames of the handshake */
    U8 publicKey[LINK_PUBLIC_BYTES];
} Link_SessionSecrets;

/* Identity of a session: both nonces, and values that are derived from them. */
typedef struct Link_Identity {
    U32 key;     /* key of the session: epoch in bits 31..29, seed of the CRCs in bits 15..0 */
    U8 features; /* features that both sides support */
    U8 slot;     /* slot of the key with which the session was made; 0 without a key */
    U8 isGround; /* 1: this side is the ground station; 0 without a key */
    /* nonce of this side; without a key, only the first 4 bytes are used */
    U8 nonce[LINK_NONCE_BYTES];
    /* nonce of the peer; without a key, only the first 4 bytes are used */
    U8 peerNonce[LINK_NONCE_BYTES];
    Link_SessionSecrets secrets; /* secrets of the session; unused without a key */
} Link_Identity;

/* Return the key for frames that this side sends, and the key for frames that the peer sends. */
#define LINK_OWN_KEY(identity, which) \
    ((identity)->secrets.which.bytes + LINK_KEY_BYTES * (U32)(identity)->isGround)
#define LINK_PEERS_KEY(identity, which) \
    ((identity)->secrets.which.bytes + LINK_KEY_BYTES * (1U ^ (identity)->isGround))

/* Key and numbers of one frame. */
typedef struct Link_Seal {
    const U8* key; /* key of LINK_KEY_BYTES bytes; ignored by the clear codec */
    U32 session;   /* Link_Identity.key, or LINK_NO_SEED with the epoch */
    U32 number;    /* number of the frame; byte 1 of the frame is its lowest byte */
    U32 acked;     /* number that a PIGGYBACK acknowledges; otherwise 0 */
} Link_Seal;

typedef struct Link_Codec {
    U8 overhead;   /* size of a frame without its payload, bytes */
    U8 nonceBytes; /* size of each side's nonce in the handshake, bytes */
    U8 check;      /* size of the check that follows a message of more than LINK_UNCHECKED bytes */
    /* 1 if frames have a tag. A wrong frame is then practically never accepted, and PINGs are
     * numbered. */
    U8 isAuthenticated;
    U8 sizes[6]; /* payload sizes of control frames up to PING, indexed by Link_Kind, bytes */
    /* Completes a frame with its payload already in `frame`: adds the session's epoch to `header`,
     * writes the header before the payload, and adds the CRC or tag. Returns the frame's size in
     * bytes. */
    U32 (*seal)(U8* frame, U32 header, const Link_Seal* seal);
    /* Checks a complete frame of at least `overhead` bytes, and decrypts it, in place or into
     * `copy`, which has LINK_MAX_FRAME bytes. Returns the opened frame; its header contains the
     * length of the payload. Returns 0 if the CRC or tag is wrong. */
    const U8* (*open)(const U8* frame, U8* copy, const Link_Seal* seal);
} Link_Codec;
