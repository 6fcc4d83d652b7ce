// SPDX-License-Identifier: MIT
//
// quiet_test: compares two flights clock by clock. In the quick flight, quiet clocks are skipped,
// and idle cores have no clock. In the slow flight, each clock is evaluated, and each core has its
// clock. COMPARE_MS=1000 compares one second of the flight. In a second pair of flights every core
// works, and the camera pins change.

#include "../../support/environment.h"
#include "VSoc___024root.h"
#include "core_pins.h"
#include "driver_port.h"
#include "ground.h"
#include "map_regs.h"
#ifdef MAP_SLOT_CAMERA
#include "camera_regs.h"
#endif
#include "modem_regs.h"
#include "quiet_span.h"
#include "uav_machine.h"
#include <cstring>
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
    std::map<int, int> replies; // their statuses
};

// The plan of a flight. The slow flight evaluates each clock in two periods: at the start of the
// flight, and later for `compareNs`. The later period begins with reply number `comparedFrom`; 0
// means that it begins with the first call.
struct Plan {
    // calls that are repeated; each call begins after the reply to the previous one
    std::vector<Ground::Call> calls;
    uint64_t compareNs = 0;
    size_t comparedFrom = 0;
    // number of replies after which the camera's sensor sends a frame; 0 means that it sends none
    // at all
    size_t framedAfter = 0;
};

// Returns how much of a flight is compared, ns.
uint64_t comparedNs() {
    return static_cast<uint64_t>(1e6 * numberFromEnvironment("COMPARE_MS", 40));
}

// Makes the camera's sensor send frames: about one per millisecond in the first 4 ms, later a
// single one when `framedAfter` calls have been answered.
void sendFrames(GroundAndChip& world, size_t framedAfter, std::function<void(uint32_t)> note) {
    Frame frame{16, 8, {}};
    for (int i = 0; i < 16 * 8; ++i)
        frame.pixels.push_back(static_cast<uint8_t>(i * i * 37));
    auto sends = [&world, framedAfter, framed = false, next = uint64_t{0}]() mutable {
        const uint64_t now = world.soc.now();
        const bool waits = world.ground.replies.size() == framedAfter && !framed;
        const bool first = now < 4'000'000 && now >= next;
        framed |= waits;
        next = first ? now + 900'000 : next;
        return waits || first;
    };
    connectSensor(world.soc, frame, sends, std::move(note));
}

// Flies until all calls have been answered and the compared time has elapsed.
Flight fly(const Plan& plan, bool slow) {
    Flight f;
    GroundAndChip world;
    auto& [air, ground, soc] = world;
    if (slow)
        soc.ungate();
    auto note = [&](uint32_t what, uint32_t value) {
        f.events.push_back({soc.cycles(), what, value});
    };
    soc.onTime([&](uint64_t now) {
        note(2, 0); // a call that makes modems and air active
        return ground.advance(now);
    });
    soc.onIrq([&](bool high) { note(0, high); });
    soc.fsmc().onWord = [&](uint32_t address, uint32_t value, bool isWrite) {
        note(address | isWrite, value);
    };
    air.onPacket([&](uint64_t, const RfPacket& packet, RfChannel::Outcome outcome) {
        note(1, static_cast<uint32_t>(packet.bytes.size() << 8) | static_cast<uint32_t>(outcome));
    });
    world.provide(16, 16, [](uint32_t i) { return static_cast<uint8_t>(i * i * 37); });
    if (plan.framedAfter)
        sendFrames(world, plan.framedAfter, [&](uint32_t pins) { note(3, pins); });
    soc.reset(true);
    soc.evaluateAll(slow);
    size_t sent = 0;
    uint64_t compared = 0; // since when
    UavMachine machine(soc, [&] {
        if (ground.validated && !compared && ground.replies.size() >= plan.comparedFrom) {
            soc.evaluateAll(slow); // first evaluates clocks that are not finished
            compared = soc.now();
            f.clocks -= soc.cycles();
            f.evaluated -= soc.evaluated();
        } else if (compared ? soc.now() > compared + plan.compareNs
                            : soc.now() > comparedNs() / 10) {
            soc.evaluateAll(false);
        }
        if (ground.validated && ground.replies.size() == sent) {
            const Ground::Call& call = plan.calls[sent++ % plan.calls.size()];
            ground.call(static_cast<int>(sent), call.object, call.operation, call.mode,
                        call.parameters);
        }
        return soc.now() < 20'000'000'000 && (!compared || soc.now() < compared + plan.compareNs ||
                                              ground.replies.size() < plan.calls.size());
    });
    machine.run();
    f.chip = SocState::of(*soc.chip().rootp);
    f.memory.assign(soc.memory().data(), soc.memory().data() + soc.memory().size());
    f.clocks += soc.cycles();
    f.evaluated += soc.evaluated();
    f.replies = ground.replies;
    return f;
}

