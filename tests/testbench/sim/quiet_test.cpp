// SPDX-License-Identifier: MIT
//
// quiet_test: a flight in which quiet clocks pass at once and idle cores have no clock is, clock by
// clock, the one in which each is evaluated and each core clocked. COMPARE_MS=1000 compares a
// second of it.

#include "VSoc___024root.h"
#include "ground.h"
#include "soc_state.h"
#include "uav_machine.h"
#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

struct Event {
    uint64_t clock;
    uint32_t what, value;
    bool operator==(const Event& o) const {
        return clock == o.clock && what == o.what && value == o.value;
    }
};

struct Flight {
    std::vector<Event> events;
    std::vector<unsigned char> memory;
    SocState::Image chip;
    uint64_t clocks = 0, evaluated = 0;
    size_t replies = 0;
};

// Returns how much of the flight is compared (ns), from reset on and from the first call on.
uint64_t comparedNs() {
    const char* text = std::getenv("COMPARE_MS");
    return static_cast<uint64_t>(1e6 * (text ? std::atof(text) : 40));
}

// Flies until the first call is answered, and a little longer.
Flight fly(bool evaluateAll) {
    Flight f;
    if (evaluateAll)
        setenv("UNGATED", "1", 1);
    RfChannel air(testSeed());
    Ground ground(air, testSeed() + 5);
    SocModel soc(air, Ground::uavModem());
    uav_guardMs = Ground::guardMs;
    auto note = [&](uint32_t what, uint32_t value) {
        f.events.push_back({soc.cycles(), what, value});
    };
    soc.onTime([&](uint64_t now) {
        note(2, 0); // the modems and the air have something to do
        return ground.advance(now);
    });
    soc.onIrq([&](bool high) { note(0, high); });
    soc.fsmc().onWord = [&](uint32_t address, uint32_t value, bool isWrite) {
        note(address | isWrite, value);
    };
    air.onPacket([&](uint64_t, const RfPacket& packet, RfChannel::Outcome outcome) {
        note(1, static_cast<uint32_t>(packet.bytes.size() << 8) | static_cast<uint32_t>(outcome));
    });
    unsetenv("UNGATED");
    soc.reset(true);
    soc.evaluateAll(evaluateAll);
    int sent = 0;
    uint64_t called = 0;
    UavMachine machine(soc, [&] {
        if (ground.validated && !called) {
            called = soc.now();
            f.clocks -= soc.cycles();
            f.evaluated -= soc.evaluated();
            soc.evaluateAll(evaluateAll);
        } else if (!called && soc.now() > comparedNs() / 10) {
            soc.evaluateAll(false);
        }
        if (called && static_cast<int>(ground.replies.size()) == sent)
            ground.ping(++sent, "hwengine1");
        return (!called || soc.now() < called + comparedNs()) && soc.now() < 20'000'000'000;
    });
    machine.run();
    f.chip = SocState::of(*soc.chip().rootp);
    f.memory.assign(soc.memory().data(), soc.memory().data() + soc.memory().size());
    f.clocks += soc.cycles();
    f.evaluated += soc.evaluated();
    f.replies = ground.replies.size();
    return f;
}

TEST(Quiet, AFlightIsTheSameWithQuietClocksPassedAtOnce) {
    Flight quick = fly(false), slow = fly(true);
    EXPECT_EQ(quick.clocks, slow.clocks);
    EXPECT_EQ(quick.replies, slow.replies);
    ASSERT_EQ(quick.events.size(), slow.events.size());
    for (size_t i = 0; i < quick.events.size(); ++i)
        ASSERT_TRUE(quick.events[i] == slow.events[i])
            << "event " << i << " in clock " << quick.events[i].clock << ", not "
            << slow.events[i].clock;
    EXPECT_TRUE(quick.memory == slow.memory);
    for (const std::string& path : SocState::differences(quick.chip, slow.chip))
        EXPECT_THAT(path,
                    testing::AnyOf(testing::EndsWith(".ungated"), testing::EndsWith(".open")));
    EXPECT_GT(quick.replies, 0u);
    EXPECT_GT(quick.events.size(), 100u);
    EXPECT_EQ(slow.evaluated, slow.clocks);
    EXPECT_LT(quick.evaluated * 2, quick.clocks);
    std::printf("%.1f million clocks, %.2f million evaluated, %zu events, %zu replies\n",
                static_cast<double>(quick.clocks) / 1e6, static_cast<double>(quick.evaluated) / 1e6,
                quick.events.size(), quick.replies);
}

// Random values that an index beyond its range reads, and the scratch of such a write.
TEST(Quiet, VerilatorsScratchIsNoStateOfTheChip) {
    SocState::Image zeros(sizeof(VSoc___024root), 0), ones(sizeof(VSoc___024root), 255);
    auto paths = SocState::differences(zeros, ones);
    EXPECT_GT(paths.size(), 500u);
    EXPECT_THAT(paths, testing::Not(testing::Contains(testing::AnyOf(
                           testing::HasSubstr("__Vxrand"), testing::HasSubstr("__Vlvbound")))));
}

TEST(Quiet, TheChipIsTheSameInWhateverClockItIsLookedAt) {
    RfChannel air(testSeed());
    SocModel quick(air, Ground::uavModem()), slow(air, Ground::uavModem());
    slow.evaluateAll(true);
    quick.reset(true);
    slow.reset(true);
    Random random(testSeed());
    for (uint64_t look = 0; quick.cycles() < 1000000;) {
        for (look += 100 + random.below(400); quick.cycles() < look;)
            if (!quick.passQuiet(look))
                quick.tick();
        while (slow.cycles() < quick.cycles())
            slow.tick();
        EXPECT_THAT(SocState::differences(SocState::of(*quick.chip().rootp),
                                          SocState::of(*slow.chip().rootp)),
                    testing::IsEmpty())
            << "in clock " << quick.cycles();
    }
    EXPECT_LT(quick.evaluated() * 2, quick.cycles());
}

// Returns whether the memory is ready this many clocks after its start.
bool isMemoryReady(uint64_t clocks) {
    RfChannel air(testSeed());
    SocModel soc(air, Ground::uavModem());
    soc.reset(true);
    while (soc.cycles() < clocks)
        soc.tick();
    return soc.memory().pins.calibDone;
}

TEST(Quiet, TheMemoryIsReadyInItsClock) {
    EXPECT_FALSE(isMemoryReady(McbModel::startClocks - 1));
    EXPECT_TRUE(isMemoryReady(McbModel::startClocks));
}

} // namespace
