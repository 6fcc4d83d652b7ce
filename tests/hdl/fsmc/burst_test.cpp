// SPDX-License-Identifier: MIT
//
// burst_test: the bridge with a synchronous NE1: bursts of every length, registers in between, slow
// and hung memories.

#include "VFsmcBridgeSync.h"
#include "VFsmcBridgeSyncLate.h"
#include "VFsmcBridgeSyncMuxed.h"
#include "bridge_bench.h"
#include "driver_port.h"
#include "pin_waves.h"
extern "C" {
#include "fsmc_bank.h"
#include "map_regs.h"
#include "system_regs.h"
}
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <sstream>

namespace {

constexpr uint32_t ddr = MAP_DDR_WINDOW, control = MAP_CONTROL_WINDOW;

// NE1: PSRAM, bursts both ways, FSMC_CLK = HCLK / (clkdiv + 1); NE2: mode 1, or multiplexed.
template <class Bridge>
void setUp(BridgeBench<Bridge>& b, unsigned clkdiv, unsigned latency, bool muxed,
           bool waitHigh = false) {
    b.slave.words[0] = SYSTEM_ID_VALUE;
    FSMC_Bank banks[2] = {};
    banks[0].mode = FSMC_MODE_BURST;
    banks[0].clkdiv = static_cast<U8>(clkdiv);
    banks[0].latency = static_cast<U8>(latency);
    banks[1].mode = FSMC_MODE_1;
    banks[1].psram = banks[1].wait = 1;
    banks[1].busturn = 2;
    banks[1].read = {2, 2, 4};
    banks[0].muxed = banks[1].muxed = muxed;
    banks[0].waitHigh = banks[1].waitHigh = waitHigh;
    ASSERT_EQ(FSMC_initBanks(&driverPort, &b.master, banks), FSMC_OK);
}

template <class Bridge>
void traffic(unsigned hclk, unsigned clkdiv, unsigned latency, bool muxed, double stall,
             bool waitHigh = false) {
    SCOPED_TRACE("HCLK " + std::to_string(hclk) + " MHz, CLKDIV " + std::to_string(clkdiv) +
                 ", stall " + std::to_string(stall) + ", SEED=" + std::to_string(testSeed()));
    BridgeBench<Bridge> b(testSeed(), stall, hclk, 100);
    setUp(b, clkdiv, latency, muxed, waitHigh);
    Random random(testSeed() + hclk);
    std::map<uint32_t, uint8_t> reference;
    uint32_t words[16] = {}, places[8];
    for (uint32_t& place : places)
        place = random.below(0x3FF00) << 8; // anywhere in the window
    for (int i = 0; i < 250 && !testing::Test::HasFailure(); ++i) {
        uint32_t a = places[random.below(8)] + 2 * random.below(200);
        unsigned n = 1 + random.below(random.chance(0.2) ? 80 : 8), word = 1 + random.below(15);
        switch (random.below(5)) {
        case 0:
        case 1: {
            std::vector<uint16_t> values(n);
            uint8_t lanes = static_cast<uint8_t>(random.chance(0.8) ? 3 : 1 + random.below(2));
            for (unsigned k = 0; k < n; ++k) {
                values[k] = static_cast<uint16_t>(random.next());
                if (lanes & 1)
                    reference[a + 2 * k] = static_cast<uint8_t>(values[k]);
                if (lanes & 2)
                    reference[a + 2 * k + 1] = static_cast<uint8_t>(values[k] >> 8);
            }
            b.master.writeBurst(ddr + a, values, lanes);
            break;
        }
        case 2:
            if (random.chance(0.5))
                b.master.write32(control + 4 * word, words[word] = random.next());
            else
                EXPECT_EQ(b.master.read32(control + 4 * word), words[word]);
            break;
        default: {
            std::vector<uint16_t> values = b.master.readBurst(ddr + a, n);
            for (unsigned k = 0; k < n; ++k)
                EXPECT_EQ(values[k], reference[a + 2 * k] | reference[a + 2 * k + 1] << 8)
                    << "access " << i << ", beat " << k << " of " << n;
        }
        }
    }
    EXPECT_EQ(b.errors, 0u);
    b.master.read32(control);
    for (auto& [a, v] : reference)
        ASSERT_EQ(b.memory.byte(a), v) << std::hex << a;
}

TEST(Burst, EqualsAReferenceAtEveryRatio) {
    for (double stall : {0.0, 0.3, 0.9})
        for (auto [hclk, clkdiv] :
             {std::pair(100u, 3u), {120u, 4u}, {120u, 5u}, {60u, 1u}, {97u, 3u}})
            traffic<VFsmcBridgeSync>(hclk, clkdiv, 5, false, stall);
}

TEST(Burst, MultiplexedWithTheShortestLatency) {
    for (double stall : {0.0, 0.5})
        for (auto [hclk, clkdiv] : {std::pair(100u, 3u), {120u, 4u}})
            traffic<VFsmcBridgeSyncMuxed>(hclk, clkdiv, 4, true, stall);
}

TEST(Burst, TheLongestLatencyNwaitActiveHighAndLargeBuffers) {
    for (double stall : {0.0, 0.9})
        for (auto [hclk, clkdiv] : {std::pair(100u, 3u), {120u, 5u}})
            traffic<VFsmcBridgeSyncLate>(hclk, clkdiv, 17, false, stall, true);
}

// The queue of writes fills, and NWAIT holds the burst: nothing is lost.
TEST(Burst, WritesLongerThanWhatCanWaitForASlowMemory) {
    BridgeBench<VFsmcBridgeSync> b(testSeed(), 0.97, 100, 100);
    setUp(b, 3, 5, false);
    std::vector<uint16_t> values(400);
    for (unsigned i = 0; i < values.size(); ++i)
        values[i] = static_cast<uint16_t>(0x1357 * i);
    b.master.writeBurst(ddr, values);
    EXPECT_EQ(b.master.readBurst(ddr, static_cast<unsigned>(values.size())), values)
        << "SEED=" << testSeed();
    EXPECT_EQ(b.errors, 0u);
}

TEST(Burst, TheDriverCopiesAnyLengthToAnyAddress) {
    BridgeBench<VFsmcBridgeSync> b(testSeed(), 0.3, 120, 100);
    setUp(b, 4, 5, false);
    Random random(testSeed());
    for (int i = 0; i < 40 && !testing::Test::HasFailure(); ++i) {
        uint32_t address = random.below(0x200), bytes = 1 + random.below(70);
        std::vector<uint8_t> out(bytes), in(bytes);
        for (auto& byte : out)
            byte = static_cast<uint8_t>(random.next());
        uint8_t before = b.memory.byte(address + bytes);
        FSMC_writeMemory(address, out.data(), bytes);
        FSMC_readMemory(address, in.data(), bytes);
        EXPECT_EQ(in, out) << "SEED=" << testSeed() << " copy " << i;
        EXPECT_EQ(b.memory.byte(address + bytes), before);
    }
}

TEST(Burst, AHungMemoryEndsInAnErrorAndTheBridgeGoesOn) {
    BridgeBench<VFsmcBridgeSync> b(testSeed(), 0.1, 100, 100);
    setUp(b, 3, 5, false);
    b.memory.setByte(0x40, 0x77);
    b.memory.hold(true);
    b.master.readBurst(ddr + 0x40, 2);
    EXPECT_GE(b.errors, 1u);
    EXPECT_EQ(b.errorAddr, 0x3FFu);
    b.memory.hold(false);
    for (int i = 0; i < 100; ++i)
        b.tick();
    EXPECT_EQ(b.master.readBurst(ddr + 0x40, 1)[0], 0x77);
}

// Halfwords that find no room are let go one by one, each with an error.
TEST(Burst, WritesToAHungMemoryEndInErrorsAndTheBridgeGoesOn) {
    BridgeBench<VFsmcBridgeSync> b(testSeed(), 0.1, 100, 100);
    setUp(b, 3, 5, false);
    b.memory.hold(true);
    std::vector<uint16_t> values(100);
    for (unsigned i = 0; i < values.size(); ++i)
        values[i] = static_cast<uint16_t>(0x2468 * i + 1);
    b.master.writeBurst(ddr, values);
    EXPECT_GE(b.errors, 1u);
    EXPECT_EQ(b.errorAddr, 0x3FFu);
    EXPECT_TRUE(b.errorWrite);
    b.memory.hold(false);
    b.master.read32(control); // what is still in the queue has been written
    unsigned errors = b.errors;
    auto in = b.master.readBurst(ddr, 48);
    EXPECT_EQ(in, std::vector<uint16_t>(values.begin(), values.begin() + 48))
        << "what had room before the first error";
    b.master.writeBurst(ddr, values);
    EXPECT_EQ(b.master.readBurst(ddr, 100), values);
    EXPECT_EQ(b.errors, errors);
}

// Given up before the memory's side has answered its restart, a burst must not leave its address or
// its data to the next one, whose restart then waits. FSMC_CLK is up to as fast as the clock here.
TEST(Burst, AReadBehindBurstsThatAreGivenUpGetsItsOwnData) {
    for (auto [hclk, clkdiv] : {std::pair(200u, 1u), {190u, 1u}, {120u, 1u}, {100u, 3u}}) {
        SCOPED_TRACE("HCLK " + std::to_string(hclk) + " MHz, CLKDIV " + std::to_string(clkdiv) +
                     ", SEED=" + std::to_string(testSeed()));
        BridgeBench<VFsmcBridgeSync> b(testSeed(), 0.3, hclk, 100);
        setUp(b, clkdiv, 5, false);
        Random random(testSeed() + hclk);
        std::vector<uint16_t> values(256);
        for (unsigned i = 0; i < values.size(); ++i) {
            values[i] = static_cast<uint16_t>(random.next());
            b.memory.setByte(2 * i, static_cast<uint8_t>(values[i]));
            b.memory.setByte(2 * i + 1, static_cast<uint8_t>(values[i] >> 8));
        }
        for (int i = 0; i < 150 && !HasFailure(); ++i) {
            for (unsigned bursts = 1 + random.below(3); bursts; --bursts)
                b.master.abortReadBurst(ddr + 2 * random.below(240), 1 + random.below(12));
            unsigned at = random.below(240), n = 1 + random.below(16);
            EXPECT_EQ(b.master.readBurst(ddr + 2 * at, n),
                      std::vector<uint16_t>(values.begin() + at, values.begin() + at + n))
                << "burst " << i;
        }
        EXPECT_EQ(b.errors, 0u);
    }
}

// At 25 MHz of FSMC_CLK a burst takes a clock a beat, besides its address, latency and pause.
TEST(Burst, LongBurstsReachThePinLimit) {
    BridgeBench<VFsmcBridgeSync> b(testSeed(), 0, 100, 100);
    setUp(b, 3, 5, false);
    auto share = [&](unsigned length, bool write) {
        uint64_t start = b.clocks();
        for (uint32_t at = 0; at < 4096; at += length)
            if (write)
                b.master.writeBurst(ddr + 2 * at, std::vector<uint16_t>(length, 1));
            else
                b.master.readBurst(ddr + 2 * at, length);
        return 4096 * 4.0 / static_cast<double>(b.clocks() - start);
    };
    for (unsigned length : {8u, 64u, 512u}) {
        double write = share(length, true), read = share(length, false);
        std::printf("bursts of %3u halfwords: writes %.1f %%, reads %.1f %% of 25 M/s\n", length,
                    100 * write, 100 * read);
        EXPECT_GT(write, length / (length + 9.0));
        EXPECT_GT(read, length / (length + 14.0));
    }
}

// docs/fsmc.md shows what the pins do here; UPDATE_GOLDENS=1 draws it anew.
void compareWave(const std::string& name, const std::string& wave) {
    std::string path = std::string(WAVES_DIR) + "/" + name + ".json";
    if (std::getenv("UPDATE_GOLDENS"))
        std::ofstream(path) << wave;
    std::stringstream page;
    page << std::ifstream(path).rdbuf();
    EXPECT_EQ(page.str(), wave) << path;
}

TEST(Burst, WaveformsOfThePageAreWhatThePinsDo) {
    const std::vector<uint16_t> values = {0x1001, 0x1002, 0x1003, 0x1004};
    BridgeBench<VFsmcBridgeSync> b(1, 0, 100, 100);
    setUp(b, 3, 5, false); // a cycle of FSMC_CLK is four clocks
    auto watched = [&](auto burst) {
        auto waves = std::make_unique<PinWaves>(b.pins, 2);
        b.onTick = [&] { waves->sample(); };
        b.master.idle(4);
        burst();
        b.master.idle(2);
        b.onTick = nullptr;
        return waves;
    };
    auto write = watched([&] { b.master.writeBurst(ddr, values); });
    compareWave("fsmc_burst_write",
                write->json("Four halfwords written, LATENCY 5: edges 5 to 8 take them",
                            "NWAIT high at an edge: the next takes data, from LATENCY on. FSMC_CLK "
                            "(25 MHz) stands still between bursts",
                            values));
    b.master.read32(control); // the buffers are empty
    auto read = watched([&] { EXPECT_EQ(b.master.readBurst(ddr, 4), values); });
    compareWave("fsmc_burst_read",
                read->json("Four halfwords read, LATENCY 5: NWAIT low at an edge, the next has "
                           "no data",
                           "Edge 5 could have the first halfword; NWAIT holds the burst for two "
                           "edges more, until it has come",
                           values));
}

} // namespace
