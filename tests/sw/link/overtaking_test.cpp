// SPDX-License-Identifier: MIT
//
// overtaking_test: only short messages overtake, and only the rest of a long one on another
// channel.

#include "ice_messages.h"
#include "link_variants.h"

namespace {

// The arrived messages: channel and size of each.
using Arrived = std::vector<std::pair<int, size_t>>;

class Overtaking : public Variants {
protected:
    void SetUp() override {
        ASSERT_TRUE(connect());
        for (int channel : {0, 1, 2})
            ASSERT_EQ(a.open(channel), LINK_OK);
        run(500'000);
    }
    void send(int channel, const Bytes& m) { ASSERT_EQ(a.send(channel, m, tag_++), LINK_OK); }
    // Returns the microseconds of one message of 10 bytes.
    uint64_t call() {
        const size_t before = b.received.size();
        const uint64_t start = now;
        send(1, Bytes(10, 2));
        EXPECT_TRUE(until([&] { return b.received.size() > before; }, 5'000'000));
        EXPECT_EQ(b.received.back(), std::make_pair(1, Bytes(10, 2)));
        return now - start;
    }
    // Waits until all is reported as delivered.
    Arrived arrived() {
        EXPECT_TRUE(until([&] { return a.outcomes.size() == tag_; }, 60'000'000));
        for (auto& [tag, outcome] : a.outcomes)
            EXPECT_EQ(outcome, LINK_DELIVERED) << "message " << tag;
        Arrived list;
        for (auto& [channel, bytes] : b.received)
            list.emplace_back(channel, bytes.size());
        return list;
    }
    uint32_t tag_ = 0;
};

class FullOvertaking : public Overtaking {};

TEST_P(FullOvertaking, ACallTakesAtMostThreeTimesAsLongBehindAPicture) {
    const uint64_t idle = call();
    run(200'000);
    for (int i = 0; i < 5; ++i) {
        send(0, Bytes(1000, 1)); // a picture, 90 ms of the line each
        send(0, Bytes(1000, 1));
        run(30'000);
        EXPECT_LE(call(), 3 * idle);
        run(500'000);
    }
}

TEST_P(FullOvertaking, ACallDoesNotWaitForALostPartOfAPicture) {
    const uint64_t idle = call();
    for (int i = 0; i < 5; ++i) {
        run(500'000);
        send(0, Bytes(1000, 1));
        run(20'000);
        a.weather.loss = 1;
        run(9'000);
        a.weather.loss = 0;
        EXPECT_LE(call(), 3 * idle);
    }
    (void)arrived();
}

TEST_P(FullOvertaking, OnlyAcrossChannelsAndTheLongOneComesWhole) {
    send(0, Bytes(1000, 1));
    send(0, Bytes(11, 1)); // behind the picture of its channel
    run(20'000);
    send(1, Bytes(300, 3));
    send(1, Bytes(12, 3)); // behind a long one of its channel
    send(2, Bytes(13, 4));
    send(2, Bytes(14, 4));
    a.close(2);
    const Arrived all = arrived();
    EXPECT_EQ(all, (Arrived{{2, 13}, {2, 14}, {0, 1000}, {0, 11}, {1, 300}, {1, 12}}));
    for (auto& [channel, bytes] : b.received)
        EXPECT_EQ(bytes, Bytes(bytes.size(), bytes.front()));
    EXPECT_EQ(b.events.back(), "close 2");
}

// Both sides number the heads of requests alike only if they pass in the order of Link_send.
TEST_P(FullOvertaking, NothingOvertakesAHeadThatThePeerLearns) {
    auto request = [](uint32_t id, const char* operation, size_t size) {
        return IceMessages::request(id, "uav", operation, Bytes(size, 5));
    };
    send(1, request(1, "known", 1));
    run(300'000);
    b.received.clear();
    send(0, request(1, "picture", 500));
    send(1, request(2, "picture", 1)); // it uses the head that the picture brings
    send(0, request(2, "picture", 700));
    send(1, request(3, "fresh", 1)); // brings one
    send(2, request(0, "known", 2));
    send(0, request(3, "picture", 900));
    send(1, request(4, "known", 3)); // overtakes only that one
    (void)arrived();
    const Messages expected = {{0, request(1, "picture", 500)}, {1, request(2, "picture", 1)},
                               {0, request(2, "picture", 700)}, {1, request(3, "fresh", 1)},
                               {2, request(0, "known", 2)},     {1, request(4, "known", 3)},
                               {0, request(3, "picture", 900)}};
    EXPECT_EQ(b.received, expected);
}

TEST_P(FullOvertaking, ManyShortOnesLeaveTheLongOneHalf) {
    send(0, Bytes(800, 1));
    EXPECT_TRUE(until(
        [&] {
            if (a.send(1, Bytes(80, 2), tag_) == LINK_OK)
                ++tag_;
            return b.received.size() && b.received.back().first == 0;
        },
        5'000'000));
    EXPECT_LE(b.received.size(), 12u); // as many as it has fragments
    EXPECT_GE(b.received.size(), 6u);
}

TEST_P(FullOvertaking, InBadWeatherEachChannelKeepsItsOrder) {
    setWeather({0.2, 0.05, 0.02});
    Messages sent[3], came[3];
    std::map<Bytes, uint32_t> numbers;
    uint32_t overtook = 0, newest = 0, ids[3][3] = {{1, 1, 1}, {1, 1, 1}};
    EXPECT_TRUE(until(
        [&] {
            const int channel = static_cast<int>(random.below(3));
            const size_t size = random.below(4) ? 2 + random.below(60) : 900;
            Bytes m(size, static_cast<uint8_t>(tag_));
            m[1] = static_cast<uint8_t>(tag_ >> 8);
            const uint32_t kind = random.below(3); // two of them with a number that is left out
            if (kind == 0)
                m = IceMessages::request(ids[0][channel], "uav",
                                         random.below(9) ? "known" : std::to_string(tag_), m);
            else if (kind == 1)
                m = IceMessages::reply(ids[1][channel], m);
            if (tag_ < 2000 && a.send(channel, m, tag_) == LINK_OK) {
                sent[channel].emplace_back(channel, m);
                numbers[m] = tag_++;
                ++ids[kind][channel];
            }
            b.refuse = random.below(3) == 0;
            return tag_ == 2000;
        },
        600'000'000));
    b.refuse = false;
    (void)arrived();
    for (auto& message : b.received) {
        const uint32_t which = numbers.at(message.second);
        overtook += which < newest;
        newest = std::max(newest, which);
        came[message.first].push_back(message);
    }
    for (int channel : {0, 1, 2})
        EXPECT_EQ(came[channel], sent[channel]) << "channel " << channel;
    EXPECT_GT(overtook, 20u);
}

INSTANTIATE_TEST_SUITE_P(Peers, FullOvertaking,
                         ::testing::Values(Variant{"full", "full", false},
                                           Variant{"full", "full", true},
                                           Variant{"full", "small", false},
                                           Variant{"full", "open", false}));

TEST_P(Overtaking, NothingOvertakesTowardsTheMinimalLayer) {
    send(0, Bytes(900, 1));
    run(100'000);
    send(1, Bytes(10, 2));
    EXPECT_EQ(arrived(), (Arrived{{0, 900}, {1, 10}}));
}

INSTANTIATE_TEST_SUITE_P(Peers, Overtaking,
                         ::testing::Values(Variant{"full", "minimal", false},
                                           Variant{"full", "minimal", true}));

} // namespace
