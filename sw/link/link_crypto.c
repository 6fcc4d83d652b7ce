/* SPDX-License-Identifier: MIT
 *
 * link_crypto: derives keys with Ascon-AEAD128 and X25519.
 */
#include "link_crypto.h"

#include "ascon.h"
#include "x25519.h"

#include <string.h>

void link_cipher(const U8* key, const U8* nonce, U8* bytes, U32 size, int isDecryption, U8* tag) {
    Ascon ascon;
    Ascon_begin(&ascon, key, nonce);
    Ascon_crypt(&ascon, bytes, size, isDecryption);
    Ascon_end(&ascon, key, tag);
}

/* Derives keys: encrypts zeros under a nonce, and uses the keystream as keys. This keystream is
 * never sent, and an attacker who learns one keystream learns nothing about another one. */
static void derive(const U8* secret, const U8* nonce, U8* text, U32 size) {
    U8 tag[ASCON_TAG_BYTES];
    memset(text, 0, size);
    link_cipher(secret, nonce, text, size, 0, tag);
}

void link_deriveKeys(const Link_Secret* secret, const U8* vehicles, const U8* grounds,
                     Link_Keys* keys) {
    U8 nonce[ASCON_NONCE_BYTES];
    memcpy(nonce, vehicles, LINK_NONCE_BYTES);
    memcpy(nonce + LINK_NONCE_BYTES, grounds, LINK_NONCE_BYTES);
    derive(secret->key, nonce, keys->bytes, sizeof keys->bytes);
}

void link_makePair(Link_KeyPair* pair, U32 (*random)(void* context), void* context) {
    U32 i;
    for (i = 0; i < sizeof pair->privateKey; i += 4U)
        link_put32(pair->privateKey + i, random(context));
    X25519(pair->publicKey, pair->privateKey, 0);
}

/* Combines two inputs: the keys of the handshake, which are derived from the shared key, and the
 * result of X25519, which is computed from the private keys. An attacker needs both. */
void link_mixKeys(Link_Keys* keys, Link_KeyPair* pair, const U8* peersPublic) {
    U8 shared[X25519_BYTES], text[sizeof keys->bytes];
    U32 i;
    X25519(shared, pair->privateKey, peersPublic);
    derive(shared, shared + LINK_KEY_BYTES, text, sizeof text);
    for (i = 0; i < sizeof text; ++i)
        keys->bytes[i] = (U8)(keys->bytes[i] ^ text[i]);
    Ascon_wipe(shared, sizeof shared);
    Ascon_wipe(text, sizeof text);
    Ascon_wipe(pair->privateKey, sizeof pair->privateKey);
}

/* The key of HELLO frames is derived with nonces of zeros, which no session uses. */
void link_makeSecret(Link_Secret* secret, const U8* key, U32 address) {
    U8 nonce[ASCON_NONCE_BYTES];
    memset(nonce, 0, sizeof nonce);
    link_put32(nonce, address);
    derive(key, nonce, secret->key, LINK_KEY_BYTES);
    link_put32(nonce, 0);
    derive(secret->key, nonce, secret->hello, LINK_KEY_BYTES);
}
