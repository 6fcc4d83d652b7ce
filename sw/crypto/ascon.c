/* SPDX-License-Identifier: MIT
 *
 * ascon: Ascon-AEAD128, with each 64-bit word kept as two halves of 32 bits.
 */
#include "ascon.h"

/* Prevents gcc from reordering the steps of a round. With gcc's order, a round takes 91 instead of
 * 78 instructions. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-reassoc", "no-schedule-insns")
#endif

/* Round constants: first constant of a permutation of 12 rounds, first constant of a permutation of
 * 8 rounds, and value that follows the last constant. */
#define ROUNDS_12 0xF0U
#define ROUNDS_8 0xB4U
#define ROUNDS_END 0x3CU
#define ROUND_STEP 0x0FU

#define RATE 16U /* bytes in a block */

/* XORs `value` with one half of a 64-bit word rotated right by n, 0 < n < 32. `next` is the half
 * above this half. The two shifted parts are separate operands, because the processor shifts one
 * operand of an XOR at no cost. */
#define JOIN(value, half, next, n) value ^ half >> n ^ next << (32 - n)

/* Applies the 5-bit S-box to the same half of all five words, that is to 32 columns at once. */
#define SUBSTITUTE(x0, x1, x2, x3, x4) \
    x0 ^= x4;                          \
    x4 ^= x3;                          \
    x2 ^= x1;                          \
    y0 = x0 ^ (x2 & ~x1);              \
    y1 = x1 ^ (x3 & ~x2);              \
    y2 = x2 ^ (x4 & ~x3);              \
    x3 ^= x0 & ~x4;                    \
    x4 ^= x1 & ~x0;                    \
    x1 = y1 ^ y0;                      \
    x3 ^= y2;                          \
    x0 = y0 ^ x4;                      \
    x2 = ~y2;

/* XORs a word with itself rotated right by m and by n. (l, h) and (k, i) are the halves of the
 * word, low half first, for the two rotations. For a rotation by more than 32, the caller passes
 * the halves in the opposite order, and the rotation minus 32. */
#define DIFFUSE(low, high, l, h, m, k, i, n)   \
    y0 = JOIN(JOIN(low, l, h, m), k, i, n);    \
    high = JOIN(JOIN(high, h, l, m), i, k, n); \
    low = y0;

static void permute(U32* half, U32 constant) {
    /* low halves of the words */
    U32 a = half[0], b = half[2], c = half[4], d = half[6], e = half[8];
    /* high halves of the words */
    U32 A = half[1], B = half[3], C = half[5], D = half[7], E = half[9];
    U32 y0, y1, y2;
    for (; constant != ROUNDS_END; constant -= ROUND_STEP) {
        c ^= constant;
        SUBSTITUTE(a, b, c, d, e)
        SUBSTITUTE(A, B, C, D, E)
        DIFFUSE(a, A, a, A, 19, a, A, 28)
        DIFFUSE(b, B, B, b, 29, B, b, 7) /* rotations by 61 and 39 */
        DIFFUSE(c, C, c, C, 1, c, C, 6)
        DIFFUSE(d, D, d, D, 10, d, D, 17)
        DIFFUSE(e, E, e, E, 7, E, e, 9) /* rotations by 7 and 41 */
    }
    half[0] = a;
    half[1] = A;
    half[2] = b;
    half[3] = B;
    half[4] = c;
    half[5] = C;
    half[6] = d;
    half[7] = D;
    half[8] = e;
    half[9] = E;
}

/* Reads four bytes at any address as a word; compilers turn this into one access. */
static U32 get(const U8* bytes) {
    return bytes[0] | (U32)bytes[1] << 8 | (U32)bytes[2] << 16 | (U32)bytes[3] << 24;
}

static void put(U8* bytes, U32 word) {
    bytes[0] = (U8)word;
    bytes[1] = (U8)(word >> 8);
    bytes[2] = (U8)(word >> 16);
    bytes[3] = (U8)(word >> 24);
}

/* XORs a block of 16 bytes into four halves of the state. */
static void add(U32* half, const U8* bytes) {
    U32 i;
    for (i = 0; i < RATE; i += 4U)
        half[i / 4U] ^= get(bytes + i);
}

void Ascon_begin(Ascon* ascon, const U8* key, const U8* nonce) {
    U32* half = ascon->half;
    U32 i;
    for (i = 2; i < 10U; ++i)
        half[i] = 0;
    half[0] = 0x808C0001U;
    half[1] = 0x00001000U;
    add(half + 2, key);
    add(half + 6, nonce);
    permute(half, ROUNDS_12);
    add(half + 6, key);
    half[9] ^= 0x80000000U; /* separates the associated data from the message */
}

void Ascon_associate(Ascon* ascon, const U8* bytes, U32 size) {
    U32* half = ascon->half;
    U32 i;
    half[9] ^= 0x80000000U;
    for (; size >= RATE; size -= RATE, bytes += RATE) {
        add(half, bytes);
        permute(half, ROUNDS_8);
    }
    for (i = 0; i < size; ++i)
        half[i >> 2] ^= (U32)bytes[i] << 8 * (i & 3U);
    half[i >> 2] ^= 1U << 8 * (i & 3U);
    permute(half, ROUNDS_8);
    half[9] ^= 0x80000000U;
}

void Ascon_crypt(Ascon* ascon, U8* bytes, U32 size, int isDecryption) {
    U32* half = ascon->half;
    U32 at = 0, shift;
    for (; size >= 4U; size -= 4U, bytes += 4) {
        U32 in = get(bytes);
        U32 out = in ^ half[at];
        put(bytes, out);
        half[at] = isDecryption ? in : out;
        at = (at + 1U) % (RATE / 4U);
        if (at == 0)
            permute(half, ROUNDS_8);
    }
    for (shift = 0; size; --size, ++bytes, shift += 8U) {
        U32 in = *bytes;
        U32 out = in ^ (half[at] >> shift & 0xFFU);
        half[at] ^= (isDecryption ? out : in) << shift;
        *bytes = (U8)out;
    }
    half[at] ^= 1U << shift;
}

void Ascon_end(Ascon* ascon, const U8* key, U8* tag) {
    U32* half = ascon->half;
    volatile U32* rest = half;
    U32 i;
    add(half + 4, key);
    permute(half, ROUNDS_12);
    add(half + 6, key);
    for (i = 0; i < ASCON_TAG_BYTES / 4U; ++i)
        put(tag + 4U * i, half[6U + i]);
    for (i = 0; i < 10U; ++i)
        rest[i] = 0;
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
