// SPDX-License-Identifier: MIT
//
// ascon_model: implements sections 3 to 5 of NIST SP 800-232, with the byte and bit order of the
// standard.

#include "ascon_model.h"

#include <cstddef>

namespace {

// The S-box, as in table 6 of the standard; the core uses an equivalent formula.
constexpr uint8_t sbox[32] = {0x04, 0x0b, 0x1f, 0x14, 0x1a, 0x15, 0x09, 0x02, 0x1b, 0x05, 0x08,
                              0x12, 0x1d, 0x03, 0x06, 0x1c, 0x1e, 0x13, 0x07, 0x0e, 0x00, 0x0d,
                              0x11, 0x18, 0x10, 0x0c, 0x01, 0x19, 0x16, 0x0a, 0x0f, 0x17};

class State {
public:
    uint64_t word[5] = {};

    void permute(int rounds) {
        for (int r = 12 - rounds; r < 12; ++r) {
            word[2] ^= static_cast<uint64_t>(0xf0 - r * 0x0f);
            substitute();
            const int turns[5][2] = {{19, 28}, {61, 39}, {1, 6}, {10, 17}, {7, 41}};
            for (int i = 0; i < 5; ++i)
                word[i] ^= right(word[i], turns[i][0]) ^ right(word[i], turns[i][1]);
        }
    }
    // Returns byte n of the state. Its words are little-endian.
    uint8_t byte(size_t n) const { return static_cast<uint8_t>(word[n / 8] >> (8 * (n % 8))); }
    void add(size_t n, uint8_t value) { word[n / 8] ^= uint64_t(value) << (8 * (n % 8)); }
    void addAt(size_t n, const AsconKey& bytes) {
        for (size_t i = 0; i < bytes.size(); ++i)
            add(n + i, bytes[i]);
    }

private:
    static uint64_t right(uint64_t value, int bits) { return value >> bits | value << (64 - bits); }
    void substitute() {
        uint64_t out[5] = {};
        for (int bit = 0; bit < 64; ++bit) {
            unsigned in = 0;
            for (int i = 0; i < 5; ++i) // S0 is the most significant bit of the S-box's input
                in |= static_cast<unsigned>(word[i] >> bit & 1) << (4 - i);
            for (int i = 0; i < 5; ++i)
                out[i] |= uint64_t(sbox[in] >> (4 - i) & 1) << bit;
        }
        for (int i = 0; i < 5; ++i)
            word[i] = out[i];
    }
};

// Processes all bytes of `in` with their padding: adds `rate` bytes at a time to the state, and
// computes `rounds` rounds after each block. Returns the output bytes.
AsconBytes pass(State& state, const AsconBytes& in, size_t rate, int rounds) {
    AsconBytes out;
    for (size_t i = 0; i < in.size(); ++i) {
        if (i > 0 && i % rate == 0)
            state.permute(rounds);
        state.add(i % rate, in[i]);
        out.push_back(state.byte(i % rate));
    }
    if (!in.empty() && in.size() % rate == 0)
        state.permute(rounds);
    state.add(in.size() % rate, 0x01);
    return out;
}

State begin(const AsconKey& key, const AsconKey& nonce, const AsconBytes& associated) {
    State state;
    state.word[0] = 0x00001000808c0001;
    state.addAt(8, key);
    state.addAt(24, nonce);
    state.permute(12);
    state.addAt(24, key);
    if (!associated.empty()) {
        pass(state, associated, 16, 8);
        state.permute(8);
    }
    state.word[4] ^= 0x8000000000000000;
    return state;
}

AsconKey finish(State& state, const AsconKey& key) {
    state.addAt(16, key);
    state.permute(12);
    state.addAt(24, key);
    AsconKey tag;
    for (size_t i = 0; i < tag.size(); ++i)
        tag[i] = state.byte(24 + i);
    return tag;
}

} // namespace

AsconSealed asconEncrypt(const AsconKey& key, const AsconKey& nonce, const AsconBytes& associated,
                         const AsconBytes& message) {
    State state = begin(key, nonce, associated);
    AsconBytes text = pass(state, message, 16, 8);
    return {text, finish(state, key)};
}

std::array<uint8_t, 32> asconHash(const AsconBytes& message) {
    State state;
    state.word[0] = 0x0000080100cc0002;
    state.permute(12);
    pass(state, message, 8, 12);
    std::array<uint8_t, 32> digest;
    for (size_t i = 0; i < digest.size(); ++i) {
        if (i % 8 == 0)
            state.permute(12);
        digest[i] = state.byte(i % 8);
    }
    return digest;
}
