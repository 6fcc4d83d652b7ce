// SPDX-License-Identifier: MIT
//
// radio_test: tests the radio side of the modem, and the air: addresses, times, tries, encryption,
// radio conditions.

#include "two_modems.h"
#include <openssl/evp.h>

namespace {

using Addresses = TwoModems;
using Mac = TwoModems;
class Encryption : public TwoModems {
protected:
    // Encrypts one block with AES and the key 000102..0F.
    static Bytes aes(const Bytes& block) {
        Bytes key, out(32);
        for (uint8_t i = 0; i < 16; ++i)
            key.push_back(i);
        EVP_CIPHER_CTX* context = EVP_CIPHER_CTX_new();
        int size = 0;
        EVP_EncryptInit_ex(context, EVP_aes_128_ecb(), nullptr, key.data(), nullptr);
        EVP_EncryptUpdate(context, out.data(), &size, block.data(), 16);
        EVP_CIPHER_CTX_free(context);
        out.resize(16);
        return out;
    }
};
using Air = TwoModems;

TEST_F(Addresses, ChannelNetworkAndAddressMustAgree) {
    for (auto& [letters, value] : Settings{{"CH", 0x0D}, {"ID", 0x1111}, {"MY", 3}}) {
        power({}, {{letters, value}});
        EXPECT_EQ(across("x", 30 * ms), "") << letters;
        EXPECT_EQ(packets.back().outcome, RfChannel::Outcome::Nobody);
        EXPECT_EQ(a->parameter("EA"), 1u) << "EA must count one packet";
    }
}

TEST_F(Addresses, NetworkFFFFReachesAllNetworksAndHearsNoOther) {
    power({{"ID", 0xFFFF}});
    EXPECT_EQ(across("x", 30 * ms), "x");
    EXPECT_EQ(a->parameter("EA"), 0u) << "acknowledged";
    power({}, {{"ID", 0xFFFF}});
    EXPECT_EQ(across("y", 30 * ms), "");
}

TEST_F(Addresses, SerialNumbersReachAModemWithoutAShortAddress) {
    power({{"DH", 0x0013A200}, {"DL", 0xB}}, {{"MY", 0xFFFE}});
    EXPECT_EQ(across("x", 30 * ms), "x");
}

TEST_F(Mac, AirTimeMatchesTheFormula) {
    EXPECT_EQ(RfChannel::airTimeNs(100), 5'312'000u);
    EXPECT_EQ(RfChannel::airTimeNs(0), 2'112'000u);
    power({{"RO", 0}});
    uint64_t begin = now;
    send("x", 10 * ms);
    EXPECT_EQ(packets[0].time - begin, RfChannel::airTimeNs(1) - afterFrame);
}

TEST_F(Mac, APacketArrivesAtTheEndOfItsFrame) {
    power({{"RO", 0}});
    EXPECT_EQ(across("x", 959'000), "");
    EXPECT_EQ(across("", 2'000), "x") << "128 + 192 + 20 x 32 us";
}

// The tries of a packet sense the channel 20 times in total; without retries (MM 1) 5 times.
TEST_F(Mac, ABusyChannelIsTriedFourTimes) {
    for (uint32_t mm : {0u, 1u, 2u}) {
        power({{"RO", 0}, {"MM", mm}, {"AP", 1}});
        air.weather.perfect = false;
        air.weather.interference = 1;
        const uint64_t before = air.counters().retries, packet = packets.size();
        lineA.send({0x7E, 0x00, 0x06, 0x01, 0x01, 0x00, 0x02, 0x00, 'x', 0x83}, now);
        run(300 * ms);
        EXPECT_EQ(air.counters().retries - before, mm == 1 ? 0u : 3u) << "MM " << mm;
        ASSERT_EQ(packets.size(), packet + 1);
        EXPECT_EQ(packets.back().outcome, RfChannel::Outcome::NoClearChannel);
        EXPECT_EQ(a->parameter("EC"), 1u);
        EXPECT_EQ(a->parameter("EA"), 0u);
        EXPECT_EQ(heard(), std::string("\x7E\0\x03\x89\x01\x02\x73", 7));
    }
}

TEST_F(Mac, ABroadcastThatFindsNoClearChannelIsTriedAgain) {
    power({{"RO", 0}, {"DL", 0xFFFF}});
    air.weather.perfect = false;
    air.weather.interference = 1;
    send("x", 300 * ms);
    EXPECT_EQ(air.counters().retries, 3u);
    EXPECT_EQ(a->parameter("EC"), 1u);
}

TEST_F(Mac, AResetEndsTheRetries) {
    power({{"RR", 6}});
    air.weather.tryLoss = 1;
    send("x", 100 * ms);
    const uint64_t tries = air.counters().retries;
    a->power(false, now);
    run(2000 * ms);
    EXPECT_EQ(air.counters().retries, tries);
    a->power(true, now);
    run(60 * ms);
    air.weather.tryLoss = 0;
    EXPECT_EQ(across("y", 30 * ms), "y");
}

// number of tries for a packet if every try is lost, for several values of RR and MM; RR has an
// effect only with the maker's header
struct Tries {
    uint32_t rr, mm;
    unsigned tries;
    friend void PrintTo(const Tries& t, std::ostream* out) {
        *out << "RR" << t.rr << "_MM" << t.mm;
    }
};
class MacTries : public TwoModems, public ::testing::WithParamInterface<Tries> {};
TEST_P(MacTries, AreFourForEachOfRRPlusOne) {
    power({{"RR", GetParam().rr}, {"MM", GetParam().mm}});
    air.weather.tryLoss = 1;
    send("x", 2000 * ms);
    EXPECT_EQ(air.counters().retries, GetParam().tries - 1);
    EXPECT_EQ(packets.back().outcome, RfChannel::Outcome::Lost);
    bool acks = GetParam().mm == 0 || GetParam().mm == 2;
    EXPECT_EQ(a->parameter("EA"), acks ? 1u : 0u);
}
INSTANTIATE_TEST_SUITE_P(Modes, MacTries,
                         ::testing::Values(Tries{0, 0, 4}, Tries{2, 0, 12}, Tries{6, 0, 28},
                                           Tries{6, 2, 4}, Tries{0, 1, 1}, Tries{3, 3, 1}));

TEST_F(Mac, RetriesHideTheLossOfSingleTries) {
    power({{"RR", 2}});
    air.weather.tryLoss = 0.3;
    for (int i = 0; i < 200; ++i) {
        send("x", 600 * ms);
    }
    EXPECT_EQ(heardB(), std::string(200, 'x'));
    EXPECT_GT(air.counters().retries, 40u);
    EXPECT_LT(air.counters().retries, 140u);
}

TEST_F(Mac, DuplicatesAfterALostAckAreDroppedOnlyWithRR) {
    air.weather.ackLoss = 1;
    power();
    EXPECT_EQ(across("x", 100 * ms), "xxxx");
    EXPECT_EQ(a->parameter("EA"), 1u);
    power({{"RR", 1}});
    EXPECT_EQ(across("x", 400 * ms), "x");
    EXPECT_EQ(b->counters().duplicatesDropped, 7u);
}

TEST_F(Mac, BothModemsNeedACompatibleMM) {
    power({{"MM", 2}});
    EXPECT_EQ(across("x", 30 * ms), "")
        << "a modem with MM 0 must ignore a packet without the header";
    power({{"MM", 0}}, {{"MM", 2}});
    send("x", 30 * ms);
    EXPECT_EQ(heardB().size(), 3u) << "two bytes of header must precede the data";
    power({{"MM", 2}}, {{"MM", 1}});
    EXPECT_EQ(across("x", 30 * ms), "x");
}

TEST_F(Encryption, AnotherKeyYieldsGarbage) {
    power({{"EE", 1}}, {{"EE", 1}});
    enter();
    command("ATKY1");
    command("ATCN");
    send("secret", 30 * ms);
    std::string got = heardB();
    EXPECT_EQ(got.size(), 6u);
    EXPECT_NE(got, "secret");
}

TEST_F(Encryption, AReceiverWithAnotherEEAcknowledgesAndDropsThePacket) {
    for (uint32_t ee : {0u, 1u}) {
        power({{"EE", ee}}, {{"EE", 1 - ee}});
        EXPECT_EQ(across("secret", 60 * ms), "");
        EXPECT_EQ(b->counters().packetsUnreadable, 1u);
        EXPECT_EQ(a->parameter("EA"), 0u);
    }
}

// The packet on the air must be equal to one that is encrypted here block by block with AES, as
// 802.15.4-2003, 7.6.2 defines (flags, sender, frame counter, key sequence counter, block number).
TEST_F(Encryption, PacketsUseAesInCounterModeOf802154) {
    power({{"EE", 1}}, {{"EE", 1}});
    enter();
    command("ATKY000102030405060708090A0B0C0D0E0F");
    command("ATCN");
    const std::string plain = "forty bytes of text, so three AES blocks";
    send(plain, 100 * ms);
    const Bytes& onAir = packets.back().bytes;
    ASSERT_EQ(onAir.size(), 5 + plain.size());
    const Bytes counter(onAir.begin(), onAir.begin() + 4);
    EXPECT_EQ(counter, (Bytes{0, 0, 0, 1}));
    EXPECT_EQ(onAir[4], 0) << "the key sequence counter must be 0";
    for (size_t i = 0; i < plain.size(); ++i) {
        Bytes block = {0x82, 0x00, 0x13, 0xA2, 0x00, 0x00, 0x00, 0x00,
                       0x0A, 0,    0,    0,    1,    0,    0,    static_cast<uint8_t>(1 + i / 16)};
        EXPECT_EQ(onAir[5 + i] ^ aes(block)[i % 16], static_cast<uint8_t>(plain[i]))
            << "byte " << i;
    }
    // FIPS-197, appendix C.1: this key must give this block, so the digits of the key are in the
    // correct order.
    EXPECT_EQ(aes({0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88, 0x99, 0xAA, 0xBB, 0xCC,
                   0xDD, 0xEE, 0xFF}),
              (Bytes{0x69, 0xC4, 0xE0, 0xD8, 0x6A, 0x7B, 0x04, 0x30, 0xD8, 0xCD, 0xB7, 0x80, 0x70,
                     0xB4, 0xC5, 0x5A}));
}

TEST_F(Encryption, EqualTextsAreEncryptedDifferently) {
    power({{"EE", 1}}, {{"EE", 1}});
    send("again", 30 * ms);
    EXPECT_EQ(across("again", 30 * ms), "againagain");
    EXPECT_NE(packets[0].bytes, packets[1].bytes);
}

TEST_F(Air, TheLossRateIsAsConfigured) {
    power({{"RO", 0}});
    air.weather.loss = 0.25;
    for (int i = 0; i < 2000; ++i) {
        send("x", 3 * ms);
    }
    double lost = static_cast<double>(air.counters().lost) / 2000;
    EXPECT_NEAR(lost, 0.25, 0.04);
    EXPECT_EQ(heardB().size(), 2000 - air.counters().lost);
}

TEST_F(Air, BurstsHaveTheConfiguredLengthAndShare) {
    power({{"RO", 0}});
    air.weather.burstBegin = 0.02;
    air.weather.burstEnd = 0.2;
    air.weather.burstLoss = 1;
    unsigned bursts = 0, lost = 0;
    for (int i = 0; i < 6000; ++i) {
        uint64_t before = air.counters().lost;
        send("x", 3 * ms);
        bool now_lost = air.counters().lost > before;
        bursts += now_lost && (packets.size() < 2 ||
                               packets[packets.size() - 2].outcome != RfChannel::Outcome::Lost);
        lost += now_lost;
    }
    EXPECT_NEAR(static_cast<double>(lost) / bursts, 5, 1.2) << "1 / burstEnd";
    EXPECT_NEAR(lost / 6000.0, 0.02 / 0.22, 0.03);
}

TEST_F(Air, DelayIsAddedToTheAirTime) {
    power({{"RO", 0}});
    air.weather.delayNs = 7 * ms;
    uint64_t begin = now;
    send("x", 20 * ms);
    EXPECT_EQ(packets[0].time - begin, RfChannel::airTimeNs(1) - afterFrame + 7 * ms);
}

TEST_F(Air, DuplicationDeliversTwice) {
    power();
    air.weather.duplication = 1;
    EXPECT_EQ(across("ab", 30 * ms), "abab");
}

TEST_F(Air, CorruptionChangesOneByte) {
    power();
    air.weather.corruption = 1;
    send("abcdefgh", 30 * ms);
    std::string got = heardB();
    ASSERT_EQ(got.size(), 8u);
    int different = 0;
    for (size_t i = 0; i < 8; ++i)
        different += got[i] != "abcdefgh"[i];
    EXPECT_EQ(different, 1);
}

TEST_F(Air, TheSeedDeterminesTheLosses) {
    auto weather = [this](uint64_t seed) {
        air = RfChannel(seed);
        packets.clear();
        power({{"RO", 0}});
        air.weather.loss = 0.5;
        std::vector<RfChannel::Outcome> outcomes;
        for (int i = 0; i < 64; ++i) {
            send("x", 4 * ms);
            outcomes.push_back(packets.back().outcome);
        }
        a.reset();
        b.reset();
        return outcomes;
    };
    auto first = weather(5);
    EXPECT_EQ(weather(5), first);
    EXPECT_NE(weather(6), first);
}

TEST_F(Air, SimultaneousPacketsCollideAndAreRetried) {
    power({{"RO", 0}, {"RN", 3}, {"RR", 3}}, {{"RO", 0}, {"RN", 3}, {"RR", 3}});
    air.weather.perfect = false;
    for (int i = 0; i < 100; ++i) {
        send("x");
        lineB.send({'y'}, now);
        run(800 * ms);
    }
    EXPECT_GT(air.counters().collisions, 5u);
    EXPECT_EQ(heardB(), std::string(100, 'x'));
    EXPECT_EQ(heard(), std::string(100, 'y'));
}

TEST_F(Air, AModemWaitsWhileTheChannelIsBusy) {
    power({{"RO", 0}, {"RN", 3}});
    air.weather.perfect = false;
    lineB.send(Bytes(30, 'y'), now);
    run(3 * charNs() + ms); // after this time the packet is on the air
    send("x", 50 * ms);
    EXPECT_EQ(air.counters().collisions, 0u);
    EXPECT_EQ(heard(), std::string(30, 'y'));
    EXPECT_EQ(heardB(), "x");
}

TEST_F(Air, AChannelThatIsNeverClearIsCountedInEC) {
    power({{"RO", 0}}, {{"RO", 0}});
    air.weather.perfect = false;
    air.weather.delayNs = 0;
    // Other modems send on the channel without a pause.
    HostLine third;
    XBee::Options options;
    options.set = {{"MY", 3}, {"DL", 9}, {"MM", 1}, {"RO", 0}};
    XBee jammer(third, air, options);
    for (int i = 0; i < 400; ++i) {
        if (i % 4 == 0 || jammer.counters().packetsSent < static_cast<uint64_t>(i))
            third.send(Bytes(100, 'j'), now);
        if (i == 5)
            send("x");
        run(ms);
    }
    EXPECT_EQ(a->parameter("EC") + (text(lineB.received).find('x') != std::string::npos ? 1u : 0u),
              1u);
}

} // namespace
