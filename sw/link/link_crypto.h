/* SPDX-License-Identifier: MIT
 *
 * link_crypto: derives the keys of handshakes and sessions (docs/link.md), and encrypts bytes.
 */
#pragma once

#include "link_frame.h"

#define LINK_NONCE_BYTES 8U   /* size of each side's nonce in a handshake with a key */
#define LINK_PUBLIC_BYTES 32U /* size of the public key that HELLO-ACK and CONFIRM contain */
/* offset of the public key in HELLO-ACK and CONFIRM */
#define LINK_PUBLIC_AT (LINK_HEADER + 2U * LINK_NONCE_BYTES)
#define LINK_ANSWER_BYTES \
    (2U * LINK_NONCE_BYTES + LINK_PUBLIC_BYTES) /* payload of HELLO-ACK and CONFIRM, bytes */

/* Keys of both directions: first for frames of the vehicle, then for frames of the ground
 * station. */
typedef struct Link_Keys {
    U8 bytes[2U * LINK_KEY_BYTES];
} Link_Keys;

/* Secret of a Link, derived from the key that Link_setKey supplies and the vehicle's address. */
typedef struct Link_Secret {
    U8 key[LINK_KEY_BYTES];
    U8 hello[LINK_KEY_BYTES]; /* key for HELLO frames, derived from the first key */
} Link_Secret;

/* Ephemeral X25519 key pair, for forward secrecy. Only the keys of one session are made with it. */
typedef struct Link_KeyPair {
    U8 privateKey[LINK_PUBLIC_BYTES], publicKey[LINK_PUBLIC_BYTES];
} Link_KeyPair;

/* Derives a link's secret from the vehicle's key and address. */
void link_makeSecret(Link_Secret* secret, const U8* key, U32 address);

/* Derives the keys of a handshake from the nonces of both sides, LINK_NONCE_BYTES bytes each. */
void link_deriveKeys(const Link_Secret* secret, const U8* vehicles, const U8* grounds,
                     Link_Keys* keys);

/* Makes the key pair from 32 random bytes. This function and link_mixKeys take a long time
 * (docs/link.md). Both are called once per session, and only if the peer has the key. */
void link_makePair(Link_KeyPair* pair, U32 (*random)(void* context), void* context);

/* Derives the keys of the session from the keys of the handshake and the public key of the peer.
 * Overwrites the private key of the pair; the public key of the pair remains. */
void link_mixKeys(Link_Keys* keys, Link_KeyPair* pair, const U8* peersPublic);

/* Encrypts or decrypts bytes in place, and computes their tag of 16 bytes. */
void link_cipher(const U8* key, const U8* nonce, U8* bytes, U32 size, int isDecryption, U8* tag);
