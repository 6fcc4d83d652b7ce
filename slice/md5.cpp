// SPDX-License-Identifier: MIT
//
// md5: RFC 1321, section 3.

#include "md5.h"
#include <cmath>

namespace {

using Words = std::array<uint32_t, 4>;

uint32_t rotated(uint32_t v, unsigned n) {
    return v << n | v >> (32 - n);
}

// Section 3.4: four rounds of 16 steps over one block of 64 bytes.
void block(Words& state, const uint8_t* bytes) {
    static const unsigned shifts[4][4] = {
        {7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};
    uint32_t x[16];
    for (unsigned i = 0; i < 16; ++i, bytes += 4)
        x[i] = bytes[0] | bytes[1] << 8 | bytes[2] << 16 | uint32_t{bytes[3]} << 24;
    auto [a, b, c, d] = state;
    for (unsigned i = 0; i < 64; ++i) {
        unsigned round = i / 16;
        uint32_t f = round == 0   ? (b & c) | (~b & d)
                     : round == 1 ? (b & d) | (c & ~d)
                     : round == 2 ? b ^ c ^ d
                                  : c ^ (b | ~d);
        unsigned k = round == 0 ? i : round == 1 ? 5 * i + 1 : round == 2 ? 3 * i + 5 : 7 * i;
        auto t = static_cast<uint32_t>(4294967296.0 * std::fabs(std::sin(i + 1.0)));
        uint32_t next = b + rotated(a + f + x[k % 16] + t, shifts[round][i % 4]);
        a = d;
        d = c;
        c = b;
        b = next;
    }
    state = {state[0] + a, state[1] + b, state[2] + c, state[3] + d};
}

} // namespace

std::array<uint8_t, 16> md5(const std::string& text) {
    std::string padded = text + '\x80';
    padded.resize((text.size() + 8) / 64 * 64 + 56, '\0');
    for (unsigned i = 0; i < 8; ++i)
        padded += static_cast<char>(uint64_t{text.size()} * 8 >> 8 * i);
    Words state = {0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476};
    for (size_t i = 0; i < padded.size(); i += 64)
        block(state, reinterpret_cast<const uint8_t*>(padded.data()) + i);
    std::array<uint8_t, 16> digest{};
    for (unsigned i = 0; i < 16; ++i)
        digest[i] = static_cast<uint8_t>(state[i / 4] >> 8 * (i % 4));
    return digest;
}
