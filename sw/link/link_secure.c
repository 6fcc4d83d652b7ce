/* SPDX-License-Identifier: MIT
 *
 * link_secure: encrypts and authenticates frames by Ascon-AEAD128, and derives the keys.
 * All parts of a frame that are not encrypted belong to its nonce (docs/link.md).
 */
#include "link_wire.h"

#include "ascon.h"
#include "x25519.h"

#include <string.h>

#define CLEAR_AT 11U  /* start of the payload in clear in a nonce, ... */
#define CLEAR_MOST 5U /* and its greatest size there */

/* Returns the number of payload bytes in clear, which come first: all of a control frame, the
 * acknowledgement of a PIGGYBACK, the nonces of HELLO-ACK and CONFIRM. */
static U32 clearOf(const U8* frame) {
    U32 most = frame[2] >> 5 >= LINK_KIND_PIGGYBACK ? 1U : 2U * LINK_NONCE_BYTES;
    if (!(frame[0] & LINK_CONTROL))
        return 0;
    return LINK_LENGTH(frame) < most ? LINK_LENGTH(frame) : most;
}

static void makeNonce(U8* nonce, const U8* frame, U32 clear, U32 number, U32 acked) {
    U32 kind = (U32)frame[2] >> 5;
    memset(nonce, 0, ASCON_NONCE_BYTES);
    link_put32(nonce, number);
    link_put32(nonce + 4, acked);
    if ((frame[0] & LINK_CONTROL) && LINK_IS_HANDSHAKE(kind))
        memcpy(nonce, frame + LINK_HEADER, LINK_NONCE_BYTES);
    else if (clear > CLEAR_MOST) /* an acknowledgement's: 9 bytes at most */
        memcpy(nonce + 4, frame + LINK_HEADER + CLEAR_MOST,
               clear < LINK_BITMAP + 1U ? clear - CLEAR_MOST : LINK_BITMAP + 1U - CLEAR_MOST);
    memcpy(nonce + 8, frame, LINK_HEADER);
    memcpy(nonce + CLEAR_AT, frame + LINK_HEADER, clear < CLEAR_MOST ? clear : CLEAR_MOST);
}

/* Encrypts or decrypts the payload, and computes its tag. */
static void crypt(U8* frame, const U8* key, U32 number, U32 acked, int isDecryption, U8* tag) {
    U8 nonce[ASCON_NONCE_BYTES];
    U32 clear = clearOf(frame);
    Ascon ascon;
    makeNonce(nonce, frame, clear, number, acked);
    Ascon_begin(&ascon, key, nonce);
    Ascon_crypt(&ascon, frame + LINK_HEADER + clear, LINK_LENGTH(frame) - clear, isDecryption);
    Ascon_end(&ascon, key, tag);
}

U32 link_protect(U8* frame, U32 header, const U8* key, U32 number, U32 acked) {
    U32 size = LINK_LENGTH_OF(header) + LINK_HEADER;
    U8 tag[ASCON_TAG_BYTES];
    frame[0] = (U8)header;
    frame[1] = (U8)(header >> 8);
    frame[2] = (U8)(header >> 16);
    crypt(frame, key, number, acked, 0, tag);
    memcpy(frame + size, tag, LINK_TAG);
    frame[0] = (U8)(frame[0] + LINK_TAG_MORE);
    return size + LINK_TAG;
}

int link_unprotect(U8* frame, const U8* key, U32 number, U32 acked) {
    U32 size = LINK_LENGTH(frame) - LINK_TAG_MORE;
    U8 tag[ASCON_TAG_BYTES];
    frame[0] = (U8)(frame[0] - LINK_TAG_MORE);
    crypt(frame, key, number, acked, 1, tag);
    if (Ascon_isSame(tag, frame + LINK_HEADER + size, LINK_TAG))
        return 1;
    Ascon_wipe(frame + LINK_HEADER + clearOf(frame), size - clearOf(frame));
    frame[0] = (U8)(frame[0] + LINK_TAG_MORE);
    return 0;
}

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

U32 link_extend(U32 expected, U32 byte) {
    U32 ahead = (byte - expected) & 0xFFU;
    return expected + ahead - (ahead & 0x80U) * 2U;
}
