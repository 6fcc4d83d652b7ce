// SPDX-License-Identifier: MIT
//
// link_test: the link layer over a bad radio: nothing wrong, doubled, out of order or unreported.

#include "link_pair.h"
#include <cstdlib>
#include <gtest/gtest.h>

namespace {

Side::Bytes pattern(uint32_t id, uint32_t size) {
    Side::Bytes bytes(size);
    for (uint32_t i = 0; i < size; ++i)
        bytes[i] = static_cast<uint8_t>((id * 2654435761u >> (i % 4 * 8)) + i);
    return bytes;
}

// Sends messages both ways while time passes; checks order, content and outcomes at the end.
class Traffic {
public:
    Traffic(Pair& pair, uint64_t seed, uint32_t maxSize)
        : pair_(pair), random_(seed), maxSize_(maxSize) {}

    void offer(Side& from, std::vector<std::pair<uint32_t, Side::Bytes>>& sent) {
        uint32_t id = static_cast<uint32_t>(sent.size());
        Side::Bytes bytes = pattern(id, 1 + random_.below(maxSize_));
        int channel = static_cast<int>(random_.below(4));
        Link_Status status =
            Link_send(from.link(), channel, bytes.data(), static_cast<U32>(bytes.size()), id);
        if (status == LINK_OK)
            sent.emplace_back(channel, std::move(bytes));
        else if (status == LINK_CLOSED) // a new session
            Link_openChannel(from.link(), channel);
    }

    void run(unsigned messages, uint64_t limitUs) {
        pair_.runUntil(
            [&] {
                if (sentA.size() < messages)
                    offer(pair_.a, sentA);
                if (sentB.size() < messages)
                    offer(pair_.b, sentB);
                return sentA.size() >= messages && sentB.size() >= messages &&
                       pair_.a.outcomes.size() == messages && pair_.b.outcomes.size() == messages;
            },
            limitUs);
    }

    // Every message is reported; what was received is a part of what was sent, on each channel in
    // order, unchanged, and holds everything reported as delivered.
    static void check(const std::vector<std::pair<uint32_t, Side::Bytes>>& sent, const Side& sender,
                      const Side& receiver) {
        ASSERT_EQ(sender.outcomes.size(), sent.size()) << "messages not reported";
        std::deque<Side::Bytes> received[LINK_CHANNELS];
        for (auto& [channel, bytes] : receiver.received)
            received[channel].push_back(bytes);
        for (size_t i = 0; i < sent.size(); ++i) {
            auto& here = received[sent[i].first];
            bool arrived = !here.empty() && here.front() == sent[i].second;
            if (arrived)
                here.pop_front();
            if (sender.outcomes.at(static_cast<uint32_t>(i)) == LINK_DELIVERED) {
                EXPECT_TRUE(arrived) << "message " << i << " was reported delivered";
            }
        }
        for (auto& left : received)
            EXPECT_TRUE(left.empty()) << left.size() << " messages doubled, wrong or out of order";
    }

