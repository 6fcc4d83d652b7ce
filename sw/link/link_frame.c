/* SPDX-License-Identifier: MIT
 *
 * link_frame: computes the checksums of the wire format, and reads and writes its numbers.
 */
#include "link_frame.h"

/* Computes CRC-16/CCITT: polynomial 0x1021, MSB first. `x ^= x >> 4` and three shifts replace the
 * usual table of 256 values. */
U32 link_crc(U32 key, const U8* bytes, U32 size) {
    U32 crc = key & 0xFFFFU;
    while (size--) {
        U32 x = (crc >> 8 ^ *bytes++) & 0xFFU;
        x ^= x >> 4;
        crc = (crc << 8 ^ x << 12 ^ x << 5 ^ x) & 0xFFFFU;
    }
    return crc;
}

U32 link_seal(U8* frame, U32 header, U32 key) {
    U32 size = LINK_LENGTH_OF(header) + LINK_HEADER;
    U32 crc;
    frame[0] = (U8)header;
    frame[1] = (U8)(header >> 8);
    frame[2] = (U8)(header >> 16 ^ LINK_KEY_EPOCH(key) << 2);
    crc = link_crc(key, frame, size);
    frame[size++] = (U8)(crc >> 8);
    frame[size++] = (U8)crc;
    return size;
}

/* Computes Fletcher's two sums modulo 256. Unlike a second CRC, they do not depend on the CRCs of
 * the fragments. */
U32 link_sum(U32 sums, const U8* bytes, U32 size) {
    U32 plain = sums & 0xFFU;
    U32 second = sums >> 8;
    while (size--) {
        plain += *bytes++;
        second += plain;
    }
    return (plain & 0xFFU) | (second & 0xFFU) << 8;
}

U32 link_get32(const U8* p) {
    return (U32)p[0] | (U32)p[1] << 8 | (U32)p[2] << 16 | (U32)p[3] << 24;
}

void link_put32(U8* p, U32 value) {
    p[0] = (U8)value;
    p[1] = (U8)(value >> 8);
    p[2] = (U8)(value >> 16);
    p[3] = (U8)(value >> 24);
}

U32 link_sessionKey(U32 nonce, U32 peerNonce) {
    U8 bytes[4];
    U32 mix = (nonce ^ peerNonce) * 2654435761U + nonce + peerNonce;
    link_put32(bytes, mix);
    return LINK_EPOCH_KEY(LINK_KEY_EPOCH(mix)) | link_crc(0x1D0FU, bytes, 4);
}

U32 link_extend(U32 expected, U32 byte) {
    U32 ahead = (byte - expected) & 0xFFU;
    return expected + ahead - (ahead & 0x80U) * 2U;
}

U32 link_epochBits(const U8* frame, U32 key) {
    return (frame[2] ^ LINK_KEY_EPOCH(key) << 2) & 0x1CU;
}

int link_isOfEpoch(const U8* frame, U32 key) {
    U32 bits = link_epochBits(frame, key);
    /* these bits are set in a data frame with a complete message, and in both kinds of PIGGYBACK */
    U32 whole = LINK_FIRST | LINK_LAST;
    return bits == 0 || (bits == LINK_READY && (frame[2] & whole) == whole);
}
