// SPDX-License-Identifier: MIT
//
// random_block: models the random number generator of the STM32F2 (RM0033, 20). It delivers a
// number every 40 periods of its 48 MHz clock. The numbers come from a seed instead of noise.
//
//   0  CR  bit 2 RNGEN
//   4  SR  bit 0 DRDY, 1 CECS, 2 SECS: current state; 5 CEIS, 6 SEIS: set until 0 is written
//   8  DR  the number; 0 while no number is ready

#pragma once

#include <cstdint>

class RandomBlock {
public:
    explicit RandomBlock(uint64_t seed) : state_(seed) {}

    void reset() { control_ = errors_ = 0; }
    uint32_t read(uint32_t offset, uint64_t nowNs, bool hasClock) {
        if ((control_ & enable) && !hasClock)
            errors_ |= noClock;
        const bool isReady =
            (control_ & enable) && hasClock && !(errors_ & badSeedNow) && nowNs >= readyNs_;
        if (offset == 0)
            return control_;
        if (offset == 4)
            return errors_ | (isReady ? ready : 0) | (hasClock ? 0 : noClockNow);
        if (!isReady)
            return 0;
        readyNs_ = nowNs + numberNs;
        return next(state_);
    }
    void write(uint32_t offset, uint32_t value, uint64_t nowNs) {
        if (offset == 4)
            errors_ &= value | badSeedNow;
        if (offset != 0)
            return;
        if (!(control_ & enable) && (value & enable)) {
            readyNs_ = nowNs + numberNs;
            errors_ &= ~badSeedNow;
        }
        control_ = value & (enable | 8);
    }
    // Simulates a failure of the noise source. The failure ends when the program clears and sets
    // RNGEN.
    void fail() { errors_ |= 0x44; }

    // Advances the state by a constant step and returns the next number, which is a mix of the
    // state's bits (SplitMix64).
    static uint32_t next(uint64_t& state) {
        uint64_t x = state += 0x9E3779B97F4A7C15ull;
        x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9ull;
        x = (x ^ x >> 27) * 0x94D049BB133111EBull;
        return static_cast<uint32_t>(x >> 32);
    }

private:
    static constexpr uint32_t enable = 1u << 2, ready = 1, noClockNow = 1u << 1, noClock = 1u << 5,
                              badSeedNow = 1u << 2, badSeed = 1u << 6;
    static constexpr uint64_t numberNs = 40 * 1000 / 48;

    uint64_t state_, readyNs_ = 0;
    uint32_t control_ = 0, errors_ = 0;
};
