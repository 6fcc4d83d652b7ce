// SPDX-License-Identifier: MIT
//
// corners_test: tests the bridge with real wires: its pins have separate delays and skew. The
// tests cover each corner, several frequencies of HCLK, and both interpretations of when
// the FSMC samples NWAIT.

#include "VFsmcBridge.h"
#include "pin_delays.h"
#include "traffic.h"

namespace {

// Runs each case in a separate bench; each message contains the name of the case.
template <class Case> void inEveryCorner(double stall, Case&& run) {
    for (unsigned corner = 0; corner < std::size(fsmcCorners); ++corner)
        for (unsigned hclk : {60u, 100u, 120u})
            for (bool looksTwice : {false, true}) {
                const FsmcCorner delays = cornerOf(corner, hclk);
                SCOPED_TRACE(std::string(delays.name) + ", HCLK " + std::to_string(hclk) +
                             " MHz, looks " +
                             (looksTwice ? "twice, pauses between writes" : "once") +
                             ", SEED=" + std::to_string(testSeed()));
                BridgeBench<VFsmcBridge> b(testSeed() + hclk, stall, hclk, 100);
                b.keepEvents();
                b.delay(delays, testSeed() + corner, looksTwice);
                b.master.pauseWrites(looksTwice);
                run(b, hclk);
                if (testing::Test::HasFailure())
                    return;
            }
}

TEST(Corners, NoAccessIsLostWithTheDriversTiming) {
    for (double stall : {0.3, 0.95})
        inEveryCorner(stall, [](BridgeBench<VFsmcBridge>& b, unsigned hclk) {
            ASSERT_EQ(b.init(), FSMC_OK);
            traffic(b, testSeed() + hclk, 300);
        });
}

// NOE falls after the address phase, so NWAIT of a read comes late. Therefore DATAST is 6.
TEST(Corners, EveryModeWorksWithTimeForNwait) {
    for (FSMC_Mode mode : {FSMC_MODE_A, FSMC_MODE_2, FSMC_MODE_B, FSMC_MODE_C, FSMC_MODE_D})
        inEveryCorner(0.9, [mode](BridgeBench<VFsmcBridge>& b, unsigned hclk) {
            const FSMC_Bank bank = {mode, mode, 0, 0, 1, 0, 1, {2, 2, 6}, {2, 2, 6}};
            ASSERT_EQ(b.init(bank), FSMC_OK);
            traffic(b, testSeed() + hclk, 300);
        });
}

TEST(Corners, StreamsAreCorrectAtFullSpeed) {
    inEveryCorner(0, [](BridgeBench<VFsmcBridge>& b, unsigned hclk) {
        ASSERT_EQ(b.init(), FSMC_OK);
        FSMC_setHclk(hclk * 1000000);
        Random random(testSeed());
        auto out = random.items<uint16_t>(4000);
        std::vector<uint16_t> in(out.size());
        const U32 count = static_cast<U32>(out.size());
        uint64_t start = b.master.hclks();
        EXPECT_EQ(FSMC_streamWrite(0x400, out.data(), count), 0u) << "repeated";
        double write = static_cast<double>(count) / static_cast<double>(b.master.hclks() - start);
        start = b.master.hclks();
        EXPECT_EQ(FSMC_streamRead(0x400, in.data(), count), 0u) << "repeated";
        double read = static_cast<double>(count) / static_cast<double>(b.master.hclks() - start);
        EXPECT_EQ(in, out);
        for (unsigned i = 0; i < count; ++i)
            EXPECT_EQ(b.memory.byte(0x400 + 2 * i) | b.memory.byte(0x401 + 2 * i) << 8, out[i])
                << i;
        if (hclk == 100) { // fraction of 25 million accesses per second
            EXPECT_GT(write * 4, 0.99);
            EXPECT_GT(read * 4, 0.95);
        }
    });
}

// A chip that waits for its PLL must not stop the processor's bus.
TEST(Corners, NwaitIsInactiveDuringResetEvenWithoutAClock) {
    BridgeBench<VFsmcBridge> b(testSeed());
    b.top.rst_i = 1;
    for (unsigned ne : {0xEu, 0xDu})
        for (bool write : {false, true}) {
            b.pins.neN = static_cast<uint8_t>(ne);
            b.pins.noeN = write;
            b.pins.nweN = !write;
            b.settle();
            EXPECT_TRUE(b.pins.nwaitN) << "NE " << ne << (write ? ", writing" : ", reading");
            b.pins.neN = 0xF, b.pins.noeN = b.pins.nweN = true;
            b.settle();
        }
}

} // namespace
