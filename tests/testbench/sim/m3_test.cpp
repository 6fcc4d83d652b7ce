// SPDX-License-Identifier: MIT
//
// m3_test: the firmware's ARM binary on the RTL: the same mission as the host build's, bit by bit, and
// what ends it: watchdog, faults, a corrupt image.

#include "ground.h"
#include "m3_machine.h"
#include "uav_machine.h"
#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

extern "C" {
#include "boot.h"
#include "map_regs.h"
#include "system_regs.h"
#include "uav.h"
}

namespace {

using Bytes = std::vector<uint8_t>;

// One flight: the air, both modems, the chip, and a ground station that works through a list of calls.
struct Flight {
    explicit Flight(double loss = 0) {
        air.weather.loss = loss;
        air.onPacket([this](uint64_t, const RfPacket& p, RfChannel::Outcome) { packets.push_back({p.from, p.bytes}); });
        soc.onTime([this](uint64_t now) { return ground.advance(now); });
        soc.reset();
        Random random(testSeed());
        const uint32_t size[2] = {48, 32};
        std::memcpy(soc.memory().data() + UAV_FRAME_HEADER, size, sizeof size);
        for (int i = 0; i < 48 * 32; ++i)
            soc.memory().data()[UAV_FRAME + i] = static_cast<uint8_t>(random.below(2) * 200);
    }
    // Next call, when the one before is answered; false when all are.
    bool step() {
        if (!opened && ground.isUp()) {
            ground.open();
            opened = true;
        }
        if (!ground.validated || static_cast<int>(ground.replies.size()) < sent)
            return true;
        if (sent == static_cast<int>(calls.size()))
            return false;
        ++sent;
        calls[static_cast<size_t>(sent - 1)](sent);
        return true;
    }
    bool inTime(double seconds) const { return static_cast<double>(soc.now()) < seconds * 1e9; }
    // From then on as after a restart of the ground's program.
    void forget() {
        ground.replies.clear();
        opened = false;
        sent = 0;
    }
    void pings(int count) {
        for (int i = 0; i < count; ++i)
            calls.push_back([this](int id) { ground.ping(id, "hwengine1"); });
    }
    void mission() {
        pings(2);
        calls.push_back([this](int id) { ground.call(id, "hwengine1", "setParameterA", 0, {30, 0}); });
        calls.push_back([this](int id) { ground.call(id, "hwengine1", "startProcessing"); });
        calls.push_back([this](int id) { ground.call(id, "hwengine1", "getResult"); });
        calls.push_back([this](int id) { ground.call(id, "uav", "isAlive", 0, {7, 0}); });
        calls.push_back([this](int id) { ground.ping(id, "nobody"); });
    }
    uint32_t scratch() {
        return soc.fsmc().read32(0x64000000 + 64 * MAP_SLOT_SYSTEM + 4 * SYSTEM_SCRATCH);
    }

    struct Packet {
        int from;
        Bytes bytes;
    };
    RfChannel air{testSeed()};
    Ground ground{air, testSeed() + 5};
    SocModel soc{air, {}};
    std::vector<std::function<void(int id)>> calls;
    std::vector<Packet> packets;
    bool opened = false;
    int sent = 0;
};

// UAV_FIRMWARE names another build, of the real uC/OS-II (docs/ucos2.md).
M3Machine::Config firmwareAt(uint32_t hclkHz) {
    const char* other = std::getenv("UAV_FIRMWARE");
    return {other ? other : FIRMWARE_ELF, hclkHz};
}
const M3Machine::Config firmware = firmwareAt(120'000'000);

Boot_Reason reasonOf(uint32_t report) { return static_cast<Boot_Reason>(report >> 8 & 0xFF); }

size_t differingBytes(const Bytes& a, const Bytes& b) {
    size_t n = 0;
    for (size_t i = 0; i < a.size() && i < b.size(); ++i)
        n += a[i] != b[i];
    return n;
}

// The clock cycles that the core measured of itself depend on who else uses the memory just then: four
// bytes of getResult's reply, the only ones that may differ between the builds.
constexpr size_t cyclesAt = 29, cyclesBytes = 4, checksumBytes = 2;

TEST(CortexM3Firmware, FliesTheMissionAsTheHostBuildDoesByteByByteOnTheAir) {
    Flight host, m3;
    host.mission();
    m3.mission();
    UavMachine onHost(host.soc, [&] { return host.step() && host.inTime(30); });
    onHost.run();
    M3Machine onM3(m3.soc, firmware, [&] { return m3.step() && m3.inTime(30); });
    onM3.run();
    ASSERT_EQ(host.ground.replies.size(), 7u);
    EXPECT_EQ(host.ground.replies[7], 2); // there is nobody of that name
    for (auto* flight : {&host, &m3})
        std::fill_n(flight->ground.messages[5].begin() + cyclesAt, cyclesBytes, 0);
    EXPECT_GT(host.ground.messages[5].size(), 60u) << "no corners were found";
    EXPECT_TRUE(m3.ground.messages == host.ground.messages);
    ASSERT_EQ(m3.packets.size(), host.packets.size());
    int differing = 0;
    for (size_t i = 0; i < host.packets.size(); ++i) {
        const Bytes &a = host.packets[i].bytes, &b = m3.packets[i].bytes;
        ASSERT_EQ(a.size(), b.size()) << "packet " << i;
        EXPECT_EQ(host.packets[i].from, m3.packets[i].from) << "packet " << i;
        EXPECT_LE(differingBytes(a, b), cyclesBytes + checksumBytes) << "packet " << i;
        differing += a != b;
    }
    EXPECT_LE(differing, 1);
    EXPECT_EQ(reasonOf(m3.scratch()), BOOT_POWER_ON);
}

TEST(CortexM3Firmware, LosesNothingAtTenPercentLossAndAtTheBoardsCycleRatio) {
    Flight f(0.1);
    f.pings(20);
    f.mission();
    M3Machine machine(f.soc, firmwareAt(0), [&] { return f.step() && f.inTime(90); });
    machine.run();
    EXPECT_EQ(f.ground.replies.size(), 27u);
    EXPECT_GT(f.air.counters().lost, 0u);
}

TEST(CortexM3Firmware, TheSameSeedGivesTheSameRunToTheInstruction) {
    uint64_t instructions[2], cycles[2];
    for (int run = 0; run < 2; ++run) {
        Flight f; // the modem's set-up: the tick, the driver, its interrupts
        M3Machine machine(f.soc, firmware, [&] { return f.inTime(4); });
        machine.run();
        instructions[run] = machine.cpu().instructions();
        cycles[run] = f.soc.cycles();
    }
    EXPECT_EQ(instructions[0], instructions[1]);
    EXPECT_EQ(cycles[0], cycles[1]);
}

} // namespace
