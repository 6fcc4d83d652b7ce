// SPDX-License-Identifier: MIT
//
// profile_test: tests the differences between the modems that the model can imitate: rates, ranges
// of parameters, flow control, and sizes of packets.

#include "two_modems.h"

using namespace std::string_literals;

namespace {

struct Modem {
    const char* name;
    const char *bd7, *bd8, *bdA;      // answers of the modem to these values of the parameter BD
    const char *rate250000, *rate300; // answers of the modem to these rates
    const char *rn4, *c8;             // answers of the modem to ATRN4 and ATC8
    double baud7;                     // rate of BD 7
    size_t ctsOff;                    // number of bytes in the buffer at which CTS is deasserted
    // largest number of data bytes in a packet, without and with encryption
    size_t packet, encrypted;
    friend void PrintTo(const Modem& modem, std::ostream* out) { *out << modem.name; }
};
const Modem modems[] = {
    {"s1", "OK\r", "ERROR\r", "ERROR\r", "OK\r", "OK\r", "ERROR\r", "ERROR\r", 1e6 / 9, 185, 100,
     95},
    {"s2c", "OK\r", "OK\r", "OK\r", "OK\r", "ERROR\r", "ERROR\r", "0\r", 115200, 109, 114, 101},
    {"xb3", "OK\r", "OK\r", "OK\r", "OK\r", "OK\r", "OK\r", "0\r", 115200, 109, 114, 101}};

class Profiles : public TwoModems, public ::testing::WithParamInterface<Modem> {
protected:
    void SetUp() override { profile = GetParam().name; }
};
INSTANTIATE_TEST_SUITE_P(Of, Profiles, ::testing::ValuesIn(modems),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_P(Profiles, HaveSeparateRangesOfParameters) {
    power();
    enter();
    EXPECT_EQ(command("ATBD8"), GetParam().bd8);
    EXPECT_EQ(command("ATBDA"), GetParam().bdA);
    EXPECT_EQ(command("ATBD12C"), GetParam().rate300);
    EXPECT_EQ(command("ATBD3D090"), GetParam().rate250000);
    EXPECT_EQ(command("ATBD"), "3D090\r");
    EXPECT_EQ(command("ATRN4"), GetParam().rn4);
    EXPECT_EQ(command("ATC8"), GetParam().c8);
    EXPECT_EQ(command("ATBD7"), GetParam().bd7);
    command("ATCN");
    EXPECT_NEAR(a->baud(), GetParam().baud7, 1);
}

TEST_P(Profiles, DeassertCTSAtTheThreshold) {
    perfect = false;
    // the modem tries with this setting for a long time to send a packet to a receiver that does
    // not exist
    power({{"BD", 0x3D090}, {"RR", 6}}, {{"MY", 9}});
    send(std::string(GetParam().packet, 'x'), 10 * ms);
    ASSERT_EQ(a->counters().packetsSent, 1u);
    size_t held = 0;
    for (; a->cts() && held < 250; ++held)
        send("y", 50'000);
    EXPECT_EQ(a->counters().packetsSent, 1u);
    EXPECT_EQ(held, GetParam().ctsOff);
}

// When the second packet has left the buffer, `remaining` bytes are still in it. CTS is asserted
// again if FT is at least `remaining` + `release`, and stays deasserted if FT is lower. `release`
// depends on the modem.
TEST_P(Profiles, AssertCTSAgainBelowTheThreshold) {
    if (profile == "s1")
        GTEST_SKIP() << "series 1 has no FT";
    constexpr uint32_t remaining = 50;
    const uint32_t release = profile == "s2c" ? 17 : 1;
    for (const bool isAsserted : {true, false}) {
        const uint32_t ft = remaining + release - !isAsserted;
        power({{"BD", 0x3D090}, {"FT", ft}});
        send(std::string(GetParam().packet, 'x'));
        send(std::string(GetParam().packet + remaining, 'y'));
        for (int i = 0; a->counters().packetsSent < 2 && i < 10'000; ++i)
            run(50'000);
        ASSERT_EQ(a->counters().packetsSent, 2u);
        EXPECT_EQ(a->cts(), isAsserted) << "FT " << ft;
    }
}

TEST_P(Profiles, FillAPacketToItsMaximum) {
    power();
    send(std::string(GetParam().packet + 10, 'x'), 400 * ms);
    ASSERT_EQ(packets.size(), 2u);
    EXPECT_EQ(packets[0].bytes.size(), GetParam().packet);
    packets.clear();
    power({{"EE", 1}}, {{"EE", 1}});
    send(std::string(GetParam().encrypted + 10, 'x'), 400 * ms);
    ASSERT_EQ(packets.size(), 2u);
    const size_t overhead = 5; // number of bytes that encryption adds on the air
    EXPECT_EQ(packets[0].bytes.size(), GetParam().encrypted + overhead);
}

TEST_P(Profiles, SendPacketsAsShortAsSeries1WithC8) {
    if (profile == "s1")
        GTEST_SKIP() << "series 1 has no C8";
    power({{"C8", 1}});
    send(std::string(110, 'x'), 400 * ms);
    ASSERT_EQ(packets.size(), 2u);
    EXPECT_EQ(packets[0].bytes.size(), 100u);
}

TEST_P(Profiles, ReportTooLongData) {
    power({{"AP", 1}});
    Bytes frame = {0x7E, 0, static_cast<uint8_t>(GetParam().packet + 6), 0x01, 0x55, 0, 2, 0};
    frame.insert(frame.end(), GetParam().packet + 1, 'x');
    uint8_t sum = 0;
    for (size_t i = 3; i < frame.size(); ++i)
        sum = static_cast<uint8_t>(sum + frame[i]);
    frame.push_back(static_cast<uint8_t>(0xFF - sum));
    lineA.send(frame, now);
    run(400 * ms);
    EXPECT_TRUE(packets.empty());
    EXPECT_EQ(a->counters().badFrames, 1u);
    const std::string status = "\x7E\0\x03\x89\x55\x74\xAD"s;
    EXPECT_EQ(heard(), profile == "s1" ? "" : status);
}

TEST(Profile, AnUnknownNameIsRefused) {
    try {
        (void)xbeeProfile("s2");
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "modem: expected s1, s2c or xb3, got 's2'");
    }
}

} // namespace
