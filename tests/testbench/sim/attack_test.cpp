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

class Attack : public ::testing::Test {
protected:
    void start(const Bytes& key) {
        key_ = ground_.key = key;
        uav_guardMs = Ground::guardMs;
        ground_.start();
        soc_.onTime([this](uint64_t now) {
            attacker_.advance(now);
            return std::min(ground_.advance(now), attacker_.nextEvent());
        });
    }
    // The vehicle starts, and flies until the script, which is called each millisecond, returns
    // true.
    void fly(const std::function<bool()>& script, double limitSeconds) {
        bool done = false;
        const uint64_t limit = soc_.now() + static_cast<uint64_t>(limitSeconds * 1e9);
        UavMachine machine(soc_, [&] {
            if (period_ && soc_.now() >= nextMischief_) {
                attacker_.doMischief(soc_.now());
                nextMischief_ = soc_.now() + period_;
            }
            done = script();
            return !done && soc_.now() < limit;
        });
        machine.board = SimulatedBoard(++boots_);
        machine.board.provide(key_);
        soc_.reset();
        machine.run();
        EXPECT_TRUE(done) << "not done after " << limitSeconds << " simulated seconds";
    }
    void expectAllAnswered(size_t count) {
        EXPECT_EQ(ground_.replies.size(), count);
        for (auto& [id, status] : ground_.replies)
            EXPECT_EQ(status, 0) << id;
        EXPECT_EQ(ground_.unknown, 0) << "a message was lost with its session";
    }

    RfChannel air_{testSeed()};
    Attacker attacker_{air_, testSeed() + 9};
    Ground ground_{air_, testSeed() + 5};
    SocModel soc_{air_, Ground::uavModem()};
    Bytes key_;
    uint64_t period_ = 0, nextMischief_ = 0, boots_ = 0;
};

// Eight of them, one for each epoch, ended a session in the clear, 60 times of 60.
Bytes blindResets(bool withTags) {
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
        if (withTags)
            all.resize(all.size() + LINK_TAG - LINK_CRC);
    }
    return all;
}

TEST_F(Attack, InTheClearEightBlindResetsEndASession) {
    start({});
    auto first = ground_.pinging(3);
    int phase = 0;
    fly(
        [&] {
            if (phase == 0 && first()) {
                attacker_.send(0, 1, blindResets(false), soc_.now());
                phase = 1;
            }
            return phase == 1 && Link_state(&uav_link) != LINK_STATE_UP;
        },
        20);
}

TEST_F(Attack, WithAKeyResetsEndNothing) {
    start(vehicleKey);
    auto calls = ground_.pinging(20);
    uint64_t next = 0;
    fly(
        [&] {
            if (ground_.isUp() && soc_.now() >= next) {
                const bool up = (next / ms) % 2;
                attacker_.send(!up, up, blindResets((next / ms) % 3), soc_.now());
                next = soc_.now() + 31 * ms;
            }
            return calls();
        },
        60);
    expectAllAnswered(20);
    EXPECT_EQ(Link_statistics(&uav_link)->sessions, 1u);
    EXPECT_EQ(ground_.statistics().sessions, 1u);
}

// Twenty bytes to each packet, when the vehicle starts, when the ground does, and in flight.
TEST_F(Attack, WithAKeyWhoAddsBytesToEachPacketPreventsNoSession) {
    start(vehicleKey);
    attacker_.hinder(true);
    auto first = ground_.pinging(5), second = ground_.pinging(5);
    int phase = 0;
    fly(
        [&] {
            if (phase == 0 && first()) {
                ground_.start();
                phase = 1;
            }
            return phase == 1 && second();
        },
        60);
    expectAllAnswered(5);
}

// Everything that is possible without the key, while the ground and then the vehicle start anew;
// then earlier packets are repeated.
TEST_F(Attack, WithAKeyNothingComesOfAnyMischief) {
    start(vehicleKey);
    period_ = 25 * ms;
    auto first = ground_.pinging(15), second = ground_.pinging(15), third = ground_.pinging(15);
    int phase = 0;
    fly(
        [&] {
            if (phase == 0 && first()) {
                expectAllAnswered(15);
                EXPECT_EQ(Link_statistics(&uav_link)->sessions, 1u);
                EXPECT_EQ(ground_.statistics().sessions, 1u);
                ground_.start();
                phase = 1;
            }
            return phase == 1 && second();
        },
        120);
    expectAllAnswered(15);
    EXPECT_EQ(Link_statistics(&uav_link)->sessions, 2u);
    ground_.start();
    fly([&] { return third(); }, 120);
    expectAllAnswered(15);
    EXPECT_EQ(Link_statistics(&uav_link)->sessions, 1u);
    EXPECT_EQ(ground_.statistics().sessions, 1u);
    std::printf("%llu hostile packets, %zu packets known to the attacker\n",
                static_cast<unsigned long long>(attacker_.sent()), attacker_.heard());
}

} // namespace
