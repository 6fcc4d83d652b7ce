// SPDX-License-Identifier: MIT
//
// m3_test: tests the firmware's ARM binary on the RTL. It must fly the same mission as the host
// build, bit by bit, and handle the watchdog, faults and a corrupt image.

#include "m3_machine.h"
#include "to_all.h"
#include "uav_machine.h"
#include <algorithm>
#include <gtest/gtest.h>

extern "C" {
#include "boot.h"
#include "map_regs.h"
#include "system_regs.h"
}

namespace {

using Bytes = std::vector<uint8_t>;

// UAV_FIRMWARE is the path of another binary to test, such as one with the real uC/OS-II
// (docs/firmware.md).
M3Machine::Config firmwareAt(uint32_t hclkHz) {
    const char* other = std::getenv("UAV_FIRMWARE");
    return {other ? other : FIRMWARE_ELF, hclkHz, Ground::guardMs};
}
const M3Machine::Config firmware = firmwareAt(120'000'000);

// One flight: the air, both modems, the chip, and a ground station that makes calls from a list.
struct Flight : GroundAndChip {
    Flight() {
        air.onPacket([this](uint64_t, const RfPacket& p, RfChannel::Outcome) {
            packets.push_back({p.from, p.bytes});
        });
        soc.reset(true);
        Random random(testSeed());
        provide(48, 32, [&](uint32_t) { return static_cast<uint8_t>(random.below(2) * 200); });
    }
    Script mission(size_t pings) {
        std::vector<Ground::Call> calls(pings, {"hwengine1", "ice_ping", 2});
        calls.insert(calls.end(), {{"hwengine1", "setParameterA", 0, {30, 0}},
                                   {"hwengine1", "startProcessing"},
                                   {"hwengine1", "getResult"},
                                   {"uav", "isAlive", 0, {7, 0}},
                                   {"missing", "ice_ping", 2}});
        return ground.calling(calls);
    }
    uint32_t scratch() {
        return soc.fsmc().read32(MAP_CONTROL_WINDOW + 64 * MAP_SLOT_SYSTEM + 4 * SYSTEM_SCRATCH);
    }

    void fly(Script script, double seconds, const M3Machine::Config& config = firmware) {
        m3 = std::make_unique<M3Machine>(soc, config,
                                         [=]() mutable { return !script() && within(seconds); });
        m3->run();
    }
    uint32_t place(const char* symbol) { return m3->stm32().image()->symbol(symbol); }
    uint32_t variable(const char* name) { return m3->cpu().word(place(name)); }