// Flies the quick flight and the slow flight, and compares them. Returns both.
std::pair<Flight, Flight> expectSame(const Plan& plan) {
    Flight quick = fly(plan, false), slow = fly(plan, true);
    EXPECT_EQ(quick.clocks, slow.clocks);
    EXPECT_EQ(quick.replies, slow.replies);
    EXPECT_EQ(quick.events.size(), slow.events.size());
    for (size_t i = 0; i < std::min(quick.events.size(), slow.events.size()); ++i)
        if (!(quick.events[i] == slow.events[i])) {
            ADD_FAILURE() << "event " << i << " in clock " << quick.events[i].clock << ", not "
                          << slow.events[i].clock;
            break;
        }
    EXPECT_TRUE(quick.memory == slow.memory);
    for (const std::string& path : SocState::differences(quick.chip, slow.chip))
        EXPECT_THAT(path,
                    testing::AnyOf(testing::EndsWith(".ungated"), testing::EndsWith(".open")));
    EXPECT_GE(quick.replies.size(), plan.calls.size());
    for (const auto& [id, status] : quick.replies)
        EXPECT_EQ(status, 0) << "call " << id;
    std::printf("%.1f million clocks, %.2f million evaluated, %zu events, %zu replies\n",
                static_cast<double>(quick.clocks) / 1e6, static_cast<double>(quick.evaluated) / 1e6,
                quick.events.size(), quick.replies.size());
    return {std::move(quick), std::move(slow)};
}

TEST(Quiet, SkippingQuietClocksDoesNotChangeAFlight) {
    auto [quick, slow] = expectSame({{{"hwengine1", "ice_ping", 2, {}}}, comparedNs(), 0, 0});
    EXPECT_GT(quick.events.size(), 100u);
    EXPECT_EQ(slow.evaluated, slow.clocks);
    EXPECT_LT(quick.evaluated * 2, quick.clocks);
}

#if defined(MAP_SLOT_FIR) && defined(MAP_SLOT_ASCON)
// A core that reports that it is idle although it is not would stop only in the quick flight.
TEST(Quiet, StoppingTheClockOfACoreDoesNotChangeItsResults) {
    std::vector<uint8_t> samples = {24}, key = {16}, message = {40};
    for (uint8_t i = 0; i < 48; ++i)
        samples.push_back(static_cast<uint8_t>(i * 5));
    key.resize(17, 7);
    message.resize(41, 9);
    expectSame({{{"hwengine1", "startProcessing", 0, {}},
                 {"hwengine1", "getResult", 0, {}},
                 {"camera", "capture", 2, {16, 0, 8, 0}},
                 {"hwengine1", "startProcessing", 0, {}},
                 {"fir", "setCoefficient", 2, {0, 0, 0, 1, 0}},
                 {"hwengine1", "getResult", 0, {}},
                 {"fir", "filter", 0, samples},
                 {"ascon", "setKey", 2, key},
                 {"ascon", "hash", 2, message}},
                comparedNs() / 40,
                3,
                5});
}
#endif

// If an index is out of range, Verilator reads a random value, or writes to a scratch variable.
TEST(Quiet, ScratchVariablesOfVerilatorAreNoState) {
    SocState::Image zeros(sizeof(VSoc___024root), 0), ones(sizeof(VSoc___024root), 255);
    auto paths = SocState::differences(zeros, ones);
    EXPECT_GT(paths.size(), 500u);
    EXPECT_THAT(paths, testing::Not(testing::Contains(testing::AnyOf(
                           testing::HasSubstr("__Vxrand"), testing::HasSubstr("__Vlvbound")))));
}

void passUntil(SocModel& soc, uint64_t clock) {
    while (soc.cycles() < clock)
        soc.tick();
}

