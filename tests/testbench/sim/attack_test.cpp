// SPDX-License-Identifier: MIT
//
// attack_test: a third modem on the air does its worst to a flying vehicle: RTL, modems, firmware,
// and a ground station that calls it. With a key nothing comes of it; in the clear a session ends.

#include "attacker.h"
#include "ground.h"
#include "uav_machine.h"
#include <gtest/gtest.h>

extern "C" {
extern Link uav_link; // the firmware's
}

namespace {

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
    // The vehicle starts, and flies until the script, which is called each millisecond, is over.
    void fly(const Script& script, double limitSeconds) {
        bool done = false;
        const uint64_t limit = soc.now() + static_cast<uint64_t>(limitSeconds * 1e9);
        UavMachine machine(soc, [&] {
            if (period_ && soc.now() >= nextMischief_) {
                attacker_.doMischief(soc.now());
                nextMischief_ = soc.now() + period_;
            }
            done = script();
            return !done && soc.now() < limit;
        });
        machine.board = SimulatedBoard(++boots_);
        machine.board.provide(key_);
        soc.reset();
        machine.run();
        EXPECT_TRUE(done) << "not done after " << limitSeconds << " simulated seconds";
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

// Eight of them, one for each epoch, ended a session in the clear, 60 times of 60.
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

TEST_F(Attack, InTheClearEightBlindResetsEndASession) {
    start({});
    fly(inOrder({ground.pinging(3),
                 [&] {
                     attacker_.send(0, 1, blindResets(), soc.now());
                     return true;
                 },
                 [] { return Link_state(&uav_link) != LINK_STATE_UP; }}),
        20);
}

// Twenty bytes to each packet, when the vehicle starts, when the ground does, and in flight.
TEST_F(Attack, WithAKeyWhoAddsBytesToEachPacketPreventsNoSession) {
    start(vehicleKey);
    attacker_.hinder(true);
    fly(inOrder({ground.pinging(5),
                 [&] {
                     ground.start();
                     return true;
                 },
                 ground.pinging(5)}),
        60);
    expectAllAnswered(5);
}

// Everything that is possible without the key, while the ground and then the vehicle start anew;
// then earlier packets are repeated.
TEST_F(Attack, WithAKeyNothingComesOfAnyMischief) {
    start(vehicleKey);
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
