/* SPDX-License-Identifier: MIT
 *
 * ascon: Ascon-AEAD128 in 32-bit halves of its words.
 */
#include "ascon.h"

/* The constant of the first round of 12, of the first of 8, and the one that no round has. */
#define ROUNDS_12 0xF0U
#define ROUNDS_8 0xB4U
#define ROUNDS_END 0x3CU
#define ROUND_STEP 0x0FU

#define RATE 16U /* bytes of a block */

/* A half of a word turned right by 0 < n < 32, when `next` is the half above it. */
#define TURNED(half, next, n) ((half) >> (n) | (next) << (32 - (n)))

/* Mixes the word whose halves are at w with itself turned right by m and n, less than 32. */
#define DIFFUSE(w, m, n)                                        \
    low = (w)[0];                                               \
    high = (w)[1];                                              \
    (w)[0] = low ^ TURNED(low, high, m) ^ TURNED(low, high, n); \
    (w)[1] = high ^ TURNED(high, low, m) ^ TURNED(high, low, n);

/* The S-box of 5 bits, 32 times at once, on one half of each word. */
static void substitute(U32* half) {
    U32 x1 = half[2];
    U32 x3 = half[6];
    U32 x0 = half[0] ^ half[8];
    U32 x2 = half[4] ^ x1;
    U32 x4 = half[8] ^ x3;
    U32 y0 = x0 ^ (~x1 & x2);
    U32 y2 = x2 ^ (~x3 & x4);
    U32 y4 = x4 ^ (~x0 & x1);
    half[2] = x1 ^ (~x2 & x3) ^ y0;
    half[6] = x3 ^ (~x4 & x0) ^ y2;
    half[0] = y0 ^ y4;
    half[4] = ~y2;
    half[8] = y4;
}

static void permute(U32* half, U32 constant) {
    U32 low, high;
    for (; constant != ROUNDS_END; constant -= ROUND_STEP) {
        half[4] ^= constant;
        substitute(half);
        substitute(half + 1);
        DIFFUSE(half, 19, 28)
        DIFFUSE(half + 4, 1, 6)
        DIFFUSE(half + 6, 10, 17)
        /* These turn by more than 32: the halves change places. */
        low = half[2];
        high = half[3];
        half[2] = low ^ TURNED(high, low, 29) ^ TURNED(high, low, 7);
        half[3] = high ^ TURNED(low, high, 29) ^ TURNED(low, high, 7);
        low = half[8];
        high = half[9];
        half[8] = low ^ TURNED(low, high, 7) ^ TURNED(high, low, 9);
        half[9] = high ^ TURNED(high, low, 7) ^ TURNED(low, high, 9);
    }
}

/* Adds bytes to the state, from a half on; one at a time, as they may lie anywhere. */
static void add(U32* half, const U8* bytes, U32 size) {
    U32 i;
    for (i = 0; i < size; ++i)
        half[i >> 2] ^= (U32)bytes[i] << 8 * (i & 3U);
}

void Ascon_begin(Ascon* ascon, const U8* key, const U8* nonce) {
    U32* half = ascon->half;
    U32 i;
    for (i = 2; i < 10U; ++i)
        half[i] = 0;
    half[0] = 0x808C0001U;
    half[1] = 0x00001000U;
    add(half + 2, key, ASCON_KEY_BYTES);
    add(half + 6, nonce, ASCON_NONCE_BYTES);
    permute(half, ROUNDS_12);
    add(half + 6, key, ASCON_KEY_BYTES);
    half[9] ^= 0x80000000U; /* where associated data would end */
}

void Ascon_associate(Ascon* ascon, const U8* bytes, U32 size) {
    U32* half = ascon->half;
    half[9] ^= 0x80000000U;
    for (; size >= RATE; size -= RATE, bytes += RATE) {
        add(half, bytes, RATE);
        permute(half, ROUNDS_8);
    }
    add(half, bytes, size);
    half[size >> 2] ^= 1U << 8 * (size & 3U);
    permute(half, ROUNDS_8);
    half[9] ^= 0x80000000U;
}

void Ascon_crypt(Ascon* ascon, U8* bytes, U32 size, int isDecryption) {
    U32* half = ascon->half;
    U32 at = 0;
    while (size--) {
        U32 shift = 8 * (at & 3U);
        U32 in = *bytes;
        U32 out = in ^ (half[at >> 2] >> shift & 0xFFU);
        half[at >> 2] ^= (isDecryption ? out : in) << shift;
        *bytes++ = (U8)out;
        at = (at + 1U) % RATE;
        if (at == 0)
            permute(half, ROUNDS_8);
    }
    half[at >> 2] ^= 1U << 8 * (at & 3U);
}

void Ascon_end(Ascon* ascon, const U8* key, U8* tag) {
    U32* half = ascon->half;
    U32 i;
    add(half + 4, key, ASCON_KEY_BYTES);
    permute(half, ROUNDS_12);
    add(half + 6, key, ASCON_KEY_BYTES);
    for (i = 0; i < ASCON_TAG_BYTES; ++i)
        tag[i] = (U8)(half[6U + (i >> 2)] >> 8 * (i & 3U));
    Ascon_wipe(half, sizeof ascon->half);
}

int Ascon_isSame(const U8* a, const U8* b, U32 size) {
    U32 difference = 0;
    while (size--)
        difference |= (U32)(*a++ ^ *b++);
    return difference == 0;
}

void Ascon_wipe(void* bytes, U32 size) {
    volatile U8* p = bytes;
    while (size--)
        *p++ = 0;
}
