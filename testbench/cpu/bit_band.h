// SPDX-License-Identifier: MIT
//
// bit_band: converts a bit-band alias address to the bit that it accesses. Each bit in the bit-band
// regions of RAM and peripherals has one word as its alias (B3.1, TRM 3.7).

#pragma once

#include <cstdint>

// The word and bit that an alias accesses.
struct BitBand {
    static bool isAlias(uint32_t address) {
        return address >> 25 == 0x22000000 >> 25 || address >> 25 == 0x42000000 >> 25;
    }
    explicit BitBand(uint32_t alias)
        : word((alias & 0xF0000000) + (alias & 0x1FFFFFF) / 128 * 4),
          bit((alias & 0x1FFFFFF) / 4 % 32) {}
    bool isRam() const { return word < 0x40000000; }
    uint32_t get(uint32_t value) const { return value >> bit & 1; }
    uint32_t set(uint32_t value, uint32_t to) const {
        return to & 1 ? value | 1u << bit : value & ~(1u << bit);
    }

    const uint32_t word; // address
    const unsigned bit;
};
