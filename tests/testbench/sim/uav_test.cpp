// SPDX-License-Identifier: MIT
//
// uav_test: tests RTL, modems, radio and firmware together; the simulation is deterministic. The
// ground station uses the same link layer in this process, and its requests are written byte by
// byte. A third modem on the air attacks: if the link has a key it achieves nothing; without a key
// it can end a session.

#include "attacker.h"
#include "to_all.h"
#include "uav_machine.h"
#include <gtest/gtest.h>

extern "C" {
extern Link uav_link; // the firmware's
}

namespace {

class Uav : public ::testing::Test, protected GroundAndChip {};

TEST_F(Uav, AModemResetInMidPacketIsRecovered) {
    uint64_t since = 0;
    UavMachine* machine = nullptr;
    auto hurry = [&](unsigned times) {
        EXPECT_EQ(soc.modem().parameter("BD"), 3u);
        machine->hurry(times);
        ground.hurry = times;
        return true;
    };
    soc.reset(true);
    auto script =
        inOrder({ground.pinging(3),
                 [&] {
                     // sends a call; the UAV's modem loses its settings before the call is answered
                     ground.ping(100, "hwengine1");
                     since = soc.now();
                     return true;
                 },
                 [&] { return soc.now() - since > 8'000'000; },
                 [&] { // the UAV's modem loses its settings
                     soc.modem().resetPin(true, soc.now());
                     soc.modem().resetPin(false, soc.now() + 1000);
                     return hurry(10);
                 },
                 // The link is ended after 9 s of silence, and the modem is set up again 15 s
                 // later. Both times are times of the vehicle clock, which is faster here.
                 [&] { return soc.now() - since > 2'350'000'000; },
                 [&] {
                     EXPECT_NE(Link_state(&uav_link), LINK_STATE_UP) << "the UAV has not noticed";
                     EXPECT_FALSE(ground.isUp());
                     return hurry(1);
                 },
                 [&] {
                     ground.replies.clear();
                     return ground.isUp();
                 },
                 ground.pinging(3)});
    EXPECT_TRUE(flies(soc, script, 20, [&](UavMachine& m) { machine = &m; }));
    EXPECT_EQ(soc.modem().parameter("BD"), 250000u);
}

// Tests with a vehicle, two ground stations that have separate keys, and a ground station with a
// wrong key.
class TwoGrounds : public GroundAndChip {
public:
    static constexpr uint32_t observersAddress = 0x00F0;
    const std::vector<uint8_t> pilotsKey = std::vector<uint8_t>(LINK_KEY_BYTES, 0x11),
                               observersKey = std::vector<uint8_t>(LINK_KEY_BYTES, 0x22);

    TwoGrounds() {
        ground.key = pilotsKey;
        observer.key = stranger.key = observersKey;
        for (Ground* g : {&ground, &observer, &stranger})
            g->start();
        soc.onTime([this](uint64_t now) {
            return std::min({ground.advance(now), observer.advance(now), stranger.advance(now)});
        });
        soc.reset(true);
    }
    // Both ground stations call at the same time. The observer disappears during a call. The
    // observer returns first with the pilot's key, then with its own key.
    Script flight() {
        const auto vanish = [this] {
            since_ = soc.now();
            observer.ping(100, "hwengine1");
            observer.running = false;
            return true;
        };
        return inOrder(
            {[this] { return ground.validated && observer.validated; },
             [this, both = together(15)]() mutable { return both(); }, vanish,
             [this, calls = ground.calling(std::vector<Ground::Call>(40, ping))]() mutable {
                 if (soc.now() - since_ < 1'000'000)
                     ground.replies.clear();
                 return calls();
             },
             [this] {
                 EXPECT_LT(double(soc.now() - since_) / 1e9, 40 * 0.045) << "the pilot was delayed";
                 observer.key = pilotsKey;
                 observer.start();
                 since_ = soc.now();
                 return true;
             },
             [this] { return soc.now() - since_ > 4'000'000'000; },
             [this] {
                 EXPECT_FALSE(observer.isUp())
                     << "an observer with the pilot's key must not connect";
                 observer.key = observersKey;
                 observer.start();
                 return true;
             },
             [this] { return observer.validated; },
             [this] {
                 ground.replies.clear();
                 return true;
             },
             [this, both = together(5)]() mutable { return both(); },
             [this] {
                 EXPECT_EQ(ground.statistics().sessions, 1u) << "the pilot's session must continue";
                 EXPECT_EQ(stranger.statistics().sessions, 0u)
                     << "a stranger with the key but another address must not connect";
                 for (const Ground* g : {&ground, &observer})
                     for (const auto& [id, status] : g->replies)
                         EXPECT_EQ(status, 0) << id;
                 return true;
             }});
    }

    Ground observer{air, testSeed() + 6, observersAddress}, stranger{air, testSeed() + 7, 0x0BAD};

private:
    const Ground::Call ping = {"hwengine1", "ice_ping", 2};

    Script together(size_t calls) {
        return [pilots = ground.pinging(calls), others = observer.pinging(calls)]() mutable {
            const bool isDone = pilots();
            return others() && isDone;
        };
    }
    uint64_t since_ = 0;
};

TEST(Grounds, OnlyTheTwoGroundsWithKeysAreServed) {
    TwoGrounds world;
    EXPECT_TRUE(flies(world.soc, world.flight(), 60, [&](UavMachine& machine) {
        machine.board.provide(world.pilotsKey);
        machine.board.providePeers({{UAV_OBSERVER, world.observersAddress, world.observersKey}});
    }));
    EXPECT_EQ(Link_statistics(&uav_link)->bytesSkipped, 0u)
        << "bytes of the stranger reached the pilot's link";
}

TEST(Fellow, AnAbsentVehicleCostsLittleAirTimeAndDelaysNoCall) {
    const std::vector<uint8_t> key(LINK_KEY_BYTES, 0x11), keyOfTwo(LINK_KEY_BYTES, 0x22);
    GroundAndChip world;
    world.ground.key = key;
    world.ground.start();
    world.soc.reset(true);
    world.provide(48, 32, [](uint32_t i) { return static_cast<uint8_t>(i * 37); });
    // After a frame, the vehicle calls the other ground station.
    const std::vector<Ground::Call> frame = {{"hwengine1", "startProcessing"},
                                             {"hwengine1", "getResult"}};
    std::vector<Ground::Call> calls(20, {"hwengine1", "ice_ping", 2});
    calls.insert(calls.begin(), frame.begin(), frame.end());
    uint64_t since = 0, airNs = 0;
    auto script = inOrder({world.ground.calling(frame),
                           [&] {
                               since = world.soc.now();
                               airNs = world.air.counters().airNs;
                               return true;
                           },
                           [&] { return world.soc.now() - since > 8'000'000'000; },
                           [&] {
                               airNs = world.air.counters().airNs - airNs;
                               since = world.soc.now();
                               world.ground.replies.clear();
                               return true;
                           },
                           world.ground.calling(calls)});
    EXPECT_TRUE(flies(world.soc, script, 30, [&](UavMachine& machine) {
        machine.board.provide(key);
        machine.board.providePeers({{UAV_VEHICLE, 2, keyOfTwo}});
    }));
    EXPECT_LT(double(world.soc.now() - since) / 1e9, 22 * 0.045) << "the ground was delayed";
    const double share = double(airNs) / 8e9;
    std::printf("a fellow that is away takes %.2f %% of the air\n", 100 * share);
    EXPECT_LT(share, 0.02);
    EXPECT_GT(share, 0.004)
        << "the vehicle does not search for its fellow: idle sessions alone take 0.0015";
}

// Boots the vehicle with these memory contents, and flies. Returns the memory contents after the
// flight.
SimulatedBoard::Words fly(ToAll& w, std::vector<Script> steps,
                          const std::function<void(SimulatedBoard&)>& provide) {
    UavMachine machine(w.soc, w.flight(std::move(steps)));
    provide(machine.board);
    machine.run();
    EXPECT_TRUE(w.isDone);
    return machine.board.words;
}

TEST(CallsToAll, AreExecutedOnceIfTheOperationAllowsBroadcasts) {
    const ToAll::Key pilots(LINK_KEY_BYTES, 0x11), others(LINK_KEY_BYTES, 0x67);
    ToAll w(pilots);
    const auto kept =
        fly(w,
            {w.calls({w.high}), w.send(w.groups, 10, w.low), w.send(w.groups, 11, w.start),
             w.calls({w.result}, true, "both are carried out"), w.calls({w.high}), w.send(w.sent),
             w.send(others, 12, w.low), w.send(w.open, 12, w.low),
             w.calls({w.start, w.result}, false, "recorded, and of other keys"),
             w.send(w.groups, 13, {"uav", "setFlightState", 2, {1}}),
             w.calls({{"uav", "getFlightState", 2}}, false, "setFlightState is not marked"),
             w.send(w.groups, 14, w.low), w.calls({w.start, w.result}, true, "a new one")},
            [&](SimulatedBoard& board) {
                board.provide(pilots);
                board.providePeers({{UAV_GROUP, UAV_EVERYBODY, w.groups}});
            });
    fly(w,
        {w.calls({w.high}), w.send(w.sent),
         w.calls({w.start, w.result}, false, "recorded before the restart"),
         w.send(w.groups, 15, w.low), w.calls({w.start, w.result}, true, "a new one")},
        [&](SimulatedBoard& board) { board.words = kept; });
    EXPECT_EQ(Link_statistics(&uav_link)->bytesSkipped, 0u);
}

TEST(CallsToAll, NeedTheGroupKeyUnlessTheVehicleIsOpen) {
    for (const bool isOpen : {false, true}) {
        const ToAll::Key pilots(isOpen ? 0 : LINK_KEY_BYTES, 0x11);
        ToAll w(pilots);
        fly(w,
            {w.calls({w.high}), w.send(w.groups, 10, w.low),
             w.calls({w.start, w.result}, false, "under a key that it has not"),
             w.send(w.open, 11, w.low), w.calls({w.start, w.result}, isOpen, "unencrypted"),
             w.calls({w.high}), w.send({w.sent.back()}),
             w.calls({w.start, w.result}, false, "a copy")},
            [&](SimulatedBoard& board) { board.provide(pilots); });
        EXPECT_EQ(w.ground.statistics().sessions, 1u);
    }
}

using Bytes = std::vector<uint8_t>;

const Bytes vehicleKey = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
constexpr uint64_t ms = 1'000'000;

class Attack : public ::testing::Test, protected GroundAndChip {
protected:
    void start(const Bytes& key) {
        key_ = ground.key = key;
        ground.start();
        soc.onTime([this](uint64_t now) {
            attacker_.advance(now);
            return std::min(ground.advance(now), attacker_.nextEvent());
        });
    }
    // Boots the vehicle, and flies until the script, which is called every millisecond, has ended.
    void fly(const Script& script, double seconds) {
        const Script withMischief = [&] {
            if (period_ && soc.now() >= nextMischief_) {
                attacker_.doMischief(soc.now());
                nextMischief_ = soc.now() + period_;
            }
            return script();
        };
        const double now = static_cast<double>(soc.now()) / 1e9;
        EXPECT_TRUE(flies(soc, withMischief, now + seconds, [&](UavMachine& machine) {
            machine.board = SimulatedBoard(++boots_);
            machine.board.provide(key_);
            soc.reset();
        }));
    }
    void expectAllAnswered(size_t count) {
        EXPECT_EQ(ground.replies.size(), count);
        for (auto& [id, status] : ground.replies)
            EXPECT_EQ(status, 0) << id;
        EXPECT_EQ(ground.unknown, 0) << "a message was lost with its session";
    }

    Attacker attacker_{air, testSeed() + 9};
    Bytes key_;
    uint64_t period_ = 0, nextMischief_ = 0, boots_ = 0;
};

// Returns RST frames for all epochs. In the unencrypted protocol, eight of them, one per epoch,
// ended a session in each of 60 attempts.
Bytes blindResets() {
    Bytes all;
    for (U32 epoch = 0; epoch < 8; ++epoch) {
        U8 frame[LINK_OVERHEAD];
        frame[0] = LINK_CONTROL;
        frame[1] = 0;
        frame[2] = static_cast<U8>(LINK_KIND_BITS(LINK_KIND_RST) | epoch << 2);
        const U32 crc = link_crc(LINK_NO_SEED, frame, LINK_HEADER);
        frame[3] = static_cast<U8>(crc >> 8);
        frame[4] = static_cast<U8>(crc);
        all.insert(all.end(), frame, frame + sizeof frame);
    }
    return all;
}

TEST_F(Attack, InTheClearEightForgedResetsEndASession) {
    start({});
    fly(inOrder({ground.pinging(3),
                 [&] {
                     attacker_.send(0, 1, blindResets(), soc.now());
                     return true;
                 },
                 [] { return Link_state(&uav_link) != LINK_STATE_UP; }}),
        20);
}

// Does everything that is possible without the key, and adds twenty bytes after each packet, while
// first the ground station and then the vehicle restarts. After that it repeats earlier packets.
TEST_F(Attack, WithAKeyNoAttackHasAnEffect) {
    start(vehicleKey);
    attacker_.hinder(true);
    period_ = 25 * ms;
    fly(inOrder({ground.pinging(15),
                 [&] {
                     expectAllAnswered(15);
                     EXPECT_EQ(Link_statistics(&uav_link)->sessions, 1u);
                     EXPECT_EQ(ground.statistics().sessions, 1u);
                     ground.start();
                     return true;
                 },
                 ground.pinging(15)}),
        120);
    expectAllAnswered(15);
    EXPECT_EQ(Link_statistics(&uav_link)->sessions, 2u);
    ground.start();
    fly(ground.pinging(15), 120);
    expectAllAnswered(15);
    EXPECT_EQ(Link_statistics(&uav_link)->sessions, 1u);
    EXPECT_EQ(ground.statistics().sessions, 1u);
    std::printf("%llu hostile packets, %zu packets known to the attacker\n",
                static_cast<unsigned long long>(attacker_.sent()), attacker_.heard());
}

} // namespace
