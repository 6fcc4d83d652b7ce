// SPDX-License-Identifier: MIT
//
// modes_test: the bridge in each asynchronous mode of the FSMC, at several ratios of the two
// clocks.

#include "VFsmcBridge.h"
#include "VFsmcBridgeMuxed.h"
#include "VFsmcBridgeWaitHigh.h"
#include "bridge_bench.h"
#include "fsmc_fields.h"
#include <gtest/gtest.h>
#include <map>

using namespace fsmc;

namespace {

constexpr uint32_t ddr = MAP_DDR_WINDOW, control = MAP_CONTROL_WINDOW;
constexpr uint32_t base = bcrEnable | bcrWidth16 | bcrWriteEnable | bcrAsyncWait;

struct Mode {
    const char* name;
    FSMC_Bank bank;
};
// mode, of writes, PSRAM, muxed, wait, wait high, BUSTURN, {ADDSET, ADDHLD, DATAST} of reads,
// writes
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
const Mode muxedModes[] = {
    {"muxed NOR", {FSMC_MODE_2, {}, 0, 1, 1, 0, 1, {2, 2, 4}, {}}},
    {"muxed PSRAM", {FSMC_MODE_1, {}, 1, 1, 1, 0, 2, {1, 1, 5}, {}}},
    {"muxed, extended", {FSMC_MODE_D, FSMC_MODE_D, 0, 1, 1, 0, 1, {3, 1, 4}, {1, 1, 4}}},
};

// Random traffic of all widths to both windows against a reference.
template <class Bridge> void traffic(const Mode& mode, unsigned hclk, unsigned clk) {
    SCOPED_TRACE(std::string("mode ") + mode.name + ", HCLK : clock = " + std::to_string(hclk) +
                 " : " + std::to_string(clk) + ", SEED=" + std::to_string(testSeed()));
    BridgeBench<Bridge> b(testSeed(), 0.2, hclk, clk);
    Random random(testSeed() + hclk);
    b.top.page_i =
        static_cast<uint8_t>(random.below(64)); // of the memory; as the system slot has it
    b.master.pauseWrites(random.chance(0.5));
    const uint32_t page = static_cast<uint32_t>(b.top.page_i) << 26;
    ASSERT_EQ(b.init(mode.bank), FSMC_OK);
    for (uint32_t reg : {0xA0000000u, 0xA0000004u, 0xA0000104u}) // NE3, another chip, as NE1
        b.master.write32(reg + 0x10, b.master.read32(reg));
    std::map<uint32_t, uint8_t> reference;
    std::map<uint32_t, uint32_t> words;
    uint32_t place = 0;
    for (int i = 0; i < 700 && !testing::Test::HasFailure(); ++i) {
        if (random.chance(0.04))
            place = random.below(0x3FF0000); // anywhere in the window
        uint32_t v = random.next(), a = place & ~1u, word = 1 + random.below(1023);
        switch (random.below(7)) {
        case 0:
            b.master.write8(ddr + place, static_cast<uint8_t>(v));
            reference[place++] = static_cast<uint8_t>(v);
            break;
        case 1:
        case 2:
            b.master.write16(ddr + a, static_cast<uint16_t>(v));
            reference[a] = static_cast<uint8_t>(v);
            reference[a + 1] = static_cast<uint8_t>(v >> 8);
            place += 2;
            break;
        case 3:
            if (random.chance(0.5))
                b.master.write32(control + 4 * word, words[word] = v);
            EXPECT_EQ(b.master.read32(control + 4 * word), words[word]) << "register " << word;
            break;
        case 4:
            EXPECT_EQ(b.master.read16(0x68000000 | a), 0xFFFF) << "another chip's";
            break;
        default:
            EXPECT_EQ(b.master.read16(ddr + a), reference[a] | reference[a + 1] << 8)
                << "access " << i;
            place += 2;
        }
        if (random.chance(0.1))
            b.master.idle(random.below(20));
    }
    EXPECT_EQ(b.errors, 0u);
    b.master.read32(control);
    for (auto& [a, v] : reference)
        EXPECT_EQ(b.memory.byte(page | a), v) << std::hex << a;
}

TEST(Modes, EveryAsynchronousModeAtEveryRatio) {
    for (const Mode& mode : plainModes)
        for (auto [hclk, clk] :
             {std::pair(120, 100), {100, 100}, {1000, 997}, {997, 1000}, {60, 100}, {168, 100}}) {
            if (hclk == 168 && mode.bank.read.addset < 2)
                continue; // 4 clocks between writes want ADDSET 2 at 168 MHz
            traffic<VFsmcBridge>(mode, hclk, clk);
        }
}

TEST(Modes, MultiplexedAddressAndData) {
    for (const Mode& mode : muxedModes)
        for (auto [hclk, clk] : {std::pair(120, 100), {1000, 997}, {60, 100}})
            traffic<VFsmcBridgeMuxed>(mode, hclk, clk);
}

TEST(Modes, NwaitActiveHighAndTheLargestBuffers) {
    for (Mode mode : plainModes) {
        mode.bank.waitHigh = 1;
        traffic<VFsmcBridgeWaitHigh>(mode, 120, 100);
    }
}

// An STM32F407 pauses between the halves of a written word; RM0033 promises that it does not.
TEST(Modes, BusturnOfWritesIsBetweenTheHalvesOfAWordOrNot) {
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

// A doorbell right after a read drops data that is read ahead, on its way or even requested in that
// very clock, since it is old. At 168 MHz the pins are quick enough: they have the doorbell's
// address already (here that of the block in its own window) while the memory's side still sees the
// read.
TEST(Modes, WhatADoorbellDropsOnItsWayIsNotTakenForFresh) {
    BridgeBench<VFsmcBridge> b(testSeed(), 0.1, 168, 100);
    ASSERT_EQ(b.init(plainModes[0].bank), FSMC_OK);
    Random random(testSeed());
    for (int i = 0; i < 1000 && !HasFailure(); ++i) {
        // Two misses fetch a block; when it is there the next one is asked for, near the second
        // read's end. Or, from a slow memory, it comes until after the doorbell.
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

TEST(Modes, TheDriverRefusesWhatTheManualForbids) {
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
                << "a read may begin too soon behind a write";
        EXPECT_TRUE(refuses(bank, [](FSMC_Bank& x) { x.writeMode = FSMC_MODE_1; }));
        EXPECT_TRUE(refuses(bank, [](FSMC_Bank& x) { x.mode = static_cast<FSMC_Mode>(7); }));
    }
    EXPECT_THROW(b.master.read16(control), FsmcError) << "bank 2 is off: nothing was written";
}

// The model is strict: it throws where a real STM32 would behave otherwise, or fail.
TEST(Modes, TheModelRefusesWhatTheManualForbids) {
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
    EXPECT_THROW(m.read16(ddr), FsmcError) << "NWAIT cannot be seen";
    set(base & ~bcrWriteEnable, timing(2, 4));
    EXPECT_THROW(m.write16(ddr, 1), FsmcError) << "WREN is 0";
    EXPECT_THROW(m.write32(registersAt + 0x20, 1), FsmcError);
    EXPECT_THROW(m.read16(0x70000000), FsmcError) << "no bank";
}

} // namespace
