// SPDX-License-Identifier: MIT
//
// command_test: command mode and every command of the XBee model.

#include "pair.h"

namespace {

using CommandMode = Pair;

class Commands : public Pair {
protected:
    void SetUp() override {
        power();
        enter();
    }
};

TEST_F(CommandMode, SequenceBetweenGuardTimesIsAnswered) {
    power();
    EXPECT_EQ(enter(), "OK\r");
    EXPECT_TRUE(a->inCommandMode());
    EXPECT_TRUE(packets.empty()) << "the sequence itself is not sent";
}

TEST_F(CommandMode, DefaultGuardTimeIsASecond) {
    power({{"GT", 1000}});
    run(1000 * ms);
    send("+++", 999 * ms);
    EXPECT_FALSE(a->inCommandMode());
    run(2 * ms);
    EXPECT_TRUE(a->inCommandMode());
}

TEST_F(CommandMode, WithoutSilenceBeforeItIsData) {
    power();
    run(11 * ms);
    send("x", 5 * ms);
    send("+++", 30 * ms);
    EXPECT_FALSE(a->inCommandMode());
    EXPECT_EQ(heardB(), "x+++");
}

TEST_F(CommandMode, WithoutSilenceAfterItIsData) {
    power();
    run(11 * ms);
    send("+++", 5 * ms);
    send("y", 30 * ms);
    EXPECT_FALSE(a->inCommandMode());
    EXPECT_EQ(heardB(), "+++y");
}

TEST_F(CommandMode, TheThreeCharactersComeWithinASecond) {
    power({{"GT", 2000}});
    run(2001 * ms);
    send("+", 900 * ms);
    send("+");
    run(200 * ms); // 1.1 s after the first
    send("+", 2100 * ms);
    EXPECT_FALSE(a->inCommandMode());
    EXPECT_EQ(heardB(), "+++");
}

TEST_F(CommandMode, FewerCharactersAreData) {
    power();
    run(11 * ms);
    EXPECT_EQ(across("++", 30 * ms), "++");
}

TEST_F(CommandMode, TheCharacterIsCC) {
    power({{"CC", '-'}});
    EXPECT_EQ(enter(), "");
    run(11 * ms);
    send("---", 11 * ms);
    EXPECT_EQ(heard(), "OK\r");
}

TEST_F(CommandMode, WhatWasWrittenBeforeIsSentByRadio) {
    power({{"RO", 0xFF}}); // nothing would leave by itself for 265 ms
    run(11 * ms);
    send("before", 11 * ms);
    EXPECT_TRUE(packets.empty());
    EXPECT_EQ(across("+++", 20 * ms), "before");
}

TEST_F(CommandMode, EndsByCN) {
    power();
    enter();
    EXPECT_EQ(command("ATCN"), "OK\r");
    EXPECT_FALSE(a->inCommandMode());
    EXPECT_EQ(across("data", 20 * ms), "data");
}

TEST_F(CommandMode, EndsAfterCTWithoutAValidCommand) {
    power({{"CT", 5}}); // 500 ms
    enter();
    run(400 * ms);
    EXPECT_EQ(command("ATMY"), "1\r");
    run(400 * ms);
    EXPECT_TRUE(a->inCommandMode());
    EXPECT_EQ(command("ATXX"), "ERROR\r"); // does not count
    run(105 * ms);
    EXPECT_FALSE(a->inCommandMode());
}

TEST_F(CommandMode, OkWaitsUntilReceivedDataHasDrained) {
    power();
    lineA.paused = true; // the host's line is slow
    lineB.send(Bytes(100, 'r'), now);
    run(20 * ms);
    run(11 * ms);
    send("+++", 20 * ms);
    EXPECT_TRUE(a->inCommandMode());
    EXPECT_EQ(heard(), "");
    lineA.paused = false;
    run(ms);
    EXPECT_EQ(heard(), std::string(100, 'r') + "OK\r");
}

TEST_F(Commands, AreReadAndWrittenInHex) {
    const std::vector<std::pair<std::string, std::string>> values = {
        {"MY", "1A2B"}, {"DH", "13A200"}, {"DL", "FFFF"}, {"ID", "BEEF"}, {"CH", "1A"},
        {"BD", "7"},    {"RO", "0"},      {"RN", "3"},    {"MM", "2"},    {"RR", "6"},
        {"EE", "1"},    {"GT", "CE4"},    {"CT", "2"},    {"CC", "2D"},   {"D6", "1"},
        {"D7", "0"},    {"FT", "80"},     {"AP", "2"},    {"EC", "0"},    {"EA", "0"}};
    for (auto& [letters, value] : values) {
        EXPECT_EQ(command("AT" + letters + value), "OK\r") << letters;
        EXPECT_EQ(command("AT" + letters), value + "\r") << letters;
    }
}

TEST_F(Commands, OutOfRangeAreRefusedAndChangeNothing) {
    for (std::string line :
         {"ATMY10000", "ATCH0A", "ATCH1B", "ATRN4", "ATMM4", "ATRR7", "ATEE2", "ATGT1", "ATGTCE5",
          "ATAP3", "ATBD3D091", "ATD66", "ATFT10", "ATMYG", "ATMY123456789"}) {
        std::string before = command(line.substr(0, 4));
        EXPECT_EQ(command(line), "ERROR\r") << line;
        EXPECT_EQ(command(line.substr(0, 4)), before) << line;
    }
}

TEST_F(Commands, UnknownAndMalformedAreRefused) {
    for (std::string line : {"ATZZ", "ATZZ1", "AT", "A", "", "MY", "XXMY"})
        EXPECT_EQ(command(line), "ERROR\r") << line;
    EXPECT_EQ(command("atmy"), "1\r") << "letters may be small";
}

TEST_F(Commands, SerialNumberAndSignalAreReadOnly) {
    EXPECT_EQ(command("ATSH"), "13A200\r");
    EXPECT_EQ(command("ATSL"), "A\r");
    EXPECT_EQ(command("ATDB"), "28\r");
    for (std::string line : {"ATSH1", "ATSL1", "ATDB1"})
        EXPECT_EQ(command(line), "ERROR\r") << line;
}

TEST_F(Commands, TheKeyIsWriteOnly) {
    EXPECT_EQ(command("ATKY00112233445566778899AABBCCDDEEFF"), "OK\r");
    EXPECT_EQ(a->key(), "00112233445566778899AABBCCDDEEFF");
    EXPECT_EQ(command("ATKY1"), "OK\r");
    EXPECT_EQ(a->key(), std::string(31, '0') + "1");
    EXPECT_EQ(command("ATKY"), "ERROR\r");
    EXPECT_EQ(command("ATKY" + std::string(33, '0')), "ERROR\r");
}

TEST_F(Commands, ChangesAreInForceAfterACOrCN) {
    command("ATMY99");
    EXPECT_EQ(a->parameter("MY"), 1u);
    command("ATAC");
    EXPECT_EQ(a->parameter("MY"), 0x99u);
    command("ATDL77");
    command("ATCN");
    EXPECT_EQ(a->parameter("DL"), 0x77u);
}

TEST_F(Commands, WRSurvivesAResetAndOthersDoNot) {
    command("ATMY55");
    command("ATWR");
    command("ATMY66");
    command("ATCN");
    EXPECT_EQ(a->parameter("MY"), 0x66u);
    a->power(false, now);
    a->power(true, now);
    run(60 * ms);
    EXPECT_EQ(a->parameter("MY"), 0x55u);
}

TEST_F(Commands, REGivesTheFactorysSettings) {
    EXPECT_EQ(command("ATRE"), "OK\r");
    EXPECT_EQ(command("ATMY"), "0\r");
    EXPECT_EQ(command("ATGT"), "3E8\r");
    EXPECT_EQ(command("ATSL"), "A\r") << "the serial number stays";
}

TEST_F(Commands, FRAnswersAndThenBoots) {
    command("ATMY66");
    EXPECT_EQ(command("ATFR"), "OK\r");
    EXPECT_EQ(a->parameter("MY"), 1u);
    EXPECT_EQ(across("lost", 60 * ms), "") << "deaf while it boots";
    EXPECT_EQ(across("data", 20 * ms), "data");
}

TEST_F(Commands, ALiteralRateIsKeptAsTheNearest) {
    EXPECT_EQ(command("ATBD3D090"), "OK\r");
    EXPECT_EQ(command("ATBD"), "3D090\r") << "250,000 is exact";
    EXPECT_EQ(command("ATBD1C200"), "OK\r"); // 115,200
    EXPECT_EQ(command("ATBD"), "1B207\r") << "111,111";
}

} // namespace