    struct Packet {
        int from;
        Bytes bytes;
    };
    std::vector<Packet> packets;
    std::unique_ptr<M3Machine> m3;
};

Boot_Reason reasonOf(uint32_t report) {
    return static_cast<Boot_Reason>(report >> 8 & 0xFF);
}

size_t differingBytes(const Bytes& a, const Bytes& b) {
    size_t n = 0;
    for (size_t i = 0; i < a.size() && i < b.size(); ++i)
        n += a[i] != b[i];
    return n;
}

// The reply to getResult contains the number of clock cycles that the core has counted. This number
// depends on the other accesses to the memory at that time. Between the builds, only the four bytes
// of this number and two checksums may differ: the checksum of the packet with these bytes, and the
// checksum of the packet that ends the message.
constexpr size_t cyclesAt = 29, cyclesBytes = 4, checksumBytes = 2;
constexpr int packetsThatMayDiffer = 2;

TEST(CortexM3Firmware, SendsTheSameBytesAsTheHostBuild) {
    Flight host, m3;
    EXPECT_TRUE(flies(host.soc, host.mission(2), 30));
    m3.fly(m3.mission(2), 30);
    ASSERT_EQ(host.ground.replies.size(), 7u);
    EXPECT_EQ(host.ground.replies[7], 2); // no object has this name
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
    EXPECT_LE(differing, packetsThatMayDiffer);
    EXPECT_EQ(reasonOf(m3.scratch()), BOOT_POWER_ON);
}

TEST(CortexM3Firmware, LosesNothingInBadConditionsAtTheClockRatioOfTheBoard) {
    Flight f;
    f.air.weather.loss = f.air.weather.duplication = 0.1;
    f.air.weather.corruption = 0.03;
    f.fly(f.mission(22), 90, firmwareAt(0));
    EXPECT_EQ(f.ground.replies.size(), 27u);
    for (auto& [id, status] : f.ground.replies)
        // the last call is to an object that does not exist
        EXPECT_EQ(status, id < 27 ? 0 : 2) << id;
    EXPECT_GT(f.air.counters().lost, 0u);
}

TEST(CortexM3Firmware, ExecutesABroadcastOnce) {
    M3Machine::Config config = firmware;
    config.key = ToAll::Key(LINK_KEY_BYTES, 0x11);
    ToAll w(config.key);
    config.peers = {{UAV_GROUP, UAV_EVERYBODY, w.groups}};
    M3Machine machine(
        w.soc, config,
        w.flight({w.calls({w.high}), w.send(w.groups, 10, w.low), w.send(w.groups, 11, w.start),
                  w.calls({w.result}, true), w.calls({w.high}), w.send(w.sent),
                  w.send(w.open, 12, w.low),
                  w.calls({w.start, w.result}, false, "recorded, and in the clear")}));
    machine.run();
    EXPECT_TRUE(w.isDone);
}

// Tests several faults in one flight: a core that hangs, a processor that hangs, an FSMC that is
// switched off, and a stack overflow. Each fault must be reported in the system slot, and the link
// must recover by itself.
TEST(CortexM3Firmware, FaultsAreReportedAndTheLinkRecovers) {
    Flight f;
    uint64_t since = 0;
    auto hasPassed = [&] { return f.soc.cycles() >= since + SocModel::clkHz / 100; };
    auto reported = [&] {
        try {
            return reasonOf(f.scratch());
        } catch (const FsmcError&) {
            // the firmware has not switched the FSMC on yet, so nothing can be read
            return Boot_Reason();
        }
    };
    // the read of an address without a slot causes an event and an interrupt; then the flight
    // continues
    auto readNobodysRegister = [&] {
        EXPECT_EQ(f.variable("busErrors"), 0u);
        (void)f.soc.fsmc().read32(MAP_CONTROL_WINDOW + 64 * 33 + 4 * 5);
        since = f.soc.cycles();
        return true;
    };
    auto hangProcessor = [&] {
        EXPECT_EQ(f.variable("busErrors"), 1u);
        EXPECT_EQ(f.variable("busErrorPlace"), 33u * 16 + 5);
        // sends a call, and disables interrupts before the call is answered
        f.ground.ping(100, "hwengine1");
        f.m3->cpu().setReg(CortexM3::Faultmask, 1); // disables interrupts
        return true;
    };
    // waits until the watchdog has reset the processor and the link is up again
    auto groundIsTold = [&] {
        if (f.m3->stm32().resets().watchdog == 0 || f.ground.unknown == 0 || !f.ground.isUp())
            return false;
        EXPECT_EQ(f.ground.replies.count(100), 0u);
        EXPECT_EQ(reported(), BOOT_WATCHDOG);
        EXPECT_NE(f.m3->watchdogReport().find(" s; the firmware is in "), std::string::npos)
            << f.m3->watchdogReport();
        f.ground.replies.clear();
        return true;
    };
    auto switchNe2Off = [&] { // makes the next access to a register fail
        f.soc.fsmc().write32(0xA0000008, 0x000030D2);
        return true;
    };
    auto busFaultIsTold = [&] {
        if (f.m3->stm32().resets().software == 0 || reported() != BOOT_BUS_FAULT)
            return false;
        EXPECT_EQ(f.m3->cpu().word(f.place("boot_record") + 20) & 0xFF000000, MAP_CONTROL_WINDOW);
        since = f.soc.cycles();
        return true;
    };
    auto overflowIdleStack = [&] {
        if (!hasPassed() || f.m3->cpu().currentException() != 0)
            return false;
        bool own = f.m3->stm32().image()->has("idleStack");
        f.m3->cpu().setReg(CortexM3::Psp, f.place(own ? "idleStack" : "OSTaskIdleStk") + 56);
        return true;
    };
    f.fly(inOrder({f.ground.pinging(2), readNobodysRegister, hasPassed, hangProcessor, groundIsTold,
                   f.ground.pinging(2), switchNe2Off, busFaultIsTold, overflowIdleStack,
                   [&] { return reported() == BOOT_STACK_OVERFLOW; }}),
          60);
    EXPECT_EQ(reported(), BOOT_STACK_OVERFLOW);
    EXPECT_EQ(f.scratch() & 0xFF, 63u) << "the report must contain the priority of the idle task";
    EXPECT_EQ(f.scratch() >> 16 & 0xFF, 4u)
        << "the report must contain the number of starts since power-on";
}

// The memory does not answer, so accesses end by the time-out of the bridge. Each of them is a bus
// error with its address, and does not cause a reset. When the memory answers again, the flight
// continues.
TEST(CortexM3Firmware, AHungMemoryIsReportedAndTheFlightContinues) {
    Flight f;
    uint64_t since = 0;
    auto hang = [&] {
        EXPECT_EQ(f.variable("busErrors"), 0u);
        f.soc.memory().hang(true);
        // the firmware must read the packet of this call from the memory
        f.ground.ping(100, "hwengine1");
        (void)f.soc.fsmc().read16(MAP_DDR_WINDOW);
        since = f.soc.cycles();
        return true;
    };
    auto goOn = [&] {
        EXPECT_GE(f.variable("busErrors"), 1u);
        EXPECT_EQ(f.variable("busErrorPlace") & 0x3FF, 0x3FFu) << "memory";
        f.soc.memory().hang(false);
        return true;
    };
    auto ping = [&] {
        if (f.ground.validated)
            f.ground.ping(3, "uav");
        return f.ground.validated;
    };
    f.fly(inOrder({f.ground.pinging(2), hang,
                   [&] { return f.soc.cycles() >= since + SocModel::clkHz / 10; }, goOn,
                   [&] { return f.ground.replies.count(100) != 0 || !f.ground.isUp(); }, ping,
                   [&] { return f.ground.replies.count(3) != 0; }}),
          60);
    EXPECT_EQ(f.ground.replies.count(100), 1u) << "the call in progress must be answered";
    EXPECT_EQ(f.ground.replies.count(3), 1u) << "the next call must be answered";
    EXPECT_EQ(f.m3->stm32().resets().watchdog + f.m3->stm32().resets().software, 0u);
    EXPECT_EQ(reasonOf(f.scratch()), BOOT_POWER_ON);
}

TEST(CortexM3Firmware, ACorruptImageIsRefusedWithItsReason) {
    Random random(testSeed());
    for (int i = 0; i < 4; ++i) {
        Flight f;
        M3Machine machine(f.soc, firmware, [&] { return f.within(0.3); });
        const ElfImage& image = *machine.stm32().image();
        // Flips one bit of the image, after the code that reports errors. Start-up code, boot code
        // and FSMC driver are before this bit.
        uint32_t begin = image.symbol("telling_end"), end = image.symbol("image_end");
        uint32_t at = begin + random.below(end - begin);
        uint8_t byte = 0;
        machine.cpu().readMemory(at, &byte, 1);
        byte = static_cast<uint8_t>(byte ^ 1u << random.below(8));
        machine.cpu().writeMemory(at, &byte, 1);
        machine.run();
        EXPECT_EQ(reasonOf(f.scratch()), BOOT_IMAGE_CORRUPT)
            << "flipped a bit at 0x" << std::hex << at;
        EXPECT_EQ(f.soc.modem().parameter("BD"), 3u) << "the firmware must not start";
    }
}

TEST(CortexM3Firmware, AnAbortPrintsTheStateOfChipAndProgram) {
    Flight f;
    M3Machine machine(f.soc, firmware, [&] { return f.within(0.01); });
    machine.run();
    EXPECT_DEATH(std::abort(), "The chip stands at clock [0-9]{6,}, interrupt [01], ");
    EXPECT_DEATH(std::abort(), "The program is in OSTaskIdleHook");
    EXPECT_DEATH(std::abort(), "The model that ran last stands at clock [0-9]{6,}");
}

TEST(CortexM3Firmware, WithoutAKeyItRetriesToStart) {
    Flight f;
    M3Machine machine(f.soc, firmware, [&] { return f.within(2.2); });
    machine.stm32().backup().fill(0); // clears the memory, as an empty battery would
    machine.run();
    EXPECT_EQ(reasonOf(f.scratch()), BOOT_NO_KEY);
    EXPECT_GE(machine.stm32().resets().watchdog, 1u);
    EXPECT_EQ(f.soc.modem().parameter("BD"), 3u) << "the firmware must not start";
}

} // namespace
