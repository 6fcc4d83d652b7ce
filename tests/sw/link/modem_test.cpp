// SPDX-License-Identifier: MIT
//
// modem_test: tests two link layers over two modem models and the air between them. The tests cover
// packets that a modem acknowledges and then loses, published radio conditions, and the example of
// a recorded trace.

#include "modem_pair.h"
#include <gtest/gtest.h>

namespace {

constexpr uint64_t ms = 1'000'000;

class End : public ModemEnd {
public:
    // `apiEnds` is the number of ends in API mode: 0, 1 (the first end) or 2. `baud` is the
    // parameter BD of the second end.
    End(RfChannel& air, unsigned address, uint64_t seed, bool hasKey, unsigned apiEnds,
        bool encrypts = false, unsigned baud = 7)
        : ModemEnd(air, optionsOf(address, encrypts, address < apiEnds, baud), seed) {
        static const U8 key[LINK_KEY_BYTES] = {1, 2, 3};
        if (hasKey)
            Link_setKey(link(), 0, key, address ? 0 : LINK_GROUND);
    }
    std::vector<std::vector<U8>> received;

private:
    static XBee::Options optionsOf(unsigned address, bool encrypts, bool isApi, unsigned baud) {
        XBee::Options o = modemOptions(address, encrypts, 2, isApi);
        if (address == 1)
            o.set["BD"] = baud;
        return o;
    }
    int onMessage(size_t, int, const U8* message, U32 size) override {
        received.emplace_back(message, message + size);
        return 0;
    }
};

class LinkOverModems : public ::testing::TestWithParam<std::pair<bool, unsigned>> {
protected:
    // Sends messages in both directions, and expects each of them exactly once, in order.
    void expectAll(unsigned count, unsigned seconds, const std::function<void()>& meanwhile = {}) {
        std::vector<std::vector<U8>> messages;
        for (unsigned i = 0; i < count; ++i)
            messages.emplace_back(i % 4 ? 20 : 700, static_cast<U8>(i));
        unsigned sent[2] = {0, 0};
        auto offer = [&](End& end, unsigned& n) {
            while (n < count && Link_send(end.link(), 0, messages[n].data(),
                                          static_cast<U32>(messages[n].size()), n) == LINK_OK)
                ++n;
        };
        EXPECT_TRUE(pair_.until(
            [&] {
                offer(a_, sent[0]);
                offer(b_, sent[1]);
                if (meanwhile)
                    meanwhile();
                return a_.received.size() >= count && b_.received.size() >= count;
            },
            seconds));
        EXPECT_TRUE(a_.received == messages) << a_.received.size() << " of " << count;
        EXPECT_TRUE(b_.received == messages) << b_.received.size() << " of " << count;
        a_.received.clear();
        b_.received.clear();
    }
    ModemPair<End> pair_{RfWeather(), testSeed(), 1, GetParam().first, GetParam().second};
    RfChannel& air_ = pair_.air;
    End &a_ = pair_.a, &b_ = pair_.b;
};

// The hosts hang for up to 200 ms now and then. During this time their modems acknowledge packets
// for which they have no room, and drop them.
TEST_P(LinkOverModems, PacketsAcknowledgedButDroppedAreRetransmitted) {
    Random random(testSeed());
    uint64_t drawn = pair_.now, wakesAt[2] = {0, 0};
    expectAll(60, 120, [&] {
        for (; drawn < pair_.now; drawn += ms / 4)
            for (uint64_t& at : wakesAt)
                if (random.chance(0.002)) // a host hangs eight times a second on average
                    at = drawn + random.below(200) * ms;
        a_.line.hangs = pair_.now < wakesAt[0];
        b_.line.hangs = pair_.now < wakesAt[1];
    });
    EXPECT_GT(a_.modem.counters().packetsDropped, 2u);
    EXPECT_GT(b_.modem.counters().packetsDropped, 2u);
}

// Returns true if a packet consists only of complete frames and padding bytes.
bool isWhole(const std::vector<uint8_t>& bytes) {
    size_t at = 0;
    while (at < bytes.size())
        at += bytes[at] == LINK_FILL ? 1 : LINK_LENGTH(&bytes[at]) + LINK_OVERHEAD;
    return at == bytes.size();
}

// While a modem waits for the air, it stores packets. It must not combine a packet with a part of
// the next packet. Otherwise each later packet would contain parts of two frames, and each lost
// packet would cost both frames.
TEST_P(LinkOverModems, PacketsContainWholeFramesEvenWithASlowModem) {
    unsigned packets = 0, whole = 0;
    air_.onPacket([&](uint64_t, const RfPacket& packet, RfChannel::Outcome) {
        ++packets;
        whole += isWhole(packet.bytes);
    });
    for (auto& [what, weather] : RfWeather::published()) {
        air_.weather = weather;
        expectAll(120, 300);
    }
    // A modem in transparent mode does not report the retries of its MAC, which may delay a packet
    // by 60 ms.
    EXPECT_GE(whole, packets * 0.98) << whole << " of " << packets;
    EXPECT_GT(packets, 1000u);
}

TEST_P(LinkOverModems, TheExampleTraceIsFlown) {
    air_.weather.trace = std::make_shared<RfTrace>(TRACE);
    const uint64_t lost = air_.counters().lost;
    while (pair_.now < 110'000 * ms && !HasFailure())
        expectAll(24, 120);
    EXPECT_GT(air_.counters().lost - lost, 100u);
}

// An idle link sends a PING of a few bytes after five seconds, and repeats the PING soon if no
// reply arrives. The session must last for an hour under each of the published radio conditions
// (RfWeather), and for another hour with 30 % packet loss.
TEST_P(LinkOverModems, AnIdleSessionSurvivesBadConditions) {
    a_.longestRestUs = b_.longestRestUs = 100'000;
    const U32 before = a_.statistics().bytesSent + b_.statistics().bytesSent;
    pair_.pass(3600 * 1000 * ms);
    EXPECT_LE((a_.statistics().bytesSent + b_.statistics().bytesSent - before) / 720,
              GetParam().first ? 44u : 11u); // number of bytes in five seconds
    auto weathers = RfWeather::published();
    weathers.emplace_back("loss", RfWeather()).second.loss = 0.3;
    for (auto& [what, weather] : weathers) {
        air_.weather = weather;
        pair_.pass(3600 * 1000 * ms);
        EXPECT_EQ(a_.statistics().sessions, 1u) << what;
        EXPECT_EQ(b_.statistics().sessions, 1u) << what;
    }
}

// A modem in API mode reports lost packets. A lost packet is sent again once and immediately,
// before the receiver has reported anything. Other packets are not sent again.
TEST(LinkOverApi, OnlyPacketsReportedLostAreRetransmitted) {
    ModemPair<End> pair(RfWeather(), testSeed(), 1, false, 1u);
    pair.air.weather.loss = 0.3;
    unsigned lost = 0;
    pair.air.onPacket([&](uint64_t, const RfPacket& packet, RfChannel::Outcome outcome) {
        lost += packet.from == 0 && outcome != RfChannel::Outcome::Delivered;
    });
    const std::vector<U8> message(LINK_MAX_MESSAGE, 1);
    unsigned sent = 0;
    ASSERT_TRUE(pair.until(
        [&] {
            while (sent < 10 &&
                   Link_send(pair.a.link(), 0, message.data(), LINK_MAX_MESSAGE, 0) == LINK_OK)
                ++sent;
            return pair.b.received.size() == 10;
        },
        20)); // limit, s; with the lost packets, these messages take 13 s of air time
    EXPECT_GT(lost, 250u);
    EXPECT_NEAR(pair.a.statistics().fragmentsResent, lost, lost * 0.05);
}

TEST(LinkOverApi, ALostPeerCostsLittleAirTime) {
    for (bool isCalled : {false, true}) {
        ModemPair<End> pair(RfWeather(), testSeed(), 1, true, 2u);
        const U8 message[10] = {};
        pair.pass(1000 * ms);
        EXPECT_EQ(Link_send(pair.a.link(), 0, message, isCalled ? 10 : 0, 0),
                  isCalled ? LINK_OK : LINK_TOO_LONG);
        pair.air.carryAway(&pair.b.modem, true);
        Link_stop(pair.b.link(), static_cast<U32>(pair.now / 1000));
        const uint64_t before = pair.air.counters().airNs;
        pair.pass(10'000 * ms);
        EXPECT_FALSE(pair.a.isUp());
        const double share = static_cast<double>(pair.air.counters().airNs - before) / 1e10;
        std::printf("a peer that vanishes takes %.2f %% of the air\n", 100 * share);
        EXPECT_LT(share, 0.02) << (isCalled ? "during a call" : "idle");
        EXPECT_GT(share, 0.002) << "the link must search for the peer";
    }
}

// Makes calls while the second end sends pictures. Both lines have 250,000 baud, like the line of
// the vehicle. Expects that the median of the calls is below `most` ms, and that the pictures
// become slower by less than a fifth; the calls themselves also take air time.
void callDuringPictures(bool encrypts, double most) {
    const std::vector<U8> picture(LINK_MAX_MESSAGE, 1), call(1, 2);
    double pictures[2] = {0, 0};
    for (bool isCalled : {false, true}) {
        ModemPair<End> pair(RfWeather(), testSeed(), 2, false, 2u, encrypts, 250'000u);
        std::vector<double> times;
        auto answers = [&](End& end, const std::function<void()>& answer) {
            for (const auto& message : end.received)
                message.size() == 1 ? answer() : void(pictures[isCalled] += LINK_MAX_MESSAGE);
            end.received.clear();
        };
        for (uint64_t i = 0; i < 80; ++i) {
            bool isBack = false;
            const uint64_t at = pair.now;
            if (isCalled)
                Link_send(pair.a.link(), 1, call.data(), 1, 0);
            pair.until(
                [&] {
                    while (Link_send(pair.b.link(), 0, picture.data(), LINK_MAX_MESSAGE, 0) ==
                           LINK_OK)
                        continue;
                    answers(pair.b, [&] { Link_send(pair.b.link(), 1, call.data(), 1, 0); });
                    answers(pair.a, [&] {
                        times.push_back(static_cast<double>(pair.now - at) / 1e6);
                        isBack = true;
                    });
                    return pair.now > at + 200 * ms + i * 331'000;
                },
                10);
            EXPECT_EQ(isBack, isCalled);
        }
        if (isCalled) {
            std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
            EXPECT_LT(times[times.size() / 2], most);
        }
    }
    EXPECT_GT(pictures[1], 0.8 * pictures[0]);
}

// A reply waits for one packet of a stream, in addition to the packet on the air.
TEST(LinkOverApi, ACallDuringPicturesWaitsForOnePacket) {
    callDuringPictures(false, 41);
}

// docs/link.md explains why the modem's encryption more than doubles this time.
TEST(LinkOverApi, ACallDuringEncryptedPicturesWaitsForOnePacket) {
    callDuringPictures(true, 79);
}

// Tests of the RN that the links set, with two modems in API mode.
class RandomWait : public ::testing::Test {
protected:
    unsigned rn(End& end) { return end.modem.parameter("RN"); }
    static void send(End& end, U32 size) {
        const std::vector<U8> message(size, 1);
        while (Link_send(end.link(), 0, message.data(), size, 0) == LINK_OK && size > 1)
            continue;
    }
    // Lets each end send messages for two seconds: long messages, short messages, or (size 0) none.
    void talk(ModemPair<End>& pair, U32 first, U32 second) {
        for (int i = 0; i < 10; ++i, pair.pass(200 * ms)) {
            if (first)
                send(pair.a, first);
            if (second)
                send(pair.b, second);
        }
    }
};

TEST_F(RandomWait, OnlyTwoActivePeersWait) {
    ModemPair<End> pair(RfWeather(), testSeed(), 1, false, 2u);
    talk(pair, 1, 0);
    EXPECT_EQ(rn(pair.a), 0u);
    talk(pair, 2000, 0);
    EXPECT_EQ(rn(pair.a), 0u);
    EXPECT_EQ(rn(pair.b), 2u);
    talk(pair, 2000, 1); // the second end makes calls
    EXPECT_EQ(rn(pair.a), 2u);
    talk(pair, 2000, 2000);
    EXPECT_EQ(rn(pair.a), 2u);
    EXPECT_EQ(rn(pair.b), 2u);
    pair.pass(20'000 * ms);
    talk(pair, 1, 0);
    EXPECT_EQ(rn(pair.a), 0u);
    ModemPair<End> encrypted(RfWeather(), testSeed(), 1, false, 2u, true);
    talk(encrypted, 1, 0);
    EXPECT_EQ(rn(encrypted.a), 0u);
}

TEST_F(RandomWait, APeerThatSendsLittleWaitsIfPacketsAreLost) {
    ModemPair<End> pair(RfWeather(), testSeed(), 1, false, 2u);
    pair.air.weather.loss = 0.5;
    talk(pair, 1, 0);
    EXPECT_EQ(rn(pair.a), 2u);
    talk(pair, 2000, 0); // a stream has a packet ready whenever the air is idle
    EXPECT_EQ(rn(pair.a), 0u);
    pair.air.weather.loss = 0;
    pair.pass(20'000 * ms);
    talk(pair, 1, 0);
    EXPECT_EQ(rn(pair.a), 0u);
}

// Failed tries of the MAC indicate collisions, so the links must wait longer. Packets that are lost
// without failed tries do not indicate collisions.
TEST_F(RandomWait, TwoStreamsDoNotWaitIfPacketsAreLostWithoutFailedTries) {
    ModemPair<End> pair(RfWeather(), testSeed(), 1, false, 2u);
    const auto stream = [&] {
        for (int i = 0; i < 3; ++i)
            talk(pair, 8000, 8000);
        return std::max(rn(pair.a), rn(pair.b));
    };
    pair.air.weather.loss = 0.35;
    EXPECT_EQ(stream(), 0u);
    pair.air.weather = RfWeather();
    EXPECT_EQ(stream(), 2u);
    // a third of the packets is lost, each of them after four tries
    pair.air.weather.distance = 400;
    EXPECT_EQ(stream(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Keys, LinkOverModems,
                         ::testing::Values(std::make_pair(false, 0u), std::make_pair(true, 0u),
                                           std::make_pair(false, 1u), std::make_pair(true, 2u)),
                         [](auto& test) {
                             return std::string(test.param.first ? "WithAKey" : "InTheClear") +
                                    (test.param.second == 0   ? ""
                                     : test.param.second == 1 ? "OneInApiMode"
                                                              : "BothInApiMode");
                         });

} // namespace
