// SPDX-License-Identifier: MIT
//
// traffic: makes random accesses through the bridge, and compares them with references.

#pragma once

#include "bridge_bench.h"
#include <gtest/gtest.h>
#include <map>

constexpr uint32_t ddr = MAP_DDR_WINDOW, control = MAP_CONTROL_WINDOW;

// Bytes that were sent to the memory, for comparison.
struct Written {
    std::map<uint32_t, uint8_t> bytes;

    void set(uint32_t a, unsigned size, uint32_t v) {
        for (unsigned i = 0; i < size; ++i)
            bytes[a + i] = static_cast<uint8_t>(v >> (8 * i));
    }
    uint32_t value(uint32_t a, unsigned size) {
        uint32_t v = 0;
        for (unsigned i = 0; i < size; ++i)
            v |= static_cast<uint32_t>(bytes[a + i]) << (8 * i);
        return v;
    }
};

// Makes accesses of all widths to both windows and to another chip. Accesses to memory are
// sequences at consecutive addresses, with jumps between the sequences. Accesses to registers also
// follow each other without a pause, so that each write must wait for the previous one.
template <class Bridge>
void traffic(BridgeBench<Bridge>& b, uint64_t seed, int accesses, uint32_t page = 0) {
    FsmcMaster& m = b.master;
    // NE3 belongs to another chip and gets the timing of NE1
    for (uint32_t reg : {0xA0000000u, 0xA0000004u, 0xA0000104u})
        m.write32(reg + 0x10, m.read32(reg));
    Random random(seed);
    Written memory;
    std::map<uint32_t, uint32_t> words;
    uint32_t places[16], place = 0; // random places in the window
    for (uint32_t& each : places)
        each = random.below(0x3FF00) << 8;
    for (int i = 0; i < accesses && !testing::Test::HasFailure(); ++i) {
        if (i == 0 || random.chance(0.05))
            place = places[random.below(16)] + random.below(256);
        const uint32_t v = random.next(), word = 64 + random.below(900);
        uint32_t half = place & ~1u, whole = place & ~3u;
        switch (random.below(10)) {
        case 0:
            m.write8(ddr + place, static_cast<uint8_t>(v)), memory.set(place, 1, v), place += 1;
            break;
        case 1:
            for (unsigned k = 1 + random.below(20); k; --k, half += 2)
                m.write16(ddr + half, static_cast<uint16_t>(v * k)), memory.set(half, 2, v * k);
            place = half;
            break;
        case 2:
            m.write32(ddr + whole, v), memory.set(whole, 4, v), place += 4;
            break;
        case 3:
            EXPECT_EQ(m.read8(ddr + place), memory.value(place, 1)) << "access " << i;
            break;
        case 4:
            EXPECT_EQ(m.read32(ddr + whole), memory.value(whole, 4)) << "access " << i;
            break;
        case 5:
            for (unsigned k = 0; k < 8; ++k)
                m.write32(control + 4 * (word + k), words[word + k] = v + k);
            break;
        case 6:
            EXPECT_EQ(m.read32(control + 4 * word), words[word]) << "register " << word;
            break;
        case 7:
            EXPECT_EQ(m.read32(control), SYSTEM_ID_VALUE);
            EXPECT_EQ(m.read16(0x68000000 | half), 0xFFFF)
                << "this address belongs to another chip";
            break;
        default:
            half -= half % 256 < 20 ? 0 : 2 * random.below(10);
            EXPECT_EQ(m.read16(ddr + half), memory.value(half, 2)) << "access " << i;
            place += 2;
        }
        if (random.chance(0.1))
            m.idle(random.below(20));
    }
    m.read32(control); // when this read ends, all writes have reached the memory
    EXPECT_EQ(b.errors, 0u);
    for (auto [at, v] : memory.bytes)
        EXPECT_EQ(b.memory.byte(page | at), v) << std::hex << at;
    for (auto [at, v] : words)
        EXPECT_EQ(b.slave.words[at], v) << "register " << at;
}
