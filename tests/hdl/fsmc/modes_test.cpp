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

constexpr uint32_t ddr = 0x60000000, control = 0x64000000;

struct Mode {
    const char* name;
    uint32_t bcr, btr, bwtr;
};
constexpr uint32_t base = bcrEnable | bcrWidth16 | bcrWriteEnable | bcrAsyncWait;
// ADDSET, DATAST, BUSTURN, ADDHLD, ACCMOD
const Mode plainModes[] = {
    {"1", base, timing(2, 4, 1), 0},
    {"1 slow", base, timing(15, 20, 15), 0},
    {"1 PSRAM", base | bcrTypePsram, timing(1, 4, 1), 0},
    {"A", base | bcrExtended, timing(2, 4, 1, 1, 0), timing(1, 5, 0, 1, 0)},
    {"A write fast", base | bcrExtended, timing(3, 6, 0, 1, 0), timing(1, 4, 0, 1, 0)},
    {"2", base | bcrTypeNor | bcrFlashAccess, timing(2, 4, 1), 0},
    {"B", base | bcrTypeNor | bcrFlashAccess | bcrExtended, timing(2, 4, 1, 1, 1),
     timing(2, 4, 0, 1, 1)},
    {"C", base | bcrTypeNor | bcrFlashAccess | bcrExtended, timing(2, 4, 1, 1, 2),
     timing(2, 4, 0, 1, 2)},
    {"D", base | bcrTypeNor | bcrFlashAccess | bcrExtended, timing(2, 4, 1, 2, 3),
     timing(2, 4, 0, 2, 3)},
    {"read A, write D", base | bcrExtended, timing(2, 4, 1, 1, 0), timing(1, 4, 0, 3, 3)},
};
const Mode muxedModes[] = {
    {"muxed NOR", base | bcrTypeNor | bcrFlashAccess | bcrMuxed, timing(2, 4, 1, 2), 0},
    {"muxed PSRAM", base | bcrTypePsram | bcrMuxed, timing(1, 5, 2, 1), 0},
    {"muxed, extended", base | bcrTypeNor | bcrMuxed | bcrExtended, timing(3, 4, 1, 1, 3),
     timing(1, 4, 1, 1, 3)},
};

// Random traffic of all widths to both windows against a reference.
template <class Bridge> void traffic(const Mode& mode, unsigned hclk, unsigned clk) {
    SCOPED_TRACE(std::string("mode ") + mode.name + ", HCLK : clock = " + std::to_string(hclk) +
                 " : " + std::to_string(clk) + ", SEED=" + std::to_string(testSeed()));
    BridgeBench<Bridge> b(testSeed(), 0.2, hclk, clk);
    for (uint32_t bank : {0u, 1u}) {
        b.master.write32(registersAt + 4 + 8 * bank, mode.btr);
        b.master.write32(registersAt + 0x104 + 8 * bank, mode.bwtr);
        b.master.write32(registersAt + 8 * bank, mode.bcr);
    }
    Random random(testSeed() + hclk);
    std::map<uint32_t, uint8_t> reference;
    std::map<uint32_t, uint32_t> words;
    uint32_t place = 0;
    for (int i = 0; i < 700 && !testing::Test::HasFailure(); ++i) {
        if (random.chance(0.04))
            place = random.below(4) << 17 | random.below(256); // upper address bits too
        uint32_t v = random.next(), a = place & ~1u, word = random.below(1024);
        switch (random.below(6)) {
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
        default:
            EXPECT_EQ(b.master.read16(ddr + a), reference[a] | reference[a + 1] << 8)
                << "access " << i;
            place += 2;
        }
        if (random.chance(0.1))
            b.master.idle(random.below(20));
    }
    EXPECT_EQ(b.errors, 0u);
}

TEST(Modes, EveryAsynchronousModeAtEveryRatio) {
    for (const Mode& mode : plainModes)
        for (auto [hclk, clk] :
             {std::pair(120, 100), {100, 100}, {1000, 997}, {997, 1000}, {60, 100}, {168, 100}}) {
            if (hclk == 168 && (mode.btr & 0xF) < 2)
                continue; // 4 clocks between writes want ADDSET 2 at 168 MHz
            traffic<VFsmcBridge>(mode, hclk, clk);
        }
}

TEST(Modes, MultiplexedAddressAndData) {
    for (const Mode& mode : muxedModes)
        for (auto [hclk, clk] : {std::pair(120, 100), {1000, 997}, {60, 100}})
            traffic<VFsmcBridgeMuxed>(mode, hclk, clk);
}

TEST(Modes, NwaitActiveHighAndSmallBuffers) {
    for (Mode mode : plainModes) {
        mode.bcr |= bcrWaitHigh;
        traffic<VFsmcBridgeWaitHigh>(mode, 120, 100);
    }
}

// The model is strict: what a real STM32 would not do, or what would not work, throws.
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
