/* SPDX-License-Identifier: MIT
 *
 * x25519: computes Montgomery's ladder modulo p = 2^255 - 19. Numbers are arrays of 16-bit words,
 * the lowest word first. They are kept below 2^256, not below p. A carry of 2^256 is replaced by
 * 38, because both are equal modulo p.
 */
#include "x25519.h"

#include "ascon.h"

#include <string.h>

#define WORDS 16
#define A24 121665U /* constant of the curve: (486662 - 2) / 4 */

typedef U16 Number[WORDS];

/* Adds the carry beyond 2^256; after two calls the carry is 0. */
static void fold(U16* r, U32 carry) {
    int i, again;
    for (again = 0; again < 2; ++again) {
        carry *= 38U;
        for (i = 0; i < WORDS; ++i) {
            carry += r[i];
            r[i] = (U16)carry;
            carry >>= 16;
        }
    }
}

static void add(U16* r, const U16* a, const U16* b) {
    U32 carry = 0;
    int i;
    for (i = 0; i < WORDS; ++i) {
        carry += (U32)a[i] + b[i];
        r[i] = (U16)carry;
        carry >>= 16;
    }
    fold(r, carry);
}

/* Subtracts b from a, by adding 4p - b. The words of 4p are chosen so that each is greater than the
 * corresponding word of b. */
static void subtract(U16* r, const U16* a, const U16* b) {
    U32 carry = 0;
    int i;
    for (i = 0; i < WORDS; ++i) {
        carry += a[i] + (i ? 0x1FFFEU : 0x1FFB4U) - b[i];
        r[i] = (U16)carry;
        carry >>= 16;
    }
    fold(r, carry);
}

/* The sum fits into 32 bits: it is at most 2^32 - 1. */
#define MULTIPLY_WORD(word, to)  \
    carry += factor * word + to; \
    to = (U16)carry;             \
    carry >>= 16

static void multiply(U16* r, const U16* a, const U16* b) {
    U16 t[2 * WORDS];
    U32 carry;
    int i, j;
    memset(t, 0, sizeof t);
    for (i = 0; i < WORDS; ++i) {
        U32 factor = a[i];
        U16* row = t + i;
        carry = 0;
        for (j = 0; j < WORDS; j += 4) {
            MULTIPLY_WORD(b[j], row[j]);
            MULTIPLY_WORD(b[j + 1], row[j + 1]);
            MULTIPLY_WORD(b[j + 2], row[j + 2]);
            MULTIPLY_WORD(b[j + 3], row[j + 3]);
        }
        row[WORDS] = (U16)carry;
    }
    carry = 0;
    for (i = 0; i < WORDS; ++i) {
        carry += t[i] + 38U * t[i + WORDS];
        r[i] = (U16)carry;
        carry >>= 16;
    }
    fold(r, carry);
}

/* Multiplies a number by A24, which has 17 bits: multiplies by the lower 16 bits of A24; then, for
 * bit 16, adds the number shifted by one word. */
static void multiplyA24(U16* r, const U16* a) {
    U32 carry = 0;
    U32 below = 0;
    int i;
    for (i = 0; i < WORDS; ++i) {
        U32 word = a[i];
        carry += (A24 & 0xFFFFU) * word + below;
        below = word;
        r[i] = (U16)carry;
        carry >>= 16;
    }
    fold(r, carry + below);
}

/* Computes the inverse of a number as its power with the exponent p - 2. All bits of this exponent
 * are 1 except bits 2 and 4. */
static void invert(U16* r, const U16* a) {
    Number z;
    int bit;
    memcpy(z, a, sizeof z);
    for (bit = 253; bit >= 0; --bit) {
        multiply(z, z, z);
        if (bit != 2 && bit != 4)
            multiply(z, z, a);
    }
    memcpy(r, z, sizeof z);
}

static void exchange(U16* a, U16* b, U32 isWanted) {
    U32 mask = 0U - isWanted;
    int i;
    for (i = 0; i < WORDS; ++i) {
        U32 both = (a[i] ^ b[i]) & mask;
        a[i] = (U16)(a[i] ^ both);
        b[i] = (U16)(b[i] ^ both);
    }
}

/* Reduces a number modulo p: replaces bit 255 by 19, then subtracts p unless the result would be
 * negative. */
static void normalize(U16* r) {
    Number less;
    U32 carry = (U32)(r[WORDS - 1] >> 15) * 19U;
    int i;
    r[WORDS - 1] &= 0x7FFFU;
    for (i = 0; i < WORDS; ++i) {
        carry += r[i];
        r[i] = (U16)carry;
        carry >>= 16;
    }
    carry = 19U;
    for (i = 0; i < WORDS; ++i) {
        carry += r[i];
        less[i] = (U16)carry;
        carry >>= 16;
    }
    exchange(r, less, (U32)less[WORDS - 1] >> 15);
    r[WORDS - 1] &= 0x7FFFU;
}

/* The variables of the Montgomery ladder, named as in RFC 7748. The variable `da` also holds C, and
 * `cb` also holds D. */
typedef struct Ladder {
    Number x1, x2, z2, x3, z3, a, b, da, cb;
} Ladder;

static void step(Ladder* l) {
    add(l->a, l->x2, l->z2);
    subtract(l->b, l->x2, l->z2);
    add(l->da, l->x3, l->z3);
    subtract(l->cb, l->x3, l->z3);
    multiply(l->cb, l->cb, l->a);
    multiply(l->da, l->da, l->b);
    add(l->x3, l->cb, l->da);
    multiply(l->x3, l->x3, l->x3);
    subtract(l->z3, l->cb, l->da);
    multiply(l->z3, l->z3, l->z3);
    multiply(l->z3, l->z3, l->x1);
    multiply(l->a, l->a, l->a);
    multiply(l->b, l->b, l->b);
    multiply(l->x2, l->a, l->b);
    subtract(l->b, l->a, l->b);
    multiplyA24(l->z2, l->b);
    add(l->z2, l->z2, l->a);
    multiply(l->z2, l->z2, l->b);
}

void X25519(U8* result, const U8* number, const U8* point) {
    Ladder l;
    U32 swapped = 0;
    int i;
    memset(&l, 0, sizeof l);
    for (i = 0; point && i < WORDS; ++i)
        l.x1[i] = (U16)(point[2 * i] | (U32)point[2 * i + 1] << 8);
    l.x1[WORDS - 1] &= 0x7FFFU;
    if (!point)
        l.x1[0] = 9;
    memcpy(l.x3, l.x1, sizeof l.x3);
    l.x2[0] = l.z3[0] = 1;
    for (i = 254; i >= 0; --i) {
        U32 bit = (U32)number[i >> 3] >> (i & 7) & 1U;
        if (i == 254)
            /* the highest bit of the scalar is always set, and the three lowest bits are always
             * clear */
            bit = 1;
        if (i < 3)
            bit = 0;
        exchange(l.x2, l.x3, swapped ^ bit);
        exchange(l.z2, l.z3, swapped ^ bit);
        swapped = bit;
        step(&l);
    }
    invert(l.z2, l.z2); /* no final swap is needed, because the lowest bit is 0 */
    multiply(l.x2, l.x2, l.z2);
    normalize(l.x2);
    for (i = 0; i < WORDS; ++i) {
        result[2 * i] = (U8)l.x2[i];
        result[2 * i + 1] = (U8)(l.x2[i] >> 8);
    }
    Ascon_wipe(&l, sizeof l);
}
