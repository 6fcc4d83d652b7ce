/* SPDX-License-Identifier: MIT
 *
 * link_crypto: derives the keys of handshakes and sessions (docs/link.md), and ciphers bytes.
 */
#pragma once

#include "link_frame.h"

#define LINK_NONCE_BYTES 8U   /* nonce of each side in the handshake under a key */
#define LINK_PUBLIC_BYTES 32U /* public key, which HELLO-ACK and CONFIRM carry */
#define LINK_PUBLIC_AT (LINK_HEADER + 2U * LINK_NONCE_BYTES) /* its offset in such a frame */
#define LINK_ANSWER_BYTES                                                  \
    (2U * LINK_NONCE_BYTES + LINK_PUBLIC_BYTES) /* payload of such a frame \
                                                 */

/* Keys of both directions: for frames of the vehicle, then for frames of the ground. */
typedef struct Link_Keys {
    U8 bytes[2U * LINK_KEY_BYTES];
} Link_Keys;

/* Secret of a Link, derived from the key that Link_setKey supplies and the vehicle's address. */
typedef struct Link_Secret {
    U8 key[LINK_KEY_BYTES];
    U8 hello[LINK_KEY_BYTES]; /* key of HELLOs, derived from the first */
} Link_Secret;

/* Ephemeral X25519 pair (forward secrecy). It makes the keys of one session. */
typedef struct Link_KeyPair {
    U8 privateKey[LINK_PUBLIC_BYTES], publicKey[LINK_PUBLIC_BYTES];
} Link_KeyPair;

/* Derives a link's secret from the vehicle's key and address. */
void link_makeSecret(Link_Secret* secret, const U8* key, U32 address);

/* Derives the keys of a handshake from both sides' nonces, of LINK_NONCE_BYTES each. */
void link_deriveKeys(const Link_Secret* secret, const U8* vehicles, const U8* grounds,
                     Link_Keys* keys);

/* Makes the key pair from 32 random bytes. This takes long (docs/link.md), as does link_mixKeys:
 * both are called only for a peer that has the key, once per session. */
void link_makePair(Link_KeyPair* pair, U32 (*random)(void* context), void* context);

/* Derives the keys of the session from the keys of the handshake and the public key of the peer.
 * Overwrites the private key of the pair, and keeps its public key. */
void link_mixKeys(Link_Keys* keys, Link_KeyPair* pair, const U8* peersPublic);

/* Encrypts or decrypts bytes in place, and computes their tag of 16 bytes. */
void link_cipher(const U8* key, const U8* nonce, U8* bytes, U32 size, int isDecryption, U8* tag);
