// SPDX-License-Identifier: MIT
//
// random: provides a small random generator (xorshift64*) that returns the same numbers on every
// machine, and reads the seed of a test.

#pragma once

#include <cstdint>
#include <cstdlib>
#include <vector>

class Random {
public:
    explicit Random(uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ull + 0x1234567ull) {
        if (state_ == 0)
            state_ = 1;
    }
    uint32_t next() {
        state_ ^= state_ >> 12;
        state_ ^= state_ << 25;
        state_ ^= state_ >> 27;
        return static_cast<uint32_t>((state_ * 0x2545F4914F6CDD1Dull) >> 32);
    }
    // Returns a number from 0 to bound - 1.
    uint32_t below(uint32_t bound) { return static_cast<uint32_t>(uint64_t(next()) * bound >> 32); }
    // Returns `count` random items; all bits of an item are random.
    template <class Item> std::vector<Item> items(size_t count) {
        std::vector<Item> list(count);
        for (Item& item : list)
            item = static_cast<Item>(next());
        return list;
    }
    bool chance(double probability) { return next() < probability * 4294967296.0; }

private:
    uint64_t state_;
};

// Returns the environment variable SEED, with which a run can be repeated; returns `fallback` if
// SEED is not set.
inline uint64_t testSeed(uint64_t fallback = 1) {
    const char* seed = std::getenv("SEED");
    return seed && *seed ? std::strtoull(seed, nullptr, 0) : fallback;
}
