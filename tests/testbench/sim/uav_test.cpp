// SPDX-License-Identifier: MIT
//
// uav_test: RTL, modems, radio and firmware together, deterministic: the ground is the same link
// layer in this process, and requests are written byte by byte.

#include "ground.h"
#include "uav_machine.h"
#include <gtest/gtest.h>

extern "C" {
extern Link uav_link; // the firmware's
}

namespace {

class Uav : public ::testing::Test {
protected:
    void SetUp() override {
        uav_guardMs = Ground::guardMs;
        soc_.onTime([this](uint64_t now) { return ground_.advance(now); });
        soc_.reset(true);
    }
    // Runs the firmware with a script: called each millisecond until it returns true.
    void fly(std::function<bool()> script, double limitSeconds) {
        bool done = false;
        UavMachine machine(soc_, [&] {
            done = script();
            return !done && static_cast<double>(soc_.now()) < limitSeconds * 1e9;
        });
        machine_ = &machine;
        machine.run();
        EXPECT_TRUE(done) << "not done after " << limitSeconds << " simulated seconds";
    }

    RfChannel air_{testSeed()};
    Ground ground_{air_, testSeed() + 5};
    SocModel soc_{air_, Ground::uavModem()};
    UavMachine* machine_ = nullptr; // while it flies
};

TEST_F(Uav, AnswersPings) {
    fly(ground_.pinging(20), 20);
    for (auto& [id, status] : ground_.replies)
        EXPECT_EQ(status, 0) << id;
}

TEST_F(Uav, AnObjectThatDoesNotExistIsSaidNotToExist) {
    fly(ground_.pinging(1, "nobody"), 20);
    EXPECT_EQ(ground_.replies[1], 2);
}

TEST_F(Uav, TenPercentLossIsNotNoticed) {
    air_.weather.loss = 0.1;
    fly(ground_.pinging(40), 60);
    for (auto& [id, status] : ground_.replies)
        EXPECT_EQ(status, 0) << id;
    EXPECT_GT(air_.counters().lost, 0u);
}

TEST_F(Uav, CorruptionAndDuplicationAreNotNoticed) {
    air_.weather.corruption = 0.03;
    air_.weather.duplication = 0.1;
    fly(ground_.pinging(40), 60);
    EXPECT_EQ(ground_.replies.size(), 40u);
}

TEST_F(Uav, TheGroundGoesAwayAndComesBack) {
    auto first = ground_.pinging(3), second = ground_.pinging(3);
    int phase = 0;
    uint64_t since = 0;
    fly(
        [&] {
            if (phase == 0 && first()) {
                ground_.running = false; // the program is killed
                since = soc_.now();
                machine_->hurry(10);
                phase = 1;
            }
            if (phase == 1 && soc_.now() - since > 1'200'000'000) { // 12 s by the UAV's clock
                EXPECT_NE(Link_state(&uav_link), LINK_STATE_UP) << "the UAV has not noticed";
                machine_->hurry(1);
                ground_.start();
                phase = 2;
            }
            return phase == 2 && second();
        },
        20);
}

TEST_F(Uav, AModemResetInMidPacketIsRecoveredFrom) {
    auto first = ground_.pinging(3), second = ground_.pinging(3);
    int phase = 0;
    uint64_t since = 0;
    fly(
        [&] {
            if (phase == 0 && first()) {
                ground_.ping(100, "hwengine1"); // while this is on its way ...
                since = soc_.now();
                phase = 1;
            }
            if (phase == 1 && soc_.now() - since > 8'000'000) {
                soc_.modem().resetPin(true, soc_.now()); // ... the UAV's modem loses its settings
                soc_.modem().resetPin(false, soc_.now() + 1000);
                EXPECT_EQ(soc_.modem().parameter("BD"), 3u);
                machine_->hurry(10);
                ground_.hurry = 10;
                phase = 2;
            }
            // The link is given up after 9 s of silence, the modem set up again 15 s later, in its
            // own time.
            if (ground_.hurry > 1 && soc_.now() - since > 2'350'000'000) {
                EXPECT_NE(Link_state(&uav_link), LINK_STATE_UP) << "the UAV has not noticed";
                EXPECT_EQ(soc_.modem().parameter("BD"), 3u);
                machine_->hurry(1);
                ground_.hurry = 1;
            }
            if (phase == 2 && !ground_.isUp())
                phase = 3;
            if (phase == 3 && ground_.isUp()) {
                ground_.replies.clear();
                phase = 4;
            }
            return phase == 4 && second();
        },
        20);
    EXPECT_EQ(soc_.modem().parameter("BD"), 7u);
}

TEST_F(Uav, GarbageOnTheGroundsSerialLineIsSurvived) {
    Random random(testSeed());
    auto ping = ground_.pinging(20);
    uint64_t next = 0;
    fly(
        [&] {
            if (ground_.isUp() && soc_.now() > next) {
                ground_.noise(random.items<uint8_t>(1 + random.below(40)));
                next = soc_.now() + 150'000'000;
            }
            return ping();
        },
        60);
}

TEST_F(Uav, TheSameSeedGivesTheSameRun) {
    fly(ground_.pinging(5), 20);
    uint64_t cycles = soc_.cycles();
    RfChannel air(testSeed());
    Ground ground(air, testSeed() + 5);
    SocModel soc(air, Ground::uavModem());
    soc.onTime([&](uint64_t now) { return ground.advance(now); });
    soc.reset(true);
    UavMachine machine(soc, [script = ground.pinging(5)] { return !script(); });
    machine.run();
    EXPECT_EQ(soc.cycles(), cycles);
}

} // namespace
