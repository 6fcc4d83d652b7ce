// SPDX-License-Identifier: MIT
//
// costs: measures how many HCLK cycles an access through a bridge takes, at 120 MHz.

#pragma once

#include "traffic.h"
#include <array>
#include <cstdio>

inline const char* const costNames[] = {"write_memory", "read_memory", "write_register",
                                        "read_register"};

// Returns the number of HCLK cycles for each of four accesses: writing a halfword, reading the next
// halfword of a sequence, writing a word of a register, reading a word of a register.
template <class Bridge> std::array<double, 4> costs(const FSMC_Bank& bank) {
    BridgeBench<Bridge> b(testSeed(), 0, 120, 100);
    EXPECT_EQ(b.init(bank), FSMC_OK);
    constexpr unsigned count = 2000;
    auto cost = [&](auto&& access) {
        const uint64_t start = b.master.hclks();
        for (unsigned i = 0; i < count; ++i)
            access(i);
        return static_cast<double>(b.master.hclks() - start) / count;
    };
    return {cost([&](unsigned i) { b.master.write16(ddr + 2 * i, 1); }),
            cost([&](unsigned i) { b.master.read16(ddr + 2 * i); }),
            cost([&](unsigned i) { b.master.write32(control + 4 * (64 + i % 900), i); }),
            cost([&](unsigned i) { b.master.read32(control + 4 * (64 + i % 900)); })};
}

// Prints and records the costs of a bridge next to the costs of fsmc_bridge.
inline void showCosts(const char* name, const std::array<double, 4>& plain,
                      const std::array<double, 4>& other) {
    for (unsigned i = 0; i < 4; ++i) {
        testing::Test::RecordProperty(costNames[i],
                                      std::to_string(plain[i]) + " " + std::to_string(other[i]));
        std::printf("%s: %.1f HCLK, %s %.1f\n", costNames[i], plain[i], name, other[i]);
    }
}
