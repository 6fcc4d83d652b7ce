// SPDX-License-Identifier: MIT
//
// minimal_test: the minimal layer as the vehicle, the full one as the ground station: bad weather,
// reboots, garbage, channels, messages that the program does not take. What holds for a vehicle
// with the full layer as well is tested with both.

#include "variant.h"
#include <algorithm>
#include <deque>
#include <gtest/gtest.h>

namespace {

using Sent = std::vector<std::pair<int, Bytes>>;

constexpr int firstFull = 6; // parameters from here on have a vehicle with the full layer

class Vehicle : public ::testing::TestWithParam<int>, public Radio {
protected:
    // Every second one with a key.
    Vehicle()
        : Radio("full", GetParam() < firstFull ? "minimal" : "full",
                testSeed() * 1000 + static_cast<uint64_t>(GetParam()),
                Bytes(GetParam() % 2 ? LINK_KEY_BYTES : 0, 0x5A)) {}

    void offer(Peer& from, Sent& sent, unsigned most) {
        if (sent.size() >= most)
            return;
        int channel = static_cast<int>(random_.below(4));
        Bytes m(1 + random_.below(random_.below(4) ? 60 : 500));
        for (auto& byte : m)
            byte = static_cast<uint8_t>(random_.next());
        Link_Status status = from.send(channel, m, static_cast<U32>(sent.size()));
        if (status == LINK_OK)
            sent.emplace_back(channel, m);
        else if (status == LINK_CLOSED || status == LINK_DOWN)
            from.open(channel);
    }
    // Sends messages both ways until their number is reached and all are reported, or time is over.
    bool traffic(unsigned messages, uint64_t limitUs) {
        return until(
            [&] {
                offer(a_, sentA_, messages);
                offer(b_, sentB_, messages);
                return a_.outcomes.size() == messages && b_.outcomes.size() == messages;
            },
            limitUs);
    }
    // The messages that arrived are a part of those sent, in order and unchanged, and hold all that
    // was reported as delivered. Between full layers a short one may overtake on another channel.
    static void check(const Sent& sent, const Peer& sender, const Peer& receiver) {
        ASSERT_EQ(sender.outcomes.size(), sent.size()) << "messages not reported";
        auto order = [](int channel) { return GetParam() < firstFull ? 0 : channel; };
        std::deque<Sent::value_type> received[LINK_CHANNELS];
        for (auto& message : receiver.received)
            received[order(message.first)].push_back(message);
        for (size_t i = 0; i < sent.size(); ++i) {
            auto& here = received[order(sent[i].first)];
            const bool arrived = !here.empty() && here.front() == sent[i];
            if (arrived)
                here.pop_front();
            if (sender.outcomes.at(static_cast<U32>(i)) == LINK_DELIVERED) {
                EXPECT_TRUE(arrived) << "message " << i << " was reported delivered";
            }
        }
        for (auto& left : received)
            EXPECT_TRUE(left.empty()) << left.size() << " messages doubled, wrong or out of order";
    }
    void checkBoth() {
        check(sentA_, a_, b_);
        check(sentB_, b_, a_);
    }
    Sent sentA_, sentB_;
    Random random_{testSeed() * 77 + static_cast<uint64_t>(GetParam())};
};

TEST_P(Vehicle, NothingIsLostDoubledOrReorderedInBadWeather) {
    ASSERT_TRUE(connect());
    setWeather(0.1, 0.05, 0.03);
    EXPECT_TRUE(traffic(400, 1'000'000'000)) << "seed " << testSeed();
    checkBoth();
    for (auto* side : {&a_, &b_})
        for (auto& [tag, outcome] : side->outcomes)
            EXPECT_EQ(outcome, LINK_DELIVERED) << tag;
}

TEST_P(Vehicle, RebootsAreNoticedAndMessagesInFlightReported) {
    ASSERT_TRUE(connect());
    b_.start(b_.link(), us());
    setWeather(0.05, 0.05, 0.01);
    for (unsigned round = 0; round < 6; ++round) {
        traffic(40 * (round + 1), 3'000'000 + random_.below(3'000'000));
        bool isA = random_.below(2) != 0;
        Peer& side = isA ? a_ : b_;
        side.boot();
        Sent& sent = isA ? sentA_ : sentB_;
        for (U32 i = 0; i < sent.size();
             ++i) // counts messages in flight as lost, like an application
            side.outcomes.emplace(i, LINK_UNKNOWN);
        side.start(side.link(), us());
        ASSERT_TRUE(until([&] { return bothUp(); }, 60'000'000)) << "round " << round;
    }
    EXPECT_TRUE(traffic(240, 600'000'000)) << "seed " << testSeed();
    checkBoth();
}

TEST_P(Vehicle, GarbageOnTheLineDoesNotDisturbTheSession) {
    ASSERT_TRUE(connect());
    for (unsigned i = 0; i < 60; ++i) {
        Bytes noise(1 + random_.below(150));
        for (auto& byte : noise)
            byte = static_cast<uint8_t>(random_.next());
        b_.receive(b_.link(), noise.data(), static_cast<U32>(noise.size()), us());
        traffic(3 * (i + 1), 200'000);
    }
    EXPECT_TRUE(traffic(180, 100'000'000)) << "seed " << testSeed();
    checkBoth();
    EXPECT_EQ(b_.events.front(), "up");
    for (auto& event : b_.events)
        EXPECT_NE(event, "down");
    if (GetParam() >= firstFull) { // the minimal layer does not count
        EXPECT_GT(b_.statistics(b_.link())->crcErrors, 0u);
    }
}

// A side that sends the beginning of a frame each 20 ms leaves no silence for a frame to follow.
TEST_P(Vehicle, BeginningsOfFramesBetweenPacketsDoNotStopIt) {
    ASSERT_TRUE(connect());
    uint64_t at = now_;
    const bool isOver = until(
        [&] {
            offer(a_, sentA_, 60);
            offer(b_, sentB_, 60);
            if (now_ >= at) {
                const Bytes cut(1 + random_.below(3), 0x7F);
                b_.receive(b_.link(), cut.data(), static_cast<U32>(cut.size()), us());
                at += 20'000;
            }
            return a_.outcomes.size() == 60 && b_.outcomes.size() == 60;
        },
        100'000'000);
    EXPECT_TRUE(isOver) << a_.outcomes.size() << " and " << b_.outcomes.size() << " messages";
    checkBoth();
    EXPECT_EQ(std::count(b_.events.begin(), b_.events.end(), "up"), 1);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Vehicle, ::testing::Range(0, firstFull + 8));

class VehicleOnce : public Vehicle {};
INSTANTIATE_TEST_SUITE_P(Once, VehicleOnce, ::testing::Values(0, 1, firstFull, firstFull + 1));

class MinimalOnce : public Vehicle {};
INSTANTIATE_TEST_SUITE_P(Once, MinimalOnce, ::testing::Range(0, 2));

TEST_P(MinimalOnce, TenThousandSmallMessagesWrapTheNumbersManyTimes) {
    ASSERT_TRUE(connect());
    setWeather(0.02, 0.02, 0.01);
    EXPECT_TRUE(traffic(10'000, 10'000'000'000)) << "seed " << testSeed();
    checkBoth();
}

// 10^6 random bytes, between messages: no fault, and the link goes on.
TEST_P(MinimalOnce, AMillionRandomBytesAreSurvived) {
    ASSERT_TRUE(connect());
    Bytes noise(1000);
    for (int i = 0; i < 1000; ++i) {
        for (auto& byte : noise)
            byte = static_cast<uint8_t>(random_.next());
        b_.receive(b_.link(), noise.data(), 1000, us());
        run(2000);
    }
    ASSERT_TRUE(until([&] { return bothUp(); }, 60'000'000));
    run(1'000'000);
    a_.open(2);
    b_.received.clear();
    ASSERT_TRUE(until([&] { return a_.send(2, {'h', 'i'}, 9) == LINK_OK; }, 60'000'000));
    ASSERT_TRUE(until([&] { return !b_.received.empty(); }, 60'000'000));
    EXPECT_EQ(b_.received[0].second, (Bytes{'h', 'i'}));
}

TEST_P(MinimalOnce, ChannelsOpenAndCloseFromBothSidesInOrder) {
    ASSERT_TRUE(connect());
    ASSERT_EQ(a_.open(1), LINK_OK);
    ASSERT_EQ(a_.send(1, {1}, 1), LINK_OK);
    ASSERT_EQ(a_.close(1), LINK_OK);
    ASSERT_EQ(b_.open(3), LINK_OK);
    ASSERT_EQ(b_.send(3, Bytes(300, 2), 2), LINK_OK);
    EXPECT_EQ(b_.close(3), LINK_FULL); // its opening has not gone out
    ASSERT_TRUE(until([&] { return b_.close(3) == LINK_OK; }, 1'000'000));
    ASSERT_TRUE(until([&] { return b_.outcomes.count(2) && a_.outcomes.count(1); }, 2'000'000));
    run(300'000);
    EXPECT_EQ(b_.events, (std::vector<std::string>{"up", "open 1", "close 1"}));
    EXPECT_EQ(a_.events, (std::vector<std::string>{"down", "up", "open 3", "close 3"}));
    EXPECT_EQ(a_.received, (Sent{{3, Bytes(300, 2)}}));
    EXPECT_EQ(b_.received, (Sent{{1, {1}}}));
    EXPECT_EQ(a_.open(1), LINK_OK); // both sides have said that it is closed
    EXPECT_EQ(b_.open(3), LINK_OK);
}

TEST_P(VehicleOnce, ALateMessageDoesNotReachTheNextConnection) {
    ASSERT_TRUE(connect());
    ASSERT_EQ(b_.open(3), LINK_OK);
    run(300'000);
    ASSERT_EQ(a_.send(3, {1}, 0), LINK_OK);
    ASSERT_EQ(b_.close(3), LINK_OK);
    EXPECT_EQ(b_.open(3), LINK_FULL);
    run(300'000);
    EXPECT_EQ(b_.open(3), LINK_OK);
    run(300'000);
    EXPECT_TRUE(b_.received.empty());
}

TEST_P(MinimalOnce, WhatIsWrongIsRefused) {
    EXPECT_EQ(b_.open(0), LINK_DOWN);
    EXPECT_EQ(b_.send(0, {1}, 0), LINK_CLOSED);
    ASSERT_TRUE(connect());
    EXPECT_EQ(b_.send(0, {1}, 0), LINK_CLOSED);
    EXPECT_EQ(b_.close(0), LINK_CLOSED);
    for (int channel : {-1, LINK_CHANNELS}) {
        EXPECT_EQ(b_.open(channel), LINK_DOWN);
        EXPECT_EQ(b_.close(channel), LINK_CLOSED);
        EXPECT_EQ(b_.send(channel, {1}, 0), LINK_CLOSED);
    }
    ASSERT_EQ(b_.open(0), LINK_OK);
    EXPECT_EQ(b_.send(0, Bytes(b_.maxMessage() + 1), 0), LINK_TOO_LONG);
    EXPECT_EQ(b_.send(0, {}, 0), LINK_TOO_LONG);
    EXPECT_EQ(b_.send(0, Bytes(b_.maxMessage()), 1), LINK_OK);
    EXPECT_EQ(b_.send(0, {1}, 2), LINK_FULL);
    ASSERT_TRUE(until([&] { return b_.outcomes.count(1) != 0; }, 10'000'000));
    EXPECT_EQ(a_.received[0].second.size(), b_.maxMessage());
}

TEST_P(VehicleOnce, AMessageThatIsNotTakenWaitsAndStopsTheSender) {
    ASSERT_TRUE(connect());
    b_.refuse = true;
    a_.open(0);
    for (U32 tag = 0; tag < 10; ++tag)
        EXPECT_EQ(a_.send(0, Bytes(900, static_cast<uint8_t>(tag)), tag), LINK_OK);
    run(12'000'000);
    EXPECT_TRUE(bothUp());
    EXPECT_TRUE(b_.received.empty());
    b_.refuse = false;
    ASSERT_TRUE(until([&] { return a_.outcomes.size() == 10; }, 30'000'000));
    ASSERT_EQ(b_.received.size(), 10u);
    for (uint8_t tag = 0; tag < 10; ++tag)
        EXPECT_EQ(b_.received[tag].second, Bytes(900, tag));
}

TEST_P(MinimalOnce, AVanishedGroundIsNoticedAndAReturningOneFound) {
    ASSERT_TRUE(connect());
    b_.open(3);
    setWeather(1, 0, 0);
    b_.send(3, {1, 2, 3}, 1);
    ASSERT_TRUE(until([&] { return !b_.outcomes.empty(); }, 20'000'000));
    EXPECT_EQ(b_.outcomes[1], LINK_UNKNOWN);
    EXPECT_FALSE(b_.isUp());
    EXPECT_EQ(b_.deadline(b_.link(), us()), 0xFFFFFFFFU);
    setWeather(0, 0, 0);
    EXPECT_TRUE(until([&] { return bothUp(); }, 20'000'000));
    EXPECT_TRUE(a_.received.empty());
}

// The ground hears of it by its next frame, not by 9 s of silence.
TEST_P(MinimalOnce, ARebootOfTheVehicleIsNoticedByTheNextFrame) {
    ASSERT_TRUE(connect());
    a_.open(0);
    run(100'000);
    b_.boot();
    EXPECT_EQ(a_.send(0, {1}, 7), LINK_OK);
    ASSERT_TRUE(until([&] { return a_.outcomes.count(7) != 0; }, 500'000));
    EXPECT_EQ(a_.outcomes[7], LINK_UNKNOWN);
    EXPECT_TRUE(until([&] { return bothUp(); }, 1'000'000));
}

TEST_P(MinimalOnce, StopTellsTheOtherSide) {
    ASSERT_TRUE(connect());
    run(100'000);
    b_.stop(b_.link(), us());
    run(15'000);
    EXPECT_EQ(a_.events.back(), "down");
    ASSERT_TRUE(until([&] { return bothUp(); }, 1'000'000)); // the ground calls again
    a_.stop(a_.link(), us());
    run(15'000);
    EXPECT_EQ(b_.events.back(), "down");
    run(1'000'000);
    EXPECT_FALSE(b_.isUp());
}

// The link works if Link_poll is called only at the times of Link_deadline.
TEST_P(MinimalOnce, TheDeadlineIsWhenSomethingIsToBeDone) {
    ASSERT_TRUE(connect());
    ASSERT_EQ(b_.open(3), LINK_OK);
    EXPECT_LE(b_.deadline(b_.link(), us()), 1000u);
    run(100'000);
    EXPECT_GT(b_.deadline(b_.link(), us()), 1'000'000u); // the ground's silence
    setWeather(1, 0, 0);
    ASSERT_EQ(b_.send(3, {1}, 1), LINK_OK);
    run(2000);
    U32 wait = b_.deadline(b_.link(), us());
    EXPECT_GT(wait, 100'000u); // goes out again after 144 ms
    EXPECT_LE(wait, 144'000u);
}

} // namespace
