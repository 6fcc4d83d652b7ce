// SPDX-License-Identifier: MIT
//
// weather_test: tests traffic in both directions over a bad radio, with reboots and random bytes,
// for all combinations of layers. No message may be wrong, duplicated, out of order or unreported,
// and the goodput must be sufficient.

#include "link_variants.h"

namespace {

class Met : public Variants {};

TEST_P(Met, NoMessageIsLostDuplicatedOrReorderedInBadConditions) {
    usualSize = 200;
    longestSize = std::min(a.layer.maxMessage, b.layer.maxMessage);
    ASSERT_TRUE(connect());
    setWeather({0.1, 0.05, 0.03});
    EXPECT_TRUE(traffic(400, 1'000'000'000, [&] { b.refuse = random.below(3) == 0; }))
        << "seed " << testSeed();
    expectAllDelivered();
}

// The sender never exceeds the window of its peer; fragments beyond the window would be sent twice.
TEST_P(Met, OnlyLostFragmentsAreRetransmitted) {
    ASSERT_TRUE(connect());
    a.open(1);
    run(200'000);
    const Bytes call(1, 7), picture(1024, 7);
    for (U32 tag = 0; tag < 6; ++tag) {
        ASSERT_EQ(a.send(1, call, tag), LINK_OK); // the reply also contains the acknowledgement
        ASSERT_TRUE(until([&] { return b.received.size() == 2 * tag + 1; }, 1'000'000));
        b.send(1, call, tag);
        ASSERT_TRUE(until([&] { return a.outcomes.count(tag) != 0; }, 1'000'000));
        ASSERT_EQ(a.send(1, picture, 100 + tag), LINK_OK);
        setWeather({double(tag % 2), 0, 0});
        run(5'000);
        setWeather({});
        ASSERT_TRUE(until([&] { return a.outcomes.count(100 + tag) != 0; }, 5'000'000));
    }
    EXPECT_EQ(a.packetsLost, 3u);
    EXPECT_EQ(a.statistics().fragmentsResent, a.packetsLost);
}

TEST_P(Met, AMessageTooLongForThePeerIsReported) {
    const U32 most = b.layer.maxMessage;
    if (a.layer.maxMessage <= most)
        return; // the message cannot be sent now
    ASSERT_TRUE(connect());
    a.open(0);
    a.send(0, Bytes(most + 200, 7), 5);
    EXPECT_TRUE(until([&] { return a.outcomes.count(5) != 0; }, 20'000'000));
    EXPECT_EQ(a.outcomes[5], LINK_UNKNOWN);
    EXPECT_TRUE(b.received.empty());
    EXPECT_TRUE(until([&] { return bothUp(); }, 20'000'000));
}

INSTANTIATE_TEST_SUITE_P(
    Variants, Met,
    ::testing::Values(Variant{"full", "full", false}, Variant{"full", "small", false},
                      Variant{"small", "full", false}, Variant{"small", "small", false},
                      Variant{"window32", "full", false}, Variant{"small", "window32", false},
                      Variant{"full", "minimal", false}, Variant{"window32", "minimal", false},
                      Variant{"small", "minimal", false}, Variant{"shrunk", "full", true},
                      Variant{"full", "full", true}, Variant{"full", "small", true},
                      Variant{"window32", "full", true}, Variant{"tag4", "tag4", true}));

class Seeds : public Variants {};

TEST_P(Seeds, RestartsAreDetectedAndMessagesInFlightAreReported) {
    ASSERT_TRUE(connect());
    b.start();
    setWeather({0.05, 0.05, 0.01});
    for (unsigned round = 0; round < 6; ++round) {
        traffic(40 * (round + 1), 3'000'000 + random.below(3'000'000));
        const bool isA = random.below(2) != 0;
        Side& side = isA ? a : b;
        side.boot();
        // Counts the messages in transit as lost, as an application would.
        for (U32 i = 0; i < (isA ? sentA : sentB).size(); ++i)
            side.outcomes.emplace(i, LINK_UNKNOWN);
        side.start();
        ASSERT_TRUE(until([&] { return bothUp(); }, 60'000'000)) << "round " << round;
    }
    EXPECT_TRUE(traffic(240, 600'000'000)) << "seed " << testSeed();
    checkBoth();
}

TEST_P(Seeds, GarbageOnTheLineDoesNotDisturbTheSession) {
    ASSERT_TRUE(connect());
    for (unsigned i = 0; i < 60; ++i) {
        Bytes noise(1 + random.below(150));
        for (auto& byte : noise)
            byte = static_cast<uint8_t>(random.next());
        b.receive(noise);
        traffic(3 * (i + 1), 200'000);
    }
    EXPECT_TRUE(traffic(180, 100'000'000)) << "seed " << testSeed();
    checkBoth();
    EXPECT_EQ(b.events.front(), "up");
    EXPECT_TRUE(b.isUp());
    EXPECT_EQ(b.sessions(), 1u);
    if (!isMinimal()) { // the minimal layer has no counters
        EXPECT_GT(b.statistics().bytesSkipped, 0u);
    }
}

// If a side receives the beginning of a frame every 20 ms, there is never enough silence before a
// frame.
TEST_P(Seeds, TruncatedFramesBetweenPacketsDoNotStopTheSession) {
    ASSERT_TRUE(connect());
    uint64_t at = now;
    EXPECT_TRUE(traffic(60, 100'000'000,
                        [&] {
                            if (now >= at) {
                                b.receive(Bytes(1 + random.below(3), 0x7F));
                                at += 20'000;
                            }
                        }))
        << a.outcomes.size() << " and " << b.outcomes.size() << " messages";
    checkBoth();
    EXPECT_EQ(b.sessions(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Vehicles, Seeds, ::testing::ValuesIn(vehicles(4)));

class Speed : public Variants {};

// This number of messages makes the sequence numbers wrap hundreds of times.
TEST_P(Speed, TenThousandMessagesPassBadConditions) {
    usualSize = longestSize = 40;
    ASSERT_TRUE(connect());
    setWeather({0.05, 0.05, 0.02});
    EXPECT_TRUE(traffic(10'000, 10'000'000'000)) << "seed " << testSeed();
    expectAllDelivered();
}

INSTANTIATE_TEST_SUITE_P(Vehicles, Speed, ::testing::ValuesIn(vehicles(1)));

class InTheClear : public Variants {};

// One in 65,536 wrong messages has a valid CRC-16. Here such a message is made directly, by adding
// the polynomial to a message.
TEST_P(InTheClear, AWrongMessageWithAMatchingChecksumIsReported) {
    ASSERT_TRUE(connect());
    for (uint32_t size : {21u, 60u, 95u, 300u}) {
        ASSERT_TRUE(until([&] { return a.open(0) == LINK_OK; }, 30'000'000));
        run(1'000'000);
        ASSERT_EQ(a.send(0, Bytes(size, 0x5A), size), LINK_OK);
        until([&] { return !a.air.empty() && a.air[0].bytes.size() >= 20; }, 1'000'000);
        ASSERT_FALSE(a.air.empty());
        const uint8_t polynomial[] = {0x01, 0x10, 0x21};
        for (size_t i = 0; i < sizeof polynomial; ++i)
            a.air[0].bytes[10 + i] ^= polynomial[i];
        run(30'000'000);
        EXPECT_TRUE(b.received.empty()) << size << " bytes";
        EXPECT_EQ(a.outcomes.at(size), LINK_UNKNOWN) << size << " bytes";
    }
}

INSTANTIATE_TEST_SUITE_P(Vehicles, InTheClear,
                         ::testing::Values(Variant{"full", "full", false},
                                           Variant{"full", "minimal", false}));

// Tests the goodput of one direction, as a fraction of the modem's 10,000 bytes/s (docs/link.md).
// The layer sends at the rate of the modem, although the radio of this test would accept any rate.
TEST(Goodput, MeetsItsTargets) {
    const double targets[][2] = {{0, 0.83}, {0.01, 0.81}, {0.1, 0.68}, {0.3, 0.42}};
    for (auto& [loss, target] : targets) {
        LinkPair pair(testSeed());
        ASSERT_TRUE(pair.connect());
        pair.setWeather({loss, 0, 0});
        pair.a.open(0);
        const uint64_t start = pair.now;
        uint32_t tag = 0;
        pair.until(
            [&] {
                while (pair.a.send(0, Bytes(950, 1), tag) == LINK_OK)
                    ++tag;
                return pair.a.outcomes.size() >= 300;
            },
            1'000'000'000);
        const double share = 300.0 * 950 / static_cast<double>(pair.now - start) * 1e6 / 10'000;
        std::printf("loss %4.0f %%: goodput %.1f %% of the limit (target %.0f %%)\n", loss * 100,
                    share * 100, target * 100);
        EXPECT_GE(share, target) << "loss " << loss;
    }
}

} // namespace
