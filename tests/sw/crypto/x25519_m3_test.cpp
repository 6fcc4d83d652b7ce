// SPDX-License-Identifier: MIT
//
// x25519_m3_test: measures an X25519 multiplication in the ARM binary of the firmware on a
// Cortex-M3.

#include "plain_bus.h"
#include "random.h"
#include <gtest/gtest.h>

extern "C" {
#include "x25519.h"
}

namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t result = 0x20008000, number = result + 64, point = number + 64,
                   stack = result - 64;

TEST(X25519M3, TakesConstantTimeAndLittleStack) {
    PlainCpu m3(FIRMWARE_ELF);
    const uint32_t begin = m3.image.symbol("X25519") & ~1u;
    Random random(testSeed(1));
    std::vector<uint64_t> cycles;
    for (int i = 0; i < 3; ++i) {
        Bytes own(X25519_BYTES, static_cast<uint8_t>(i ? random.next() : 0)),
            peer = own, here = own, there = own;
        for (auto& byte : peer)
            byte = static_cast<uint8_t>(random.next());
        m3.cpu.writeMemory(number, own.data(), X25519_BYTES);
        m3.cpu.writeMemory(point, peer.data(), X25519_BYTES);
        const Bytes untouched(1024, 0xA5);
        m3.cpu.writeMemory(stack - 1024, untouched.data(), 1024);
        m3.cpu.setReg(0, result);
        m3.cpu.setReg(1, number);
        m3.cpu.setReg(2, point);
        m3.cpu.setReg(CortexM3::Sp, stack);
        m3.cpu.setReg(CortexM3::Lr, m3.image.symbol("Ascon_begin") | 1);
        m3.cpu.setReg(CortexM3::Pc, begin | 1);
        m3.cpu.breakpoints = {m3.image.symbol("Ascon_begin") & ~1u};
        const uint64_t before = m3.cpu.cycles();
        ASSERT_EQ(m3.cpu.run(), CortexM3::Stop::Breakpoint) << m3.cpu.lastFault;
        cycles.push_back(m3.cpu.cycles() - before);
        m3.cpu.readMemory(result, here.data(), X25519_BYTES);
        X25519(there.data(), own.data(), peer.data());
        EXPECT_EQ(here, there);
        EXPECT_EQ(m3.cpu.word(stack - 576), 0xA5A5A5A5u)
            << "X25519 used more than 576 bytes of stack";
    }
    EXPECT_LT(cycles[0], 12'000'000u); // this number of cycles takes 100 ms at 120 MHz
    // The model counts 2 more cycles for a multiplication before which it has stopped.
    EXPECT_NEAR(double(cycles[0]), double(cycles[1]), 4);
    EXPECT_EQ(cycles[1], cycles[2]);
    std::printf("%llu cycles\n", static_cast<unsigned long long>(cycles[0]));
}

} // namespace
