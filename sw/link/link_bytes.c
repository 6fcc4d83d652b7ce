/* SPDX-License-Identifier: MIT
 *
 * link_bytes: checksums and numbers of the wire format.
 */
#include "link.h"

/* CRC-16/CCITT, polynomial 0x1021, MSB first, without a table: x ^= x >> 4 (Sarwate, by shifts). */
U16 Link_crc(U16 seed, const U8* bytes, U32 size) {
    U32 crc = seed;
    while (size--) {
        U32 x = (crc >> 8 ^ *bytes++) & 0xFFU;
        x ^= x >> 4;
        crc = (crc << 8 ^ x << 12 ^ x << 5 ^ x) & 0xFFFFU;
    }
    return (U16)crc;
}

/* Fletcher's two sums, modulo 256: unlike a second CRC it has nothing in common with the
 * fragments'. */
void Link_sum(U8 sums[2], const U8* bytes, U32 size) {
    U32 plain = sums[0];
    U32 second = sums[1];
    while (size--) {
        plain += *bytes++;
        second += plain;
    }
    sums[0] = (U8)plain;
    sums[1] = (U8)second;
}

U32 Link_get32(const U8* p) {
    return (U32)p[0] | (U32)p[1] << 8 | (U32)p[2] << 16 | (U32)p[3] << 24;
}

void Link_put32(U8* p, U32 value) {
    p[0] = (U8)value;
    p[1] = (U8)(value >> 8);
    p[2] = (U8)(value >> 16);
    p[3] = (U8)(value >> 24);
}

U32 Link_mixNonces(U32 nonce, U32 peerNonce, U16* seed) {
    U8 bytes[4];
    Link_put32(bytes, (nonce ^ peerNonce) * 2654435761U + nonce + peerNonce);
    *seed = Link_crc(0x1D0FU, bytes, 4);
    return bytes[3] >> 5;
}
