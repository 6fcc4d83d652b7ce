// SPDX-License-Identifier: MIT
//
// link_test: sessions, channels and messages of two link layers, one fault at a time.

#include "link_pair.h"
#include <gtest/gtest.h>

namespace {

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
    // The check of each takes two more bytes; short messages have a reserve.
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

// 10^7 random bytes in a session, between messages: no fault, and the link goes on.
// BYTES=1000000 takes less.
TEST(LinkLayer, TenMillionRandomBytesAreSurvived) {
    const char* given = std::getenv("BYTES");
    const unsigned long bytes = given ? std::strtoul(given, nullptr, 0) : 10'000'000;
    Pair pair(testSeed());
    ASSERT_TRUE(pair.connect());
    Link_start(pair.b.link(), pair.now32());
    Random random(testSeed());
    Side::Bytes noise(10000), hello = {'h', 'i'};
    for (unsigned long done = 0; done < bytes; done += noise.size()) {
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
    std::printf("link layer: %lu bytes of noise in a session, it works\n", bytes);
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

// The time of the last PING has become so old that it would read as a future time.
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

// Answers faster than modems mean a wire, which needs no turns.
TEST(LinkLayer, OverAWireACallWaitsForNoTurn) {
    Pair pair(testSeed());
    pair.setWeather({0, 0, 0, 0});
    ASSERT_TRUE(pair.connect());
    Link_openChannel(pair.a.link(), 0);
    pair.run(100'000);
    const Side::Bytes call(2, 7);
    auto take =
        [&](unsigned calls) { // calls one after the other, each answered; returns microseconds
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
    take(20); // now both know the way's speed
    EXPECT_LE(take(20), 20 * 12'000u);
}

} // namespace
