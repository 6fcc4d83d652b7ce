// SPDX-License-Identifier: MIT
//
// random_block: the STM32F2's random number generator (RM0033, 20): a number each 40 periods of its
// 48 MHz, from a seed instead of noise.
//
//   0  CR  bit 2 RNGEN
//   4  SR  bit 0 DRDY, 1 CECS, 2 SECS: now; 5 CEIS, 6 SEIS: since they were written 0
//   8  DR  the number; 0 while there is none

#ifndef RANDOM_BLOCK_H
#define RANDOM_BLOCK_H

#include <cstdint>

class RandomBlock {
public:
    explicit RandomBlock(uint64_t seed) : state_(seed) {}

    void reset() { control_ = errors_ = 0; }
    uint32_t read(uint32_t offset, uint64_t nowNs, bool hasClock);
    void write(uint32_t offset, uint32_t value, uint64_t nowNs);
    // Stops the noise, until RNGEN is cleared and set.
    void fail() { errors_ |= 0x44; }

    // Returns the number of a state, SplitMix64's: a counter's steps, mixed.
    static uint32_t next(uint64_t& state) {
        uint64_t x = state += 0x9E3779B97F4A7C15ull;
        x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9ull;
        x = (x ^ x >> 27) * 0x94D049BB133111EBull;
        return static_cast<uint32_t>(x >> 32);
    }

private:
    uint64_t state_, readyNs_ = 0;
    uint32_t control_ = 0, errors_ = 0;
};

#endif
