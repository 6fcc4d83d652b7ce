// SPDX-License-Identifier: MIT
//
// bits: fields of a Verilated module's packed port, for any of Verilator's types.

#ifndef BITS_H
#define BITS_H

#include <cstdint>
#include <type_traits>

// Bits lsb..lsb+width-1 (width up to 64, the field within two 32-bit words of a wide port).
template <class Port> uint64_t getBits(const Port& port, unsigned lsb, unsigned width) {
    uint64_t mask = width == 64 ? ~0ull : (1ull << width) - 1;
    if constexpr (std::is_integral_v<Port>) {
        return static_cast<uint64_t>(port) >> lsb & mask;
    } else {
        uint64_t value = port[lsb / 32] >> (lsb % 32);
        if (lsb % 32 + width > 32)
            value |= static_cast<uint64_t>(port[lsb / 32 + 1]) << (32 - lsb % 32);
        return value & mask;
    }
}

template <class Port> void setBits(Port& port, unsigned lsb, unsigned width, uint64_t value) {
    uint64_t mask = width == 64 ? ~0ull : (1ull << width) - 1;
    if constexpr (std::is_integral_v<Port>) {
        port = static_cast<Port>((port & ~(mask << lsb)) | (value & mask) << lsb);
    } else {
        for (unsigned done = 0; done < width;) {
            unsigned at = (lsb + done) % 32, step = width - done < 32 - at ? width - done : 32 - at;
            uint32_t part = step == 32 ? ~0u : (1u << step) - 1;
            auto& word = port[(lsb + done) / 32];
            word = (word & ~(part << at)) | (static_cast<uint32_t>(value >> done) & part) << at;
            done += step;
        }
    }
}

#endif
