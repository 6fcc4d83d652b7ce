// SPDX-License-Identifier: MIT
//
// modes_test: tests the bridge in each asynchronous mode of the FSMC, at several ratios of the two
// clocks.

#include "VFsmcBridge.h"
#include "VFsmcBridgeMuxed.h"
#include "VFsmcBridgeWaitHigh.h"
#include "costs.h"
#include "pin_delays.h"
#include "traffic.h"
#include <vector>

using namespace fsmc;

namespace {

constexpr uint32_t base = bcrEnable | bcrWidth16 | bcrWriteEnable | bcrAsyncWait;

struct Mode {
    const char* name;
    FSMC_Bank bank;
};
// members of FSMC_Bank: mode, mode of writes, PSRAM, muxed, wait, wait high, BUSTURN, {ADDSET,
// ADDHLD, DATAST} of reads, the same of writes
const Mode plainModes[] = {
    {"1", {FSMC_MODE_1, {}, 0, 0, 1, 0, 1, {2, 1, 4}, {}}},
    {"1 slow", {FSMC_MODE_1, {}, 0, 0, 1, 0, 15, {15, 1, 20}, {}}},
    {"1 PSRAM", {FSMC_MODE_1, {}, 1, 0, 1, 0, 1, {1, 1, 4}, {}}},
    {"A", {FSMC_MODE_A, FSMC_MODE_A, 0, 0, 1, 0, 1, {2, 1, 4}, {1, 1, 5}}},
    {"A write fast", {FSMC_MODE_A, FSMC_MODE_A, 1, 0, 1, 0, 1, {3, 1, 6}, {1, 1, 4}}},
    {"2", {FSMC_MODE_2, {}, 0, 0, 1, 0, 1, {2, 1, 4}, {}}},
    {"B", {FSMC_MODE_B, FSMC_MODE_B, 0, 0, 1, 0, 1, {2, 1, 4}, {2, 1, 4}}},
    {"C", {FSMC_MODE_C, FSMC_MODE_C, 0, 0, 1, 0, 1, {2, 1, 4}, {2, 1, 4}}},
    {"D", {FSMC_MODE_D, FSMC_MODE_D, 0, 0, 1, 0, 1, {2, 2, 4}, {2, 2, 4}}},
    {"read A, write D", {FSMC_MODE_A, FSMC_MODE_D, 0, 0, 1, 0, 1, {2, 1, 4}, {1, 3, 4}}},
};
// The driver's settings (BTR_VALUE in sw/fsmc/fsmc.c) without and with a multiplexed address.
constexpr FSMC_Bank driverBank = {FSMC_MODE_1, {}, 0, 0, 1, 0, 1, {2, 1, 4}, {}};
constexpr FSMC_Bank muxedBank = {FSMC_MODE_1, {}, 1, 1, 1, 0, 2, {2, 2, 6}, {}};
const Mode muxedModes[] = {
    {"muxed, driver", muxedBank},
    {"muxed NOR", {FSMC_MODE_2, {}, 0, 1, 1, 0, 1, {2, 2, 4}, {}}},
    {"muxed PSRAM", {FSMC_MODE_1, {}, 1, 1, 1, 0, 2, {1, 1, 5}, {}}},
    {"muxed, extended", {FSMC_MODE_D, FSMC_MODE_D, 0, 1, 1, 0, 1, {3, 1, 4}, {1, 1, 4}}},
};

template <class Bridge> void trafficIn(const Mode& mode, unsigned hclk, unsigned clk) {
    SCOPED_TRACE(std::string("mode ") + mode.name + ", HCLK : clock = " + std::to_string(hclk) +
                 " : " + std::to_string(clk) + ", SEED=" + std::to_string(testSeed()));
    BridgeBench<Bridge> b(testSeed(), 0.2, hclk, clk);
    Random random(testSeed() + hclk);
    const uint32_t page = random.below(64); // memory page that the system slot stores
    b.top.page_i = static_cast<uint8_t>(page);
    b.master.pauseWrites(random.chance(0.5));
    ASSERT_EQ(b.init(mode.bank), FSMC_OK);
    traffic(b, testSeed() + hclk, 400, page << 26);
}

TEST(Modes, EveryAsynchronousModeWorksAtEveryRatio) {
    for (const Mode& mode : plainModes)
        for (auto [hclk, clk] :
             {std::pair(120, 100), {100, 100}, {1000, 997}, {997, 1000}, {60, 100}, {168, 100}}) {
            if (hclk == 168 && mode.bank.read.addset < 2)
                continue; // at 168 MHz, 4 clocks between two writes require an ADDSET of 2
            trafficIn<VFsmcBridge>(mode, hclk, clk);
        }
}

TEST(Modes, MultiplexedAddressAndDataWork) {
    for (const Mode& mode : muxedModes)
        for (auto [hclk, clk] : {std::pair(120, 100), {1000, 997}, {60, 100}})
            trafficIn<VFsmcBridgeMuxed>(mode, hclk, clk);
}

// Pins with the delays and the skew of the STM32, the board and the FPGA, in each corner.
TEST(Modes, MultiplexedAddressAndDataWorkWithLatePins) {
    for (unsigned corner = 0; corner < std::size(fsmcCorners); ++corner)
        for (const bool looksTwice : {false, true}) {
            const FsmcCorner delays = cornerOf(corner, 120);
            SCOPED_TRACE(std::string(delays.name) + ", SEED=" + std::to_string(testSeed()));
            BridgeBench<VFsmcBridgeMuxed> b(testSeed(), 0.5, 120, 100);
            b.keepEvents();
            b.delay(delays, testSeed() + corner, looksTwice);
            b.master.pauseWrites(looksTwice);
            ASSERT_EQ(b.init(muxedBank), FSMC_OK);
            traffic(b, testSeed(), 400);
            EXPECT_EQ(b.slave.words[b.slave.clearWord], 0u) << "no access was late";
            if (HasFailure())
                return;
        }
}

// The cost in time of a multiplexed address, at 120 MHz, with the driver's settings. Blocks: with
// a multiplexed address, they are copied with NWAIT; otherwise they are streamed without it.
TEST(MuxedCost, AnAccessTakesAtMostFiveMoreHclk) {
    const auto plain = costs<VFsmcBridge>(driverBank);
    const auto muxed = costs<VFsmcBridgeMuxed>(muxedBank);
    showCosts("multiplexed", plain, muxed);
    for (unsigned i = 0; i < 4; ++i) {
        const unsigned accesses = i < 2 ? 1 : 2; // a register word takes two accesses
        EXPECT_LE(muxed[i], plain[i] + 5 * accesses) << costNames[i];
    }
    BridgeBench<VFsmcBridge> b(testSeed(), 0, 120, 100);
    b.keepEvents();
    ASSERT_EQ(b.init(), FSMC_OK);
    FSMC_setHclk(120'000'000);
    std::vector<U16> data(2048);
    const char* const names[] = {"write_block", "read_block"};
    for (unsigned i = 0; i < 2; ++i) {
        const uint64_t start = b.master.hclks();
        const U32 repeated =
            i ? FSMC_streamRead(0, data.data(), 2048) : FSMC_streamWrite(0, data.data(), 2048);
        EXPECT_EQ(repeated, 0u);
        const double streamed = static_cast<double>(b.master.hclks() - start) / 2048;
        std::printf("%s: %.1f HCLK, multiplexed %.1f\n", names[i], streamed, muxed[i]);
        EXPECT_LT(streamed, muxed[i]);
    }
}

TEST(Modes, NwaitActiveHighWorksWithTheLargestBuffers) {
    for (Mode mode : plainModes) {
        mode.bank.waitHigh = 1;
        trafficIn<VFsmcBridgeWaitHigh>(mode, 120, 100);
    }
}

// An STM32F407 pauses between the halves of a written word; according to RM0033 it does not pause.
TEST(Modes, BusturnMayPauseBetweenTheHalvesOfAWrittenWord) {
    BridgeBench<VFsmcBridge> b(testSeed(), 0, 120, 100);
    FSMC_Bank bank = {FSMC_MODE_A, FSMC_MODE_A, 0, 0, 1, 0, 1, {2, 1, 4}, {2, 1, 4}};
    auto hclksOfAWord = [&](uint8_t busturn, bool pauses) {
        bank.busturn = busturn;
        EXPECT_EQ(b.init(bank), FSMC_OK);
        b.master.pauseWrites(pauses);
        (void)b.master.read32(control);
        b.master.idle(20);
        const uint64_t start = b.master.hclks();
        b.master.write32(ddr, 1);
        return b.master.hclks() - start;
    };
    EXPECT_EQ(hclksOfAWord(4, true), hclksOfAWord(1, true) + 3);
    EXPECT_EQ(hclksOfAWord(4, false), hclksOfAWord(1, false));
}

// After a doorbell, which is an access to a register, the bridge must discard data that it has read
// ahead, because this data may be old. It must also discard data that is still arriving, or that is
// requested in the clock of the doorbell. At 168 MHz, the pins can already have the doorbell's
// address while the memory's side still sees the read. In this test, the doorbell and the block
// have the same address within their windows.
TEST(Modes, DataDiscardedByADoorbellIsNeverReturned) {
    BridgeBench<VFsmcBridge> b(testSeed(), 0.1, 168, 100);
    ASSERT_EQ(b.init(plainModes[0].bank), FSMC_OK);
    Random random(testSeed());
    for (int i = 0; i < 1000 && !HasFailure(); ++i) {
        // The second of two misses fetches a block. When the block is complete, the next block is
        // requested, near the end of the second read. If the memory is slow, the next block is
        // still arriving when the doorbell comes.
        const bool slow = random.chance(0.5);
        b.memory.setStall(slow ? 0.7 : 0.1);
        const uint32_t block = 64 * random.below(60), next = block + 64;
        b.master.read16(ddr + block);
        b.master.read16(ddr + block + 2 * (slow ? 31 : 12 + random.below(8)));
        if (slow)
            b.master.idle(random.below(20));
        uint16_t value = static_cast<uint16_t>(random.next());
        b.memory.setByte(next, static_cast<uint8_t>(value)); // another master
        b.memory.setByte(next + 1, static_cast<uint8_t>(value >> 8));
        b.master.read16(control + block);
        EXPECT_EQ(b.master.read16(ddr + next), value) << "SEED=" << testSeed() << " read " << i;
    }
    EXPECT_EQ(b.errors, 0u);
}

TEST(Modes, TheDriverRefusesSettingsForbiddenByTheManual) {
    BridgeBench<VFsmcBridge> b(testSeed());
    const FSMC_Bank good = plainModes[8].bank; // D
    auto refuses = [&](unsigned bank, auto change) {
        FSMC_Bank banks[2] = {good, good};
        change(banks[bank]);
        return FSMC_initBanks(&driverPort, &b.master, banks) == FSMC_BAD_SETTING;
    };
    for (unsigned bank : {0u, 1u}) {
        EXPECT_TRUE(refuses(bank, [](FSMC_Bank& x) { x.read.datast = 3; })) << "NWAIT is not seen";
        EXPECT_TRUE(refuses(bank, [](FSMC_Bank& x) { x.wait = 0, x.write.datast = 0; }));
        EXPECT_TRUE(refuses(bank, [](FSMC_Bank& x) { x.write.addhld = 0; }))
            << "reserved in mode D";
        EXPECT_TRUE(refuses(bank, [](FSMC_Bank& x) { x.read.addset = 16; }));
        EXPECT_TRUE(refuses(bank, [](FSMC_Bank& x) { x.read.addhld = 16; }));
        for (unsigned busturn : {0u, 16u})
            EXPECT_TRUE(refuses(bank, [=](FSMC_Bank& x) { x.busturn = static_cast<U8>(busturn); }))
                << "a read may begin too soon after a write";
        EXPECT_TRUE(refuses(bank, [](FSMC_Bank& x) { x.writeMode = FSMC_MODE_1; }));
        EXPECT_TRUE(refuses(bank, [](FSMC_Bank& x) { x.mode = static_cast<FSMC_Mode>(7); }));
    }
    EXPECT_THROW(b.master.read16(control), FsmcError)
        << "bank 2 is still off, because nothing was written";
}

// The model is strict: it throws if a real STM32 would behave in another way, or would fail.
TEST(Modes, TheModelRefusesSettingsForbiddenByTheManual) {
    BridgeBench<VFsmcBridge> b(testSeed());
    FsmcMaster& m = b.master;
    auto set = [&](uint32_t bcr, uint32_t btr) {
        m.write32(registersAt, bcr);
        m.write32(registersAt + 4, btr);
    };
    EXPECT_THROW(m.read16(control), FsmcError) << "bank 2 is off after reset";
    set(base, timing(2, 0));
    EXPECT_THROW(m.read16(ddr), FsmcError) << "DATAST 0 is reserved";
    set(base, timing(2, 3));
    EXPECT_THROW(m.read16(ddr), FsmcError) << "the write is too short for NWAIT";
    set(base & ~bcrWriteEnable, timing(2, 4));
    EXPECT_THROW(m.write16(ddr, 1), FsmcError) << "WREN is 0";
    EXPECT_THROW(m.write32(registersAt + 0x20, 1), FsmcError);
    EXPECT_THROW(m.read16(0x70000000), FsmcError) << "this address is in no bank";
}

} // namespace
