/* SPDX-License-Identifier: MIT
 *
 * slots: two places in flash for firmware, and which of their images may run (docs/update.md).
 *
 * A slot begins with a header, which is signed and names the digest of the image behind it, and has
 * state words, which are written once after an erase. Whatever a loss of power leaves of them, a
 * word counts only if it is exactly the value that was meant, and writing it again completes it.
 */
#ifndef SLOTS_H
#define SLOTS_H

#include "base.h"

/* Offsets in flash, in bytes: sectors 5..7 and 8..10; the public key has sector 2 for itself. */
#define SLOTS_COUNT 2U
#define SLOTS_NONE SLOTS_COUNT
#define SLOTS_AT 0x20000U
#define SLOTS_BYTES 0x60000U
#define SLOTS_SECTOR_BYTES 0x20000U
#define SLOTS_FIRST_SECTOR 5U
#define SLOTS_SECTORS 3U
#define SLOTS_KEY_AT 0x8000U
#define SLOTS_KEY_BYTES 32U

#define SLOTS_IMAGE_AT 0x200U /* in a slot; Cortex-M3's vectors are aligned to 512 bytes */
#define SLOTS_IMAGE_BYTES (SLOTS_BYTES - SLOTS_IMAGE_AT)

#define SLOTS_MAGIC 0x1CE50C02U
#define SLOTS_DIGEST_BYTES 64U    /* SHA-512 */
#define SLOTS_SIGNATURE_BYTES 64U /* Ed25519 */

/* What is at the beginning of a slot. The signature is of all bytes before it. */
typedef struct Slots_Header {
    U32 magic;
    U32 product; /* which vehicle it is for */
    U32 version; /* 1..0xFFFFFFFE */
    U32 bytes;   /* of the image, a multiple of 4 */
    U32 base;    /* offset in flash that the image is linked for: its vectors' */
    U8 digest[SLOTS_DIGEST_BYTES];
    U8 signature[SLOTS_SIGNATURE_BYTES];
} Slots_Header;

#define SLOTS_SIGNED_BYTES (sizeof(Slots_Header) - SLOTS_SIGNATURE_BYTES)

/* State words, by their offset in a slot, and the value that makes each of them true. */
typedef enum Slots_State {
    SLOTS_READY = 0x1C0,    /* the whole image is there, and was checked */
    SLOTS_TRIED = 0x1D0,    /* it was started once */
    SLOTS_CONFIRMED = 0x1E0 /* it was said to be good */
} Slots_State;
#define SLOTS_TRUE 0x600DF1A5U
#define SLOTS_ERASED 0xFFFFFFFFU

/* The flash, and the checks, of whoever runs this. Functions that return int return 1 for success.
 */
typedef struct Slots_Port {
    const U8* flash; /* its first byte */
    void* context;
    int (*erase)(void* context, U32 sector);
    int (*program)(void* context, U32 offset, U32 word); /* one word; only clears bits */
    int (*isSigned)(const U8* signature, const U8* message, U32 bytes, const U8* key);
    void (*digest)(const U8* data, U32 bytes, U8* digest);
} Slots_Port;

/* Returns the slot's offset in flash. */
U32 Slots_at(U32 slot);
/* Returns the header at the slot's beginning, whatever is there. */
const Slots_Header* Slots_header(const Slots_Port* port, U32 slot);
int Slots_is(const Slots_Port* port, U32 slot, Slots_State state);
/* Makes a state true; 0: the flash does not take it. */
int Slots_set(const Slots_Port* port, U32 slot, Slots_State state);
/* Returns 1 if the header could be one of an image for this slot and product. */
int Slots_fits(const Slots_Header* header, U32 slot, U32 product);
/* Returns 1 if the header is signed with the vehicle's key; it need not be in flash. */
int Slots_isSigned(const Slots_Port* port, const Slots_Header* header);
/* Returns 1 if the digest of the image in the slot is the header's. */
int Slots_isWhole(const Slots_Port* port, U32 slot);
/* Returns the highest version that was confirmed; 0: none. */
U32 Slots_confirmed(const Slots_Port* port, U32 product);

/* Returns the slot whose image is to run, SLOTS_NONE if there is none: one that is new, once; else
 * the newest that was confirmed; else any that is sound. Every image that it names is signed and
 * whole. */
U32 Slots_choose(const Slots_Port* port, U32 product);

#endif
