/* SPDX-License-Identifier: MIT
 *
 * ascon: encrypts and authenticates a message with Ascon-AEAD128 (NIST SP 800-232).
 *
 *     Ascon ascon;
 *     Ascon_begin(&ascon, key, nonce);
 *     Ascon_associate(&ascon, head, headSize);        (once; only if there is associated data)
 *     Ascon_crypt(&ascon, message, size, 0);          (once, even for an empty message)
 *     Ascon_end(&ascon, key, tag);
 *
 * Never use a nonce twice with one key. Neither branches nor addresses depend on secrets.
 */
#pragma once

#include "base.h"

#define ASCON_KEY_BYTES 16U
#define ASCON_NONCE_BYTES 16U
#define ASCON_TAG_BYTES 16U

/* State: five 64-bit words, each as a low and a high half. */
typedef struct Ascon {
    U32 half[10];
} Ascon;

/* Starts a message with `key` and `nonce`, 16 bytes each. */
void Ascon_begin(Ascon* ascon, const U8* key, const U8* nonce);

/* Absorbs all associated data (authenticated, but not encrypted). Must not be called without
 * data. */
void Ascon_associate(Ascon* ascon, const U8* bytes, U32 size);

/* Encrypts or decrypts the message in place. Decrypted bytes must not be used before the tag is
 * verified. */
void Ascon_crypt(Ascon* ascon, U8* bytes, U32 size, int isDecryption);

/* Writes the tag of 16 bytes and wipes the state. */
void Ascon_end(Ascon* ascon, const U8* key, U8* tag);

/* Returns 1 if the bytes are equal. The time does not depend on where they differ. */
int Ascon_isSame(const U8* a, const U8* b, U32 size);

/* Overwrites bytes with zeros. The compiler does not remove these writes, even if nothing reads the
 * bytes later. */
void Ascon_wipe(void* bytes, U32 size);
