/* SPDX-License-Identifier: MIT
 *
 * link_codec_keyed: encrypts and authenticates frames with Ascon-AEAD128. The unencrypted parts of
 * a frame are copied into the nonce, so that the tag also covers them.
 */
#include "link_codec_keyed.h"

#include "ascon.h"

#include <string.h>

#define CLEAR_AT 11U  /* offset in the nonce at which the unencrypted payload begins */
#define CLEAR_MOST 5U /* largest size of an unencrypted payload, bytes */

/* Returns the number of bytes at the start of the payload that are not encrypted: in a PIGGYBACK
 * the acknowledgement, in HELLO-ACK and CONFIRM the nonces, in other control frames all bytes, in a
 * data frame none. */
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
    /* an acknowledgement has up to 9 bytes; only the first CLEAR_MOST bytes fit at CLEAR_AT */
    else if (clear > CLEAR_MOST)
        memcpy(nonce + 4, frame + LINK_HEADER + CLEAR_MOST,
               clear < LINK_BITMAP + 1U ? clear - CLEAR_MOST : LINK_BITMAP + 1U - CLEAR_MOST);
    memcpy(nonce + 8, frame, LINK_HEADER);
    memcpy(nonce + CLEAR_AT, frame + LINK_HEADER, clear < CLEAR_MOST ? clear : CLEAR_MOST);
}

/* Encrypts or decrypts the payload and computes the tag. */
static void crypt(U8* frame, const U8* key, U32 number, U32 acked, int isDecryption, U8* tag) {
    U8 nonce[ASCON_NONCE_BYTES];
    U32 clear = clearOf(frame);
    makeNonce(nonce, frame, clear, number, acked);
    link_cipher(key, nonce, frame + LINK_HEADER + clear, LINK_LENGTH(frame) - clear, isDecryption,
                tag);
}

U32 link_encryptFrame(U8* frame, U32 header, const U8* key, U32 number, U32 acked) {
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

int link_decryptFrame(U8* frame, const U8* key, U32 number, U32 acked) {
    U32 size = LINK_LENGTH(frame) - LINK_TAG_MORE;
    U8 tag[ASCON_TAG_BYTES];
    frame[0] = (U8)(frame[0] - LINK_TAG_MORE);
    crypt(frame, key, number, acked, 1, tag);
    if (Ascon_isSame(tag, frame + LINK_HEADER + size, LINK_TAG))
        return 1;
    Ascon_wipe(frame + LINK_HEADER, size);
    frame[0] = (U8)(frame[0] + LINK_TAG_MORE);
    return 0;
}

static U32 seal(U8* frame, U32 header, const Link_Seal* with) {
    return link_encryptFrame(frame, header ^ LINK_KEY_EPOCH(with->session) << 18, with->key,
                             with->number, with->acked);
}

static const U8* open(const U8* frame, U8* copy, const Link_Seal* with) {
    memcpy(copy, frame, LINK_LENGTH(frame) + LINK_OVERHEAD);
    return link_decryptFrame(copy, with->key, with->number, with->acked) ? copy : 0;
}

const Link_Codec link_codecKeyed = {
    LINK_SECURE_OVERHEAD,
    LINK_NONCE_BYTES,
    0,
    1,
    {1, LINK_NONCE_BYTES, LINK_ANSWER_BYTES, LINK_ANSWER_BYTES, 0, 0},
    seal,
    open};
