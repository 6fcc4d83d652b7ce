/* SPDX-License-Identifier: MIT
 *
 * link_secure: derives the keys of handshakes and sessions (docs/link.md).
 */
#include "link_wire.h"

#include "ascon.h"
#include "x25519.h"

#include <string.h>

/* Makes the keystream of a nonce. It is never sent as such, so an attacker who learns one learns
 * nothing of another. */
static void derive(const U8* secret, const U8* nonce, U8* text, U32 size) {
    U8 tag[ASCON_TAG_BYTES];
    Ascon ascon;
    memset(text, 0, size);
    Ascon_begin(&ascon, secret, nonce);
    Ascon_crypt(&ascon, text, size, 0);
    Ascon_end(&ascon, secret, tag);
}

/* The vehicle's nonce and key come first: two sides of one role make different keys. */
void link_deriveKeys(const Link_Secrets* secrets, int slot, const U8* nonce, const U8* peerNonce,
                     Link_Keys* keys) {
    U8 both[ASCON_NONCE_BYTES];
    U8 text[2U * LINK_KEY_BYTES];
    int isFirst = !secrets->isGround;
    memcpy(both, isFirst ? nonce : peerNonce, LINK_NONCE_BYTES);
    memcpy(both + LINK_NONCE_BYTES, isFirst ? peerNonce : nonce, LINK_NONCE_BYTES);
    derive(secrets->key[slot], both, text, sizeof text);
    memcpy(isFirst ? keys->send : keys->receive, text, LINK_KEY_BYTES);
    memcpy(isFirst ? keys->receive : keys->send, text + LINK_KEY_BYTES, LINK_KEY_BYTES);
    Ascon_wipe(text, sizeof text);
}

void link_makePair(Link_Pair* pair, const Link_Port* port, void* context) {
    U32 i;
    if (pair->isMade)
        return;
    for (i = 0; i < sizeof pair->own; i += 4U)
        link_put32(pair->own + i, port->random(context));
    X25519(pair->open, pair->own, 0);
    pair->isMade = 1;
}

/* Both inputs are needed: the handshake's keys follow from the secret, `shared` from an own half.
 */
void link_mixKeys(Link_Keys* keys, Link_Pair* pair, const U8* peerOpen, int isGround) {
    U8 shared[X25519_BYTES], text[2U * LINK_KEY_BYTES];
    U8* send = text + (isGround ? LINK_KEY_BYTES : 0);
    U8* receive = text + (isGround ? 0 : LINK_KEY_BYTES);
    U32 i;
    X25519(shared, pair->own, peerOpen);
    derive(shared, shared + LINK_KEY_BYTES, text, sizeof text);
    for (i = 0; i < LINK_KEY_BYTES; ++i) {
        keys->send[i] = (U8)(keys->send[i] ^ send[i]);
        keys->receive[i] = (U8)(keys->receive[i] ^ receive[i]);
    }
    Ascon_wipe(shared, sizeof shared);
    Ascon_wipe(text, sizeof text);
    Ascon_wipe(pair->own, sizeof pair->own);
    pair->isMade = 0;
}

/* The key of HELLOs comes from the nonces 0, which no session has. */
void link_setSecret(Link_Secrets* secrets, int slot, const U8* key, U32 side) {
    U8 nonce[ASCON_NONCE_BYTES];
    Ascon_wipe(secrets->key[slot], LINK_KEY_BYTES);
    Ascon_wipe(secrets->hello[slot], LINK_KEY_BYTES);
    secrets->set = (U8)(secrets->set & ~(1U << slot));
    if (!key)
        return;
    secrets->isGround = (side & LINK_GROUND) != 0;
    memset(nonce, 0, sizeof nonce);
    link_put32(nonce, side & ~LINK_GROUND);
    derive(key, nonce, secrets->key[slot], LINK_KEY_BYTES);
    memset(nonce, 0, sizeof nonce);
    derive(secrets->key[slot], nonce, secrets->hello[slot], LINK_KEY_BYTES);
    secrets->set = (U8)(secrets->set | 1U << slot);
}
