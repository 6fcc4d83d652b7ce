// SPDX-License-Identifier: MIT
//
// sync_test: tests the synchronous bridge (fsmc_sync_bridge) in each mode of the FSMC that this
// bridge supports. The accesses and the expected data are as in the tests of fsmc_bridge.

#include "VFsmcBridge.h"
#include "VFsmcSyncBridge.h"
#include "VFsmcSyncBridgeMuxed.h"
#include "any_bridge.h"
#include "costs.h"
#include "pin_delays.h"

namespace {

// Timing that satisfies the bridge's rules up to an HCLK of 168 MHz: the strobes are high for 8
// HCLK cycles, 47.6 ns.
constexpr FSMC_Timing slow = {8, 4, 5};

struct Mode {
    const char* name;
    FSMC_Bank bank;
};
// members of FSMC_Bank: mode, mode of writes, PSRAM, muxed, wait, wait high, BUSTURN, timing of
// reads, timing of writes
constexpr FSMC_Bank bankA = {FSMC_MODE_A, FSMC_MODE_A, 0, 0, 1, 0, 1, slow, slow};
const Mode plainModes[] = {
    {"A", bankA},
    {"A PSRAM", {FSMC_MODE_A, FSMC_MODE_A, 1, 0, 1, 0, 2, slow, {9, 1, 12}}},
    {"C", {FSMC_MODE_C, FSMC_MODE_C, 0, 0, 1, 0, 1, slow, slow}},
    {"D", {FSMC_MODE_D, FSMC_MODE_D, 0, 0, 1, 0, 1, slow, slow}},
    {"read A, write D", {FSMC_MODE_A, FSMC_MODE_D, 0, 0, 1, 0, 1, slow, slow}},
};
const Mode muxedModes[] = {
    {"muxed NOR", {FSMC_MODE_2, {}, 0, 1, 1, 1, 1, slow, {}}},
    {"muxed PSRAM", {FSMC_MODE_1, {}, 1, 1, 1, 1, 2, slow, {}}},
    {"muxed, extended", {FSMC_MODE_D, FSMC_MODE_D, 0, 1, 1, 1, 1, slow, slow}},
};

using SyncBridge = AnyBridge<VFsmcSyncBridge>;

template <class Bridge> void trafficIn(const Mode& mode, unsigned hclk, unsigned clk) {
    SCOPED_TRACE(std::string("mode ") + mode.name + ", HCLK : clock = " + std::to_string(hclk) +
                 " : " + std::to_string(clk) + ", SEED=" + std::to_string(testSeed()));
    BridgeBench<Bridge> b(testSeed(), 0.2, hclk, clk);
    Random random(testSeed() + hclk);
    const uint32_t page = random.below(64); // page of the memory, as stored in the system slot
    b.top.page_i = static_cast<uint8_t>(page);
    b.master.pauseWrites(random.chance(0.5));
    ASSERT_EQ(b.init(mode.bank), FSMC_OK);
    b.keepEvents();
    traffic(b, testSeed() + hclk, 400, page << 26);
    EXPECT_EQ(b.slave.words[b.slave.clearWord], 0u) << "no access was late";
}

TEST(SyncModes, EveryModeWorksAtEveryRatio) {
    for (const Mode& mode : plainModes)
        for (auto [hclk, clk] :
             {std::pair(120, 100), {100, 100}, {1000, 997}, {997, 1000}, {60, 100}, {168, 100}})
            trafficIn<VFsmcSyncBridge>(mode, hclk, clk);
}

TEST(SyncModes, MultiplexedAddressAndDataWork) {
    for (const Mode& mode : muxedModes)
        for (auto [hclk, clk] : {std::pair(120, 100), {1000, 997}, {60, 100}, {168, 100}})
            trafficIn<VFsmcSyncBridgeMuxed>(mode, hclk, clk);
}

TEST_F(SyncBridge, MemoryEqualsAReferenceWithAllWidths) {
    traffic(b_, testSeed(), 3000);
}

TEST_F(SyncBridge, ADoorbellFlushesWritesAndDiscardsReadAheadData) {
    doorbellMakesWritesVisibleAndReadsFresh();
}

TEST_F(SyncBridge, ASlaveErrorIsReportedWithItsAddress) {
    errorOfTheSlaveIsReportedWithItsPlace();
}

TEST_F(SyncBridge, AHungSlaveCausesAnErrorAndTheBridgeContinues) {
    hungSlaveEndsInAnError();
}

TEST_F(SyncBridge, AHungMemoryCausesAnErrorAndTheBridgeContinues) {
    readOfAHungMemoryEndsInAnError();
    for (unsigned i = 0; b_.errors == 1 && i < 32; ++i)
        fsmc_.write16(ddr + 0x1000 + 8 * i, static_cast<uint16_t>(0xA000 + i));
    EXPECT_EQ(b_.errors, 2u) << "a write that finds no room";
    EXPECT_TRUE(b_.errorWrite);
    memoryWorksAgain();
    EXPECT_EQ(fsmc_.read16(ddr + 0x1000), 0xA000);
}

// The processor may abandon an access at any time. A write is then carried out completely or not
// at all, and the next accesses are right.
TEST_F(SyncBridge, AnAbortedAccessIsDoneCompletelyOrNotAtAll) {
    Random random(testSeed());
    for (int i = 0; i < 400 && !HasFailure(); ++i) {
        const uint32_t value = random.next();
        const auto other = static_cast<uint16_t>(random.next());
        const unsigned word = 1 + random.below(100), hclk = 1 + random.below(30);
        const uint32_t a = 2 * random.below(0x1FF8000);
        fsmc_.write32(at(word), value);
        fsmc_.write16(ddr + a, static_cast<uint16_t>(value));
        bool mayBeWritten = false;
        switch (random.below(4)) {
        case 0:
            fsmc_.abortRead(at(word), hclk);
            break;
        case 1:
            fsmc_.abortRead(ddr + a, hclk);
            break;
        case 2:
            fsmc_.abortWrite(at(word), other, hclk);
            break;
        default:
            fsmc_.abortWrite(ddr + a, other, hclk);
            mayBeWritten = true;
        }
        EXPECT_EQ(fsmc_.read32(at(word)), value) << "SEED=" << testSeed();
        const uint16_t now = fsmc_.read16(ddr + a);
        EXPECT_TRUE(now == static_cast<uint16_t>(value) || (mayBeWritten && now == other)) << now;
        fsmc_.write32(at(word), ~value);
        EXPECT_EQ(fsmc_.read32(at(word)), ~value);
    }
    EXPECT_EQ(b_.errors, 0u);
}

// NWAIT is off, against the rules of the bridge. An access that ends before the bridge has answered
// is reported.
TEST_F(SyncBridge, AProcessorThatIgnoresNwaitIsReported) {
    const uint32_t& event = b_.slave.words[MAP_SLOT_SYSTEM * 16 + SYSTEM_EVENT];
    b_.keepEvents();
    const uint32_t bcr1 = fsmc_.read32(fsmc::registersAt);
    b_.memory.hold(true);
    fsmc_.tolerate();
    fsmc_.write32(fsmc::registersAt, bcr1 & ~fsmc::bcrAsyncWait);
    fsmc_.read16(ddr + 0x200);
    fsmc_.idle(8);
    EXPECT_EQ(event, unsigned(SYSTEM_EVENT_LATE_MASK));
    b_.memory.hold(false);
    fsmc_.write32(fsmc::registersAt, bcr1);
    fsmc_.write16(ddr + 0x200, 0x1357);
    EXPECT_EQ(fsmc_.read16(ddr + 0x200), 0x1357);
}

// The cost in time of the synchronous bridge, at 120 MHz, with the settings of the driver.
TEST(SyncCost, AnAccessTakesLessThanThreeTimesAsLong) {
    constexpr FSMC_Timing driver = {2, 1, 4}, sync = {6, 1, 5};
    const auto plain = costs<VFsmcBridge>({FSMC_MODE_1, {}, 0, 0, 1, 0, 1, driver, {}});
    const auto slower =
        costs<VFsmcSyncBridge>({FSMC_MODE_A, FSMC_MODE_A, 0, 0, 1, 0, 1, sync, sync});
    showCosts("synchronous bridge", plain, slower);
    for (unsigned i = 0; i < 4; ++i)
        EXPECT_LT(slower[i], 3 * plain[i]) << costNames[i];
}

// Pins with the delays and the skew of the STM32, the board and the FPGA, in each corner.
TEST(SyncCorners, NoAccessIsLostWithLatePins) {
    for (unsigned corner = 0; corner < std::size(fsmcCorners); ++corner)
        for (unsigned hclk : {60u, 100u, 120u})
            for (bool looksTwice : {false, true}) {
                const FsmcCorner delays = cornerOf(corner, hclk);
                SCOPED_TRACE(std::string(delays.name) + ", HCLK " + std::to_string(hclk) +
                             " MHz, looks " + (looksTwice ? "twice" : "once") +
                             ", SEED=" + std::to_string(testSeed()));
                BridgeBench<VFsmcSyncBridge> b(testSeed() + hclk, 0.5, hclk, 100);
                b.keepEvents();
                b.delay(delays, testSeed() + corner, looksTwice);
                b.master.pauseWrites(looksTwice);
                ASSERT_EQ(b.init(bankA), FSMC_OK);
                traffic(b, testSeed() + hclk, 300);
                EXPECT_EQ(b.slave.words[b.slave.clearWord], 0u) << "no access was late";
                if (HasFailure())
                    return;
            }
}

} // namespace