    std::vector<std::pair<uint32_t, Side::Bytes>> sentA, sentB;

private:
    Pair& pair_;
    Random random_;
    uint32_t maxSize_;
};

class LinkSeeds : public ::testing::TestWithParam<int> {
protected:
    uint64_t seed_ = testSeed() * 1000 + static_cast<uint64_t>(GetParam());
    // Every second one with a key.
    Pair pair_{seed_, Side::Bytes(GetParam() % 2 ? LINK_KEY_BYTES : 0, 0x5A)};
};

TEST(LinkLayer, HandshakeBringsBothSidesUpAndChannelsOpenInOrder) {
    Pair pair(testSeed());
    ASSERT_TRUE(pair.connect());
    Link_openChannel(pair.a.link(), 1);
    Side::Bytes hello = {'h', 'i'};
    Link_send(pair.a.link(), 1, hello.data(), 2, 7);
    Link_closeChannel(pair.a.link(), 1);
    ASSERT_TRUE(pair.runUntil([&] { return pair.a.outcomes.count(7) != 0; }, 1000000));
    ASSERT_EQ(pair.b.received.size(), 1u);
    EXPECT_EQ(pair.b.received[0].second, hello);
    EXPECT_EQ(pair.b.events, (std::vector<std::string>{"up", "open 1", "close 1"}));
}

TEST(LinkLayer, BothSidesMayStartAtOnce) {
    Pair pair(testSeed());
    Link_start(pair.b.link(), pair.now32());
    ASSERT_TRUE(pair.connect());
    pair.run(3000000);
    EXPECT_TRUE(pair.bothUp());
    EXPECT_EQ(Link_statistics(pair.a.link())->sessions, 1u);
    EXPECT_EQ(Link_statistics(pair.b.link())->sessions, 1u);
}

TEST(LinkLayer, SizesAreChecked) {
    Pair pair(testSeed());
    Side::Bytes big(LINK_MAX_MESSAGE + 1);
    EXPECT_EQ(Link_send(pair.a.link(), 0, big.data(), 5, 0), LINK_DOWN);
    ASSERT_TRUE(pair.connect());
    ASSERT_EQ(Link_openChannel(pair.a.link(), 0), LINK_OK);
    EXPECT_EQ(Link_send(pair.a.link(), 0, big.data(), LINK_MAX_MESSAGE + 1, 0), LINK_TOO_LONG);
    EXPECT_EQ(Link_send(pair.a.link(), 0, big.data(), 0, 0), LINK_TOO_LONG);
    for (int channel : {-1, LINK_CHANNELS}) {
        EXPECT_EQ(Link_send(pair.a.link(), channel, big.data(), 1, 0), LINK_CLOSED);
        EXPECT_EQ(Link_openChannel(pair.a.link(), channel), LINK_CLOSED);
        EXPECT_EQ(Link_closeChannel(pair.a.link(), channel), LINK_CLOSED);
    }
    EXPECT_EQ(Link_send(pair.a.link(), 0, big.data(), LINK_MAX_MESSAGE, 0), LINK_OK);
    // Each takes two bytes more, its check; short messages have a reserve.
    const U32 rest = LINK_SEND_BYTES - LINK_RESERVE - LINK_MAX_MESSAGE - 4;
    EXPECT_EQ(Link_send(pair.a.link(), 0, big.data(), rest + 1, 1), LINK_FULL);
    EXPECT_EQ(Link_send(pair.a.link(), 0, big.data(), rest, 1), LINK_OK);
    EXPECT_EQ(Link_send(pair.a.link(), 0, big.data(), LINK_MAX_PAYLOAD + 1, 2), LINK_FULL);
    for (U32 left = LINK_RESERVE, tag = 2; left; ++tag, left -= std::min(left, 20u))
        EXPECT_EQ(Link_send(pair.a.link(), 0, big.data(), std::min(left, 20u), tag), LINK_OK);
    EXPECT_EQ(Link_send(pair.a.link(), 0, big.data(), 1, 2), LINK_FULL);
    ASSERT_TRUE(pair.runUntil([&] { return pair.a.outcomes.size() == 15; }, 10000000));
    EXPECT_EQ(pair.b.received[0].second.size(), LINK_MAX_MESSAGE);
    EXPECT_EQ(pair.b.received[1].second.size(), rest);
}

TEST(LinkLayer, AChannelThatNobodyHasOpenedIsRefused) {
    Pair pair(testSeed());
    const U8 byte = 1;
    ASSERT_TRUE(pair.connect());
    EXPECT_EQ(Link_send(pair.a.link(), 1, &byte, 1, 0), LINK_CLOSED);
    EXPECT_EQ(Link_closeChannel(pair.a.link(), 1), LINK_CLOSED);
    ASSERT_EQ(Link_openChannel(pair.a.link(), 1), LINK_OK);
    EXPECT_EQ(Link_send(pair.a.link(), 1, &byte, 1, 1), LINK_OK);
    EXPECT_EQ(Link_send(pair.b.link(), 1, &byte, 1, 2), LINK_CLOSED); // not there yet
    ASSERT_TRUE(pair.runUntil([&] { return pair.a.outcomes.count(1) != 0; }, 1000000));
    EXPECT_EQ(Link_send(pair.b.link(), 1, &byte, 1, 3), LINK_OK);
    Link_closeChannel(pair.a.link(), 1);
    EXPECT_EQ(Link_send(pair.a.link(), 1, &byte, 1, 4), LINK_CLOSED);
    pair.run(300000);
    EXPECT_EQ(Link_send(pair.b.link(), 1, &byte, 1, 5), LINK_CLOSED);
    EXPECT_EQ(pair.b.received.size(), 1u);
}

// Small messages, as many as the link carries: sequence numbers wrap hundreds of times.
// MESSAGES=100000 sends more.
TEST(LinkLayer, TenThousandMessagesAtSpeedInBadWeather) {
    const char* more = std::getenv("MESSAGES");
    const unsigned messages = more ? static_cast<unsigned>(std::atoi(more)) : 10000;
    Pair pair(testSeed());
    ASSERT_TRUE(pair.connect());
    pair.setWeather({0.05, 0.05, 0.02, 8000});
    Traffic traffic(pair, testSeed(), 40);
    traffic.run(messages, uint64_t(messages) * 1000000);
    ASSERT_EQ(traffic.sentA.size(), messages);
    ASSERT_EQ(traffic.sentB.size(), messages);
    Traffic::check(traffic.sentA, pair.a, pair.b);
    Traffic::check(traffic.sentB, pair.b, pair.a);
    EXPECT_EQ(pair.a.received.size(), messages);
    EXPECT_EQ(pair.b.received.size(), messages);
}

TEST_P(LinkSeeds, NothingIsLostDoubledOrReorderedInBadWeather) {
    ASSERT_TRUE(pair_.connect());
    pair_.setWeather({0.1, 0.05, 0.02, 8000});
    Traffic traffic(pair_, seed_, 400);
    traffic.run(300, 600000000);
    Traffic::check(traffic.sentA, pair_.a, pair_.b);
    Traffic::check(traffic.sentB, pair_.b, pair_.a);
    for (auto& [tag, outcome] : pair_.a.outcomes)
        EXPECT_EQ(outcome, LINK_DELIVERED) << tag;
}

TEST_P(LinkSeeds, RebootsAreNoticedAndMessagesInFlightReported) {
    ASSERT_TRUE(pair_.connect());
    Link_start(pair_.b.link(), pair_.now32());
    pair_.setWeather({0.05, 0.05, 0.01, 8000});
    Random random(seed_ + 7);
    Traffic traffic(pair_, seed_, 300);
    for (int round = 0; round < 6; ++round) {
        traffic.run(static_cast<unsigned>(40 * (round + 1)), 3000000 + random.below(3000000));
        // A reboot forgets what was in flight: as the application would, count it as unknown.
        Side& side = random.below(2) ? pair_.a : pair_.b;
        auto& sent = &side == &pair_.a ? traffic.sentA : traffic.sentB;
        side.boot();
        for (uint32_t i = 0; i < sent.size(); ++i)
            side.outcomes.emplace(i, LINK_UNKNOWN);
        Link_start(side.link(), pair_.now32());
        ASSERT_TRUE(pair_.runUntil([&] { return pair_.bothUp(); }, 60000000)) << "round " << round;
    }
    traffic.run(240, 600000000);
    Traffic::check(traffic.sentA, pair_.a, pair_.b);
    Traffic::check(traffic.sentB, pair_.b, pair_.a);
}

TEST_P(LinkSeeds, GarbageOnTheLineDoesNotDisturbTheSession) {
    ASSERT_TRUE(pair_.connect());
    Traffic traffic(pair_, seed_, 200);
    Random random(seed_ + 3);
    for (int i = 0; i < 60; ++i) {
        Side::Bytes noise(1 + random.below(150));
        for (auto& byte : noise)
            byte = static_cast<uint8_t>(random.next());
        Link_receive(pair_.b.link(), noise.data(), static_cast<U32>(noise.size()), pair_.now32());
        traffic.run(static_cast<unsigned>(3 * (i + 1)), 200000);
    }
    traffic.run(180, 100000000);
    Traffic::check(traffic.sentA, pair_.a, pair_.b);
    Traffic::check(traffic.sentB, pair_.b, pair_.a);
    EXPECT_GT(Link_statistics(pair_.b.link())->crcErrors, 0u);
}

// 10^7 random bytes in a session, between messages: no fault, and the link goes on.
TEST(LinkLayer, TenMillionRandomBytesAreSurvived) {
    Pair pair(testSeed());
    ASSERT_TRUE(pair.connect());
    Link_start(pair.b.link(), pair.now32());
    Random random(testSeed());
    Side::Bytes noise(10000), hello = {'h', 'i'};
    for (int i = 0; i < 1000; ++i) {
        for (auto& byte : noise)
            byte = static_cast<uint8_t>(random.next());
        Link_receive(pair.b.link(), noise.data(), static_cast<U32>(noise.size()), pair.now32());
        pair.run(2000);
    }
    ASSERT_TRUE(pair.runUntil([&] { return pair.bothUp(); }, 60000000)) << "seed " << testSeed();
    pair.run(1000000);
    pair.b.received.clear();
    ASSERT_TRUE(pair.runUntil(
        [&] {
            if (Link_send(pair.a.link(), 2, hello.data(), 2, 1u << 30) == LINK_OK)
                return true;
            Link_openChannel(pair.a.link(), 2);
            return false;
        },
        60000000));
    ASSERT_TRUE(pair.runUntil([&] { return !pair.b.received.empty(); }, 60000000));
    EXPECT_EQ(pair.b.received.back().second, hello);
    std::printf("link layer: 10000000 bytes of noise in a session, it works\n");
}

INSTANTIATE_TEST_SUITE_P(Seeds, LinkSeeds, ::testing::Range(0, 8));

// A wrong message whose CRC-16 is right, which comes once in 65,536 times: here at once, by adding
// the polynomial.
TEST(LinkLayer, AWrongMessageWithARightChecksumIsReportedAndNotDelivered) {
    for (uint32_t size : {20u, 60u, 95u, 300u}) {
        Pair pair(testSeed());
        ASSERT_TRUE(pair.connect());
        ASSERT_EQ(Link_openChannel(pair.a.link(), 0), LINK_OK);
        pair.run(1000000);
        Side::Bytes bytes = pattern(size, size);
        ASSERT_EQ(Link_send(pair.a.link(), 0, bytes.data(), size, 7), LINK_OK);
        pair.runUntil([&] { return !pair.a.air.empty() && pair.a.air[0].bytes.size() >= 20; },
                      1000000);
        ASSERT_FALSE(pair.a.air.empty());
        const uint8_t polynomial[] = {0x01, 0x10, 0x21};
        for (size_t i = 0; i < sizeof polynomial; ++i)
            pair.a.air[0].bytes[10 + i] ^= polynomial[i];
        pair.run(30000000);
        EXPECT_TRUE(pair.b.received.empty()) << size << " bytes";
        EXPECT_EQ(pair.a.outcomes.at(7), LINK_UNKNOWN) << size << " bytes";
    }
}

TEST(LinkLayer, AVanishedPeerIsNoticedAndAReturningOneFound) {
    Pair pair(testSeed());
    ASSERT_TRUE(pair.connect());
    pair.setWeather({1.0, 0, 0, 8000});
    Side::Bytes bytes = {1, 2, 3};
    Link_openChannel(pair.a.link(), 0);
    Link_send(pair.a.link(), 0, bytes.data(), 3, 1);
    ASSERT_TRUE(pair.runUntil([&] { return !pair.a.outcomes.empty(); }, 20000000));
    EXPECT_EQ(pair.a.outcomes[1], LINK_UNKNOWN);
    EXPECT_EQ(Link_state(pair.a.link()), LINK_STATE_CONNECTING);
    pair.setWeather({});
    EXPECT_TRUE(pair.runUntil([&] { return pair.bothUp(); }, 20000000));
    EXPECT_TRUE(pair.b.received.empty());
}

// The time of the last PING is by then so old that it would read as a future one.
TEST(LinkLayer, ASilenceAfterFortyMinutesOfTrafficIsAskedAbout) {
    Pair pair(testSeed());
    ASSERT_TRUE(pair.connect());
    ASSERT_EQ(Link_openChannel(pair.a.link(), 0), LINK_OK);
    const U8 byte = 1;
    for (U32 tag = 0; tag < 800; ++tag) {
        Link_send(pair.a.link(), 0, &byte, 1, tag);
        pair.run(3000000);
    }
    pair.run(15000000);
    EXPECT_EQ(Link_statistics(pair.a.link())->sessions, 1u);
    EXPECT_EQ(Link_statistics(pair.b.link())->sessions, 1u);
    EXPECT_TRUE(pair.bothUp());
}

TEST(LinkLayer, AMessageThatIsNotTakenWaitsAndStopsTheSender) {
    Pair pair(testSeed());
    ASSERT_TRUE(pair.connect());
    pair.b.refuse = true;
    Side::Bytes bytes(1000, 5);
    Link_openChannel(pair.a.link(), 0);
    for (U32 tag = 0; tag < 10; ++tag)
        Link_send(pair.a.link(), 0, bytes.data(), 1000, tag);
    pair.run(7000000);
    EXPECT_TRUE(pair.bothUp());
    EXPECT_TRUE(pair.b.received.empty());
    pair.b.refuse = false;
    ASSERT_TRUE(pair.runUntil([&] { return pair.a.outcomes.size() == 10; }, 20000000));
    EXPECT_EQ(pair.b.received.size(), 10u);
}

TEST(LinkLayer, ALateMessageDoesNotReachTheNextConnection) {
    Pair pair(testSeed());
    const U8 byte = 1;
    ASSERT_TRUE(pair.connect());
    ASSERT_EQ(Link_openChannel(pair.a.link(), 1), LINK_OK);
    pair.run(300000);
    ASSERT_EQ(Link_send(pair.b.link(), 1, &byte, 1, 0), LINK_OK);
    ASSERT_EQ(Link_closeChannel(pair.a.link(), 1), LINK_OK);
    EXPECT_EQ(Link_openChannel(pair.a.link(), 1), LINK_FULL);
    pair.run(300000);
    EXPECT_EQ(Link_openChannel(pair.a.link(), 1), LINK_OK);
    pair.run(300000);
    EXPECT_TRUE(pair.a.received.empty());
}

TEST(LinkLayer, AClosingWaitsForRoomAndIsNotLost) {
    Pair pair(testSeed());
    const U8 byte = 1;
    ASSERT_TRUE(pair.connect());
    ASSERT_EQ(Link_openChannel(pair.a.link(), 1), LINK_OK);
    pair.run(300000);
    unsigned sent = 0;
    while (Link_send(pair.a.link(), 1, &byte, 1, sent) == LINK_OK)
        ++sent;
    EXPECT_EQ(Link_closeChannel(pair.a.link(), 1), LINK_OK);
    EXPECT_EQ(Link_closeChannel(pair.a.link(), 1), LINK_CLOSED);
    pair.run(600000);
    EXPECT_EQ(pair.b.received.size(), sent);
    EXPECT_EQ(pair.b.events.back(), "close 1");
    EXPECT_EQ(Link_openChannel(pair.a.link(), 1), LINK_OK);
}

TEST(LinkLayer, StopTellsThePeer) {
    Pair pair(testSeed());
    ASSERT_TRUE(pair.connect());
    Link_stop(pair.a.link(), pair.now32());
    pair.run(200000);
    EXPECT_EQ(Link_state(pair.b.link()), LINK_STATE_IDLE);
    EXPECT_EQ(pair.b.events.back(), "idle");
}

// Goodput of one direction as a share of the modem's 10,000 bytes/s (docs/link.md): the layer paces
// itself by the modem, though the radio here takes whatever comes.
double goodput(double loss, uint64_t seed) {
    Pair pair(seed);
    EXPECT_TRUE(pair.connect());
    pair.setWeather({loss, 0, 0, 8000});
    Side::Bytes bytes(950, 1);
    Link_openChannel(pair.a.link(), 0);
    const uint64_t start = pair.nowUs;
    uint32_t tag = 0;
    pair.runUntil(
        [&] {
            while (Link_send(pair.a.link(), 0, bytes.data(), 950, tag) == LINK_OK)
                ++tag;
            return pair.a.outcomes.size() >= 300;
        },
        1000000000);
    double seconds = static_cast<double>(pair.nowUs - start) / 1e6;
    return 300.0 * 950 / seconds / 10000;
}

// Answers that come sooner than modems can bring them tell of a wire, which needs no turns.
TEST(LinkLayer, OverAWireACallWaitsForNoTurn) {
    Pair pair(testSeed());
    pair.setWeather({0, 0, 0, 0});
    ASSERT_TRUE(pair.connect());
    Link_openChannel(pair.a.link(), 0);
    pair.run(100'000);
    const Side::Bytes call(2, 7);
    auto take = [&](unsigned calls) { // one behind the other, each answered; returns us
        const uint64_t start = pair.nowUs;
        for (unsigned i = 0; i < calls; ++i)
            for (auto [from, to] : {std::pair(&pair.a, &pair.b), std::pair(&pair.b, &pair.a)}) {
                const size_t arrived = to->received.size();
                Link_send(from->link(), 0, call.data(), 2, static_cast<U32>(pair.nowUs));
                EXPECT_TRUE(
                    pair.runUntil([&] { return to->received.size() > arrived; }, 1'000'000));
            }
        return pair.nowUs - start;
    };
    take(20); // and both know the way
    EXPECT_LE(take(20), 20 * 12'000u);
}

TEST(LinkLayer, GoodputMeetsItsTargets) {
    const double targets[][2] = {{0, 0.83}, {0.01, 0.81}, {0.1, 0.68}, {0.3, 0.42}};
    for (auto& [loss, target] : targets) {
        double share = goodput(loss, testSeed());
        std::printf("loss %4.0f %%: goodput %.1f %% of the limit (target %.0f %%)\n", loss * 100,
                    share * 100, target * 100);
        EXPECT_GE(share, target) << "loss " << loss;
    }
}

} // namespace
