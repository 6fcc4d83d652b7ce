// SPDX-License-Identifier: MIT
//
// link_test: tests sessions, channels and messages, with one fault at a time. The ground station
// has the full layer. The vehicle has the full layer, unencrypted or with a key, or the minimal
// layer.

#include "link_variants.h"

namespace {

class LinkLayer : public Variants {};

TEST_P(LinkLayer, ChannelsOpenAndCloseFromBothSidesInOrder) {
    ASSERT_TRUE(connect());
    ASSERT_EQ(a.open(1), LINK_OK);
    ASSERT_EQ(a.send(1, {1}, 1), LINK_OK);
    ASSERT_EQ(a.close(1), LINK_OK);
    ASSERT_EQ(b.open(3), LINK_OK);
    ASSERT_EQ(b.send(3, Bytes(300, 2), 2), LINK_OK);
    if (isMinimal()) {
        // the channel cannot be closed yet, because its opening has not been sent
        EXPECT_EQ(b.close(3), LINK_FULL);
    }
    ASSERT_TRUE(until([&] { return b.close(3) == LINK_OK; }, 1'000'000));
    ASSERT_TRUE(until([&] { return b.outcomes.count(2) && a.outcomes.count(1); }, 2'000'000));
    run(300'000);
    EXPECT_EQ(b.events, (std::vector<std::string>{"up", "open 1", "close 1"}));
    EXPECT_EQ(a.events, (std::vector<std::string>{"connecting", "up", "open 3", "close 3"}));
    EXPECT_EQ(a.received, (Messages{{3, Bytes(300, 2)}}));
    EXPECT_EQ(b.received, (Messages{{1, {1}}}));
    EXPECT_EQ(a.open(1), LINK_OK); // both sides have reported that the channel is closed
    EXPECT_EQ(b.open(3), LINK_OK);
}

TEST_P(LinkLayer, BothSidesMayStartAtOnce) {
    b.start();
    ASSERT_TRUE(connect());
    run(3'000'000);
    EXPECT_TRUE(bothUp());
    EXPECT_EQ(a.sessions(), 1u);
    EXPECT_EQ(b.sessions(), 1u);
}

TEST_P(LinkLayer, InvalidArgumentsAreRefused) {
    const Link_Status none = isMinimal() ? LINK_CLOSED : LINK_DOWN;
    EXPECT_EQ(b.open(0), LINK_DOWN);
    EXPECT_EQ(b.send(0, {1}, 0), none);
    ASSERT_TRUE(connect());
    EXPECT_EQ(b.send(0, {1}, 0), LINK_CLOSED);
    EXPECT_EQ(b.close(0), LINK_CLOSED);
    for (int channel : {-1, LINK_CHANNELS}) {
        EXPECT_EQ(b.open(channel), isMinimal() ? LINK_DOWN : LINK_CLOSED);
        EXPECT_EQ(b.close(channel), LINK_CLOSED);
        EXPECT_EQ(b.send(channel, {1}, 0), LINK_CLOSED);
    }
    ASSERT_EQ(b.open(0), LINK_OK);
    EXPECT_EQ(b.send(0, Bytes(b.layer.maxMessage + 1), 0), LINK_TOO_LONG);
    EXPECT_EQ(b.send(0, {}, 0), LINK_TOO_LONG);
    EXPECT_EQ(b.send(0, Bytes(b.layer.maxMessage), 1), LINK_OK);
    if (isMinimal()) {
        EXPECT_EQ(b.send(0, {1}, 2), LINK_FULL);
    }
    ASSERT_TRUE(until([&] { return b.outcomes.count(1) != 0; }, 10'000'000));
    EXPECT_EQ(a.received[0].second.size(), b.layer.maxMessage);
}

TEST_P(LinkLayer, AClosedChannelIsRefused) {
    ASSERT_TRUE(connect());
    EXPECT_EQ(a.send(1, {1}, 0), LINK_CLOSED);
    EXPECT_EQ(a.close(1), LINK_CLOSED);
    ASSERT_EQ(a.open(1), LINK_OK);
    EXPECT_EQ(a.send(1, {1}, 1), LINK_OK);
    EXPECT_EQ(b.send(1, {1}, 2), LINK_CLOSED); // the channel is not connected yet
    ASSERT_TRUE(until([&] { return a.outcomes.count(1) != 0; }, 1'000'000));
    EXPECT_EQ(b.send(1, {1}, 3), LINK_OK);
    a.close(1);
    EXPECT_EQ(a.send(1, {1}, 4), LINK_CLOSED);
    run(300'000);
    EXPECT_EQ(b.send(1, {1}, 5), LINK_CLOSED);
    EXPECT_EQ(b.received.size(), 1u);
}

// Random bytes arrive during a session, between messages. Nothing may fail, and the link must
// continue. BYTES is the number of these bytes for the full layer without a key; other layers get a
// million.
TEST_P(LinkLayer, TenMillionRandomBytesDoNoHarm) {
    const double most = numberFromEnvironment("BYTES", 10'000'000);
    const auto bytes =
        static_cast<unsigned long>(isMinimal() || GetParam().hasKey ? 1'000'000 : most);
    ASSERT_TRUE(connect());
    b.start();
    Bytes noise(isMinimal() ? 1000 : 10'000);
    for (unsigned long done = 0; done < bytes; done += noise.size()) {
        for (auto& byte : noise)
            byte = static_cast<uint8_t>(random.next());
        b.receive(noise);
        run(2000);
    }
    ASSERT_TRUE(until([&] { return bothUp(); }, 60'000'000)) << "seed " << testSeed();
    run(1'000'000);
    b.received.clear();
    ASSERT_TRUE(until(
        [&] {
            a.open(2);
            return a.send(2, {'h', 'i'}, 9) == LINK_OK;
        },
        60'000'000));
    ASSERT_TRUE(until([&] { return !b.received.empty(); }, 60'000'000));
    EXPECT_EQ(b.received.back().second, (Bytes{'h', 'i'}));
    std::printf("link layer: %lu bytes of noise in a session, it works\n", bytes);
}

TEST_P(LinkLayer, ALostPeerIsDetectedAndFoundAgain) {
    ASSERT_TRUE(connect());
    setWeather({1, 0, 0});
    for (Side* side : {&a, &b}) {
        side->open(3);
        EXPECT_EQ(side->send(3, {1, 2, 3}, 1), LINK_OK);
    }
    ASSERT_TRUE(until([&] { return a.outcomes.size() && b.outcomes.size(); }, 30'000'000));
    EXPECT_EQ(a.outcomes[1], LINK_UNKNOWN);
    EXPECT_EQ(b.outcomes[1], LINK_UNKNOWN);
    EXPECT_EQ(a.layer.state(a.link()), LINK_STATE_CONNECTING);
    EXPECT_EQ(b.layer.state(b.link()), LINK_STATE_IDLE);
    EXPECT_EQ(b.deadline(), 0xFFFFFFFFU);
    setWeather({});
    EXPECT_TRUE(until([&] { return bothUp(); }, 20'000'000));
    EXPECT_TRUE(a.received.empty() && b.received.empty());
}

// The reply to the ground's next frame reveals the reboot, so it need not wait for 9 s
// of silence.
TEST_P(LinkLayer, ARestartOfTheVehicleIsDetectedByTheNextFrame) {
    ASSERT_TRUE(connect());
    a.open(0);
    run(100'000);
    b.boot();
    EXPECT_EQ(a.send(0, {1}, 7), LINK_OK);
    ASSERT_TRUE(until([&] { return a.outcomes.count(7) != 0; }, 500'000));
    EXPECT_EQ(a.outcomes[7], LINK_UNKNOWN);
    EXPECT_TRUE(until([&] { return bothUp(); }, 1'000'000));
}

// Traffic keeps the link from sending a PING for more than half of the range of the 32-bit time.
// After that, the time of the last PING must not be taken for a time in the future.
TEST_P(LinkLayer, APeerThatFallsSilentAfterFortyMinutesIsProbed) {
    ASSERT_TRUE(connect());
    ASSERT_EQ(a.open(0), LINK_OK);
    for (U32 tag = 0; tag < 800; ++tag) {
        a.send(0, {1}, tag);
        run(3'000'000);
    }
    run(15'000'000);
    EXPECT_EQ(a.sessions(), 1u);
    EXPECT_EQ(b.sessions(), 1u);
    EXPECT_TRUE(bothUp());
}

TEST_P(LinkLayer, AClosingMessageWaitsForRoomAndIsNotLost) {
    ASSERT_TRUE(connect());
    ASSERT_EQ(a.open(1), LINK_OK);
    run(300'000);
    unsigned sent = 0;
    while (a.send(1, {1}, sent) == LINK_OK)
        ++sent;
    EXPECT_EQ(a.close(1), LINK_OK);
    EXPECT_EQ(a.close(1), LINK_CLOSED);
    run(1'200'000);
    EXPECT_EQ(b.received.size(), sent);
    EXPECT_EQ(b.events.back(), "close 1");
    EXPECT_EQ(a.open(1), LINK_OK);
}

TEST_P(LinkLayer, ALateMessageDoesNotReachTheNextConnection) {
    ASSERT_TRUE(connect());
    ASSERT_EQ(b.open(3), LINK_OK);
    run(300'000);
    ASSERT_EQ(a.send(3, {1}, 0), LINK_OK);
    ASSERT_EQ(b.close(3), LINK_OK);
    EXPECT_EQ(b.open(3), LINK_FULL);
    run(300'000);
    EXPECT_EQ(b.open(3), LINK_OK);
    run(300'000);
    EXPECT_TRUE(b.received.empty());
}

TEST_P(LinkLayer, AMessageThatIsNotAcceptedEndsTheSessionAfter27Seconds) {
    ASSERT_TRUE(connect());
    b.refuse = true;
    a.open(1);
    ASSERT_EQ(a.send(1, {1, 2, 3}, 1), LINK_OK);
    const uint64_t start = now;
    ASSERT_TRUE(until([&] { return !a.outcomes.empty(); }, 30'000'000));
    EXPECT_EQ(a.outcomes[1], LINK_UNKNOWN);
    EXPECT_NEAR(double(now - start), 27e6, 300'000);
    run(1'000'000);
    b.refuse = false;
    run(5'000'000);
    EXPECT_TRUE(b.received.empty());
}

TEST_P(LinkLayer, AMessageThatIsNotAcceptedStopsTheSender) {
    ASSERT_TRUE(connect());
    b.refuse = true;
    a.open(0);
    for (U32 tag = 0; tag < 10; ++tag)
        EXPECT_EQ(a.send(0, Bytes(900, static_cast<uint8_t>(tag)), tag), LINK_OK);
    run(12'000'000);
    EXPECT_TRUE(bothUp());
    EXPECT_TRUE(b.received.empty());
    b.refuse = false;
    ASSERT_TRUE(until([&] { return a.outcomes.size() == 10; }, 30'000'000));
    ASSERT_EQ(b.received.size(), 10u);
    for (uint8_t tag = 0; tag < 10; ++tag)
        EXPECT_EQ(b.received[tag].second, Bytes(900, tag));
}

TEST_P(LinkLayer, StopNotifiesThePeer) {
    ASSERT_TRUE(connect());
    run(100'000);
    b.stop();
    run(15'000);
    EXPECT_EQ(a.events.back(), "connecting");
    // the ground still calls, so a new session begins
    ASSERT_TRUE(until([&] { return bothUp(); }, 1'000'000));
    a.stop();
    run(15'000);
    EXPECT_EQ(b.events.back(), "idle");
    run(1'000'000);
    EXPECT_FALSE(b.isUp());
}

INSTANTIATE_TEST_SUITE_P(Vehicles, LinkLayer, ::testing::ValuesIn(vehicles(1)));

class MinimalLayer : public Variants {};

// The link must also work if Link_poll is called only at the times that Link_deadline returns.
TEST_P(MinimalLayer, TheDeadlineIsTheTimeOfTheNextAction) {
    ASSERT_TRUE(connect());
    ASSERT_EQ(b.open(3), LINK_OK);
    EXPECT_LE(b.deadline(), 1000u);
    run(100'000);
    EXPECT_GT(b.deadline(), 1'000'000u); // time until the ground is considered silent
    setWeather({1, 0, 0});
    ASSERT_EQ(b.send(3, {1}, 1), LINK_OK);
    run(2000);
    // time until the frame is sent again; that happens after 144 ms
    EXPECT_GT(b.deadline(), 100'000u);
    EXPECT_LE(b.deadline(), 144'000u);
}

INSTANTIATE_TEST_SUITE_P(Vehicles, MinimalLayer,
                         ::testing::Values(Variant{"full", "minimal", false}));

// Tests with layers that end sessions after 60 fragments in one direction, or after 50 wrong tags.
class Limits : public Variants {
protected:
    Limits() { usualSize = longestSize = 40; } // one fragment
    static size_t delivered(const Side& side) {
        return static_cast<size_t>(
            std::count_if(side.outcomes.begin(), side.outcomes.end(),
                          [](auto& tagged) { return tagged.second == LINK_DELIVERED; }));
    }
    // Sends messages until at least `least` of them have been delivered in each direction. If
    // messages are reported lost, ten more are sent.
    template <class... Meanwhile> void deliver(size_t least, Meanwhile... meanwhile) {
        for (size_t most = least; delivered(a) < least || delivered(b) < least; most += 10) {
            ASSERT_LT(most, 4 * least);
            ASSERT_TRUE(traffic(most, 600'000'000, meanwhile...));
        }
        checkBoth();
    }
};

TEST_P(Limits, ASessionEndsAtTheLastNumberWithoutLoss) {
    ASSERT_TRUE(connect());
    deliver(150);
    EXPECT_GE(a.sessions(), 3u);
    EXPECT_GE(b.sessions(), 3u);
}

TEST_P(Limits, TooManyWrongTagsRestartTheSession) {
    Bytes frame;
    ASSERT_TRUE(connect());
    a.open(1);
    ASSERT_TRUE(until([&] { return a.send(1, {1, 2, 3}, 1000) == LINK_OK; }, 1'000'000));
    ASSERT_TRUE(until(
        [&] {
            if (!a.air.empty())
                frame = framesOf(a.air.back().bytes).back();
            return a.outcomes.erase(1000) != 0;
        },
        1'000'000));
    b.received.clear();
    frame.back() ^= 1;
    unsigned guesses = 0;
    for (; b.isUp() && guesses < 200; ++guesses) {
        now += 100'000; // waits until the bytes of an incomplete frame have been dropped
        b.poll();
        b.receive(frame);
        b.poll();
    }
    // one wrong frame may count several times, because the receiver also searches for frames inside
    // it
    EXPECT_GT(guesses, 20u);
    EXPECT_LE(guesses, 50u);
    deliver(20);
    EXPECT_EQ(a.sessions(), 2u);
    EXPECT_EQ(b.sessions(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Vehicles, Limits, ::testing::Values(Variant{"limits", "limits", true}));

TEST(FullLayer, LinksOnOneRadioShareTheLimitOfPacketsInFlight) {
    struct Program : LinkProgram {
        bool transmit(const U8*, U32) override { return ++packets; }
        U32 random() override { return 7; }
        unsigned packets = 0;
    } programs[2];
    std::vector<Link> links(2);
    std::vector<Link_Buffers> buffers(2);
    const auto poll = [&](U32 now) {
        for (Link& link : links)
            Link_poll(&link, now);
        return std::vector<unsigned>{programs[0].packets, programs[1].packets};
    };
    for (size_t i = 0; i < 2; ++i) {
        const Link_Config config = {Program::linkPort(), programs[i].linkProgram(), 1440,
                                    LINK_USE(buffers[i])};
        Link_init(&links[i], &config);
        Link_shareRadio(&links[i], &links[0]);
        Link_expectAnswers(&links[i], 1);
        Link_start(&links[i], 0);
    }
    EXPECT_EQ(poll(0), (std::vector<unsigned>{1, 0})); // each calls
    Link_answer(&links[1], 1, 1000);                   // the answer to the packet of the first link
    EXPECT_EQ(poll(1000), (std::vector<unsigned>{1, 1}));
    // the first link wants to call again, but must wait for the answer to the second link's packet
    EXPECT_EQ(poll(400'000), (std::vector<unsigned>{1, 1}));
    Link_answer(&links[0], 0, 400'000);
    EXPECT_EQ(poll(400'000), (std::vector<unsigned>{2, 1}));
}

TEST(FullLayer, TheQueueReservesRoomForShortMessages) {
    LinkPair pair(testSeed());
    ASSERT_TRUE(pair.connect());
    ASSERT_EQ(pair.a.open(0), LINK_OK);
    EXPECT_EQ(pair.a.send(0, Bytes(LINK_MAX_MESSAGE), 0), LINK_OK);
    // Each message needs two more bytes, for its checksum.
    const U32 rest = LINK_SEND_BYTES - LINK_RESERVE - LINK_MAX_MESSAGE - 4;
    EXPECT_EQ(pair.a.send(0, Bytes(rest + 1), 1), LINK_FULL);
    EXPECT_EQ(pair.a.send(0, Bytes(rest), 1), LINK_OK);
    EXPECT_EQ(pair.a.send(0, Bytes(LINK_MAX_PAYLOAD + 1), 2), LINK_FULL);
    for (U32 left = LINK_RESERVE, tag = 2; left; ++tag, left -= std::min(left, 20u))
        EXPECT_EQ(pair.a.send(0, Bytes(std::min(left, 20u)), tag), LINK_OK);
    EXPECT_EQ(pair.a.send(0, {1}, 2), LINK_FULL);
    ASSERT_TRUE(pair.until([&] { return pair.a.outcomes.size() == 15; }, 10'000'000));
    EXPECT_EQ(pair.b.received[0].second.size(), LINK_MAX_MESSAGE);
    EXPECT_EQ(pair.b.received[1].second.size(), rest);
}

// If acknowledgements arrive faster than modems could send them, the path is a wire, on which both
// sides may send at the same time.
TEST(FullLayer, ACallOverAWireWaitsForNoTurn) {
    LinkPair pair(testSeed());
    pair.setWeather({0, 0, 0, 0});
    ASSERT_TRUE(pair.connect());
    pair.a.open(0);
    pair.run(100'000);
    // Makes calls one after the other. Returns the time that they took, us.
    auto take = [&](unsigned calls) {
        const uint64_t start = pair.now;
        for (unsigned i = 0; i < calls; ++i)
            for (auto [from, to] : {std::pair(&pair.a, &pair.b), std::pair(&pair.b, &pair.a)}) {
                const size_t arrived = to->received.size();
                from->send(0, Bytes(2, 7), static_cast<U32>(pair.now));
                EXPECT_TRUE(pair.until([&] { return to->received.size() > arrived; }, 1'000'000));
                pair.run(1000);
            }
        return pair.now - start;
    };
    take(20); // after these calls both sides know the speed of the path
    EXPECT_LE(take(20), 20 * 12'000u);
}

} // namespace