// Calls of the models outside the chip need no evaluation of the chip if its pins do not change.
TEST(Quiet, CallsOfModelsDoNotWakeTheChip) {
    RfChannel air(testSeed());
    SocModel soc(air, Ground::uavModem());
    uint64_t calls = 0;
    soc.onTime([&calls](uint64_t now) {
        ++calls;
        return now + 10'000;
    });
    soc.reset();
    passUntil(soc, 20'000'000); // until the modem controller waits
    calls = 0;
    const uint64_t before = soc.evaluated();
    passUntil(soc, soc.cycles() + 1'000'000);
    EXPECT_GE(calls, 1'000'000 * SocModel::clkNs / 10'000);
    EXPECT_LT(soc.evaluated() - before, calls);
    std::printf("%lu clocks evaluated, %lu calls\n", soc.evaluated() - before, calls);
}

// The first tick of the baud rate after an access is evaluated, and changes only counters and
// Verilator's scratch. The scratch is no state of the chip, so the chip is then quiet.
TEST(Quiet, ATickDoesNotWakeTheChip) {
    RfChannel air(testSeed());
    SocModel soc(air, Ground::uavModem());
    soc.reset();
    passUntil(soc, 20'000'000); // until the modem controller waits
    const uint64_t before = soc.evaluated();
    constexpr unsigned accesses = 100;
    for (unsigned access = 0; access < accesses; ++access) {
        (void)soc.memory(); // wakes the chip, as each access does
        passUntil(soc, soc.cycles() + 10'000);
    }
    EXPECT_LT(soc.evaluated() - before, 20 * accesses);
    std::printf("%lu clocks evaluated\n", soc.evaluated() - before);
}

void expectSameState(SocModel& quick, SocModel& slow) {
    EXPECT_THAT(
        SocState::differences(SocState::of(*quick.chip().rootp), SocState::of(*slow.chip().rootp)),
        testing::IsEmpty())
        << "in clock " << quick.cycles();
}

TEST(Quiet, ObservingTheChipDoesNotChangeIt) {
    RfChannel air(testSeed());
    SocModel quick(air, Ground::uavModem()), slow(air, Ground::uavModem());
    slow.evaluateAll(true);
    for (SocModel* soc : {&quick, &slow})
        soc->onClock([soc, next = uint64_t{0}]() mutable {
            EXPECT_EQ(soc->cycles(), next); // as requested
            return next += 77'777;
        });
    quick.reset(true);
    slow.reset(true);
    Random random(testSeed());
    for (uint64_t look = 0; quick.cycles() < 1000000;) {
        for (look += 100 + random.below(400); quick.cycles() < look;)
            if (!quick.passQuiet(look))
                quick.tick();
        passUntil(slow, quick.cycles());
        expectSameState(quick, slow);
    }
    EXPECT_LT(quick.evaluated() * 2, quick.cycles());
}

// Starts the memory in a chip that was quiet. Returns true if the memory is ready after this number
// of clocks.
bool isMemoryReady(uint64_t clocks) {
    RfChannel air(testSeed());
    SocModel soc(air, Ground::uavModem());
    soc.reset();
    passUntil(soc, 20'000);
    const uint64_t ready = soc.cycles() + clocks;
    soc.reset(true);
    passUntil(soc, ready);
    return soc.memory().pins.calibDone;
}

TEST(Quiet, TheMemoryIsReadyInTheRightClock) {
    EXPECT_FALSE(isMemoryReady(McbModel::startClocks - 1));
    EXPECT_TRUE(isMemoryReady(McbModel::startClocks));
}

// Two chips with the same input; in one of them each clock is evaluated.
struct TwoChips {
    TwoChips() {
        slow.evaluateAll(true);
        for (SocModel* soc : {&quick, &slow}) {
            soc->reset(true);
            EXPECT_EQ(FSMC_init(&driverPort, &soc->fsmc()), FSMC_OK);
        }
    }
    // Writes a 64-bit word to the memory and begins the next word, so that the bridge sends the
    // first one.
    static void write(SocModel& soc) {
        for (uint32_t word = 0; word < 2; ++word)
            soc.fsmc().write16(fsmc::windowsAt + 8 * word, 1);
    }

    RfChannel air{testSeed()};
    SocModel quick{air, Ground::uavModem()}, slow{air, Ground::uavModem()};
};

// A platform that waits until the memory is ready does not change, and must continue as soon as the
// memory is ready.
TEST(Quiet, RequestsThatWaitForTheMemoryStartWhenItIsReady) {
    TwoChips pair;
    for (SocModel* soc : {&pair.quick, &pair.slow}) {
        TwoChips::write(*soc);
        passUntil(*soc, McbModel::startClocks);
    }
    for (unsigned clock = 0; clock < 200; ++clock) {
        pair.quick.tick();
        pair.slow.tick();
        expectSameState(pair.quick, pair.slow);
    }
    EXPECT_EQ(pair.quick.memory().wordsWritten, 1u);
}

TEST(Quiet, AHungMemoryContinuesInTheRightClock) {
    TwoChips pair;
    auto written = [](SocModel& soc) {
        passUntil(soc, 2 * McbModel::startClocks);
        soc.memory().hang(true);
        TwoChips::write(soc);
        passUntil(soc, 3 * McbModel::startClocks);
        soc.memory().hang(false);
        while (!soc.memory().wordsWritten && soc.cycles() < 4 * McbModel::startClocks)
            soc.tick();
        return soc.cycles();
    };
    EXPECT_EQ(written(pair.quick), written(pair.slow));
    EXPECT_EQ(pair.quick.memory().wordsWritten, 1u);
}

#ifdef MAP_SLOT_CAMERA
// A camera that is evaluated alone is looked at in random clocks: during pixels, bursts to the
// memory and ticks of the baud rate, at the end of frames, and while the memory hangs, so that
// pixels are lost.
TEST(Quiet, ACameraAloneWorksAsInTheChip) {
    // All chips of a process draw the delays of their synchronisers from one sequence of random
    // numbers, so two chips with a running pixel clock get different delays. A chip with such
    // delays never evaluates its camera alone.
    if (numberFromEnvironment("CDC_SEED", 0))
        GTEST_SKIP() << "with CDC_SEED, the synchronisers of the two chips have different delays";
    TwoChips pair;
    EXPECT_THAT(pair.quick.camera().missing(), testing::IsEmpty());
    Frame frame{64, 24, {}};
    for (int i = 0; i < 64 * 24; ++i)
        frame.pixels.push_back(static_cast<uint8_t>(i * i * 37));
    for (SocModel* soc : {&pair.quick, &pair.slow}) {
        // After 120 frames the sensor is quiet for long enough that its pins are driven only once
        // per millisecond.
        auto sends = [asked = 0u]() mutable { return ++asked % 137 < 120; };
        connectSensor(*soc, frame, sends);
        passUntil(*soc, McbModel::startClocks + 1000);
        for (unsigned word = 0; word < 5; ++word) // the FIFOs do not stand at their first place
            TwoChips::write(*soc);
        FSMC_init(&driverPort, &soc->fsmc());
        FSMC_write(MAP_SLOT_CAMERA, CAMERA_SIZE, 24 << 16 | 64);
        FSMC_write(MAP_SLOT_CAMERA, CAMERA_BASE, MAP_MEMORY_CAMERA);
        FSMC_write(MAP_SLOT_CAMERA, CAMERA_STRIDE, 4096);
        FSMC_write(MAP_SLOT_CAMERA, CAMERA_MASK, CAMERA_EVENT_FRAME_MASK);
        FSMC_write(MAP_SLOT_CAMERA, CAMERA_CONTROL, CAMERA_CONTROL_START_MASK);
    }
    Random random(testSeed());
    uint64_t frames = 0;
    for (unsigned looks = 0; looks < 400; ++looks) {
        const bool isLong = random.below(8) == 0;
        const uint64_t until = pair.quick.cycles() + 1 + random.below(isLong ? 40000 : 4000);
        while (pair.quick.cycles() < until)
            if (!pair.quick.passQuiet(until))
                pair.quick.tick();
        passUntil(pair.slow, until);
        expectSameState(pair.quick, pair.slow);
        ASSERT_FALSE(HasFailure());
        for (SocModel* soc : {&pair.quick, &pair.slow}) {
            if (looks % 100 == 50 || looks % 100 == 53)
                soc->memory().hang(looks % 100 == 50);
            if (looks % 20)
                continue;
            FSMC_init(&driverPort, &soc->fsmc());
            if (looks == 100) { // from 9600 baud to 250 kbaud
                FSMC_write(MAP_SLOT_MODEM, MODEM_RX_BASE, 0x10000);
                FSMC_write(MAP_SLOT_MODEM, MODEM_BAUD, 0x3D090 | MODEM_BAUD_WIRE_MASK);
                FSMC_write(MAP_SLOT_MODEM, MODEM_CONTROL, MODEM_CONTROL_CONFIGURE_MASK);
            }
            frames = FSMC_read(MAP_SLOT_CAMERA, CAMERA_FRAMES);
            FSMC_write(MAP_SLOT_CAMERA, CAMERA_EVENT, CAMERA_EVENT_FRAME_MASK);
        }
    }
    EXPECT_GT(frames, 50u);
    EXPECT_GT(FSMC_read(MAP_SLOT_CAMERA, CAMERA_DROPPED), 0u);
    EXPECT_EQ(std::memcmp(pair.quick.memory().data(), pair.slow.memory().data(),
                          pair.slow.memory().size()),
              0);
    if (pair.quick.camera().exists()) {
        EXPECT_GT(pair.quick.evaluatedAlone() * 4, pair.quick.evaluated() * 3);
    }
    EXPECT_EQ(pair.slow.evaluatedAlone(), 0u);
    std::printf("%lu clocks, %lu evaluated, %lu of them alone, %lu frames\n", pair.quick.cycles(),
                pair.quick.evaluated(), pair.quick.evaluatedAlone(), frames);
}
#endif

// Modem and air must act in the clock in which they are due, whenever the test looks at them.
TEST(Quiet, ModemAndAirActInTheRightClock) {
    GroundAndChip world;
    auto& [air, ground, soc] = world;
    soc.reset(true);
    Random random(testSeed());
    soc.onClock([&air = air, &soc = soc, &random] {
        EXPECT_GT(air.nextEvent(), soc.now());
        EXPECT_GT(soc.modem().nextEvent(), soc.now());
        EXPECT_EQ(soc.chip().modem_rxd_i, soc.line().rxd());
        EXPECT_EQ(soc.chip().modem_cts_n_i, soc.line().ctsN());
        return soc.cycles() + 1 + random.below(5000);
    });
    Script calls = ground.pinging(3);
    UavMachine machine(soc, [&] { return !calls() && world.within(5); });
    machine.run();
    EXPECT_EQ(ground.replies.size(), 3u);
}

// If a processor takes no packets, the ring becomes full, and RTS stops further bytes.
TEST(Quiet, BytesHeldByRtsContinueInTheRightClock) {
    // RTS rises when 14 of 16 packets are in the ring
    constexpr unsigned bytes = 2500, fill = 14 * 100;
    constexpr uint64_t bitNs = 4000, byteNs = 10 * bitNs;
    RfChannel air(testSeed());
    SocModel soc(air, Ground::uavModem());
    HostLine host;
    Cable cable(soc.line(), host, bitNs, [](const SerialLine&) {});
    soc.plugIn(cable);
    soc.onTime([&host, begin = uint64_t{50'000'000}](uint64_t now) mutable {
        if (now < begin)
            return begin;
        host.send(std::vector<uint8_t>(bytes, 0xFF), now);
        begin = ~uint64_t{0};
        return now + 1;
    });
    soc.reset();
    ASSERT_EQ(FSMC_init(&driverPort, &soc.fsmc()), FSMC_OK);
    FSMC_write(MAP_SLOT_MODEM, MODEM_RX_BASE, 0x10000);
    FSMC_write(MAP_SLOT_MODEM, MODEM_BAUD, 0x3D090 | MODEM_BAUD_WIRE_MASK);
    FSMC_write(MAP_SLOT_MODEM, MODEM_CONTROL, MODEM_CONTROL_CONFIGURE_MASK);
    Random random(testSeed());
    auto pass = [&](uint64_t ns) {
        for (const uint64_t end = soc.now() + ns; soc.now() < end;) {
            passUntil(soc, soc.cycles() + 1 + random.below(5000));
            EXPECT_EQ(soc.chip().modem_rxd_i, soc.line().rxd()) << "in clock " << soc.cycles();
        }
    };
    pass(50'000'000 + bytes * byteNs);
    EXPECT_TRUE(soc.chip().modem_rts_n_o);
    unsigned taken = 0;
    for (U32 get; (get = FSMC_read(MAP_SLOT_MODEM, MODEM_RX_GET)) & MODEM_RX_GET_VALID_MASK;) {
        taken += get & MODEM_RX_GET_BYTES_MASK;
        FSMC_write(MAP_SLOT_MODEM, MODEM_RX_RELEASE, 1);
        pass((bytes - taken < fill ? 200 : random.below(200)) * byteNs);
    }
    EXPECT_EQ(taken, bytes);
    EXPECT_FALSE(soc.chip().modem_rts_n_o);
}

} // namespace
