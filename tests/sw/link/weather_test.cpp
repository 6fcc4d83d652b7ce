// SPDX-License-Identifier: MIT
//
// weather_test: traffic both ways over a bad radio: no message is wrong, doubled, out of order or
// unreported; and the goodput is sufficient.

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

    // Every message is reported. The received ones are a part of the sent ones, on each channel in
    // order and unchanged, and contain all that are reported as delivered.
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

// A wrong message with a right CRC-16 comes once in 65,536 times; here the polynomial is added to
// get one at once.
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
