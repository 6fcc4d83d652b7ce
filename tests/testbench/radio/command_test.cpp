// SPDX-License-Identifier: MIT
//
// command_test: tests the command mode and every command of the XBee model, and its API frames with
// and without escapes. The bytes are from the examples in the manual.

#include "two_modems.h"

namespace {

class Commands : public TwoModems {
protected:
    void SetUp() override {
        power();
        enter();
    }
};

// A sequence: texts that are sent to `a`, each with the time until the next one, ms; and the
// expected result.
struct Sequence {
    const char* name;
    std::map<std::string, uint32_t> set;
    std::vector<std::pair<const char*, uint64_t>> sent;
    bool isCommandMode;
    const char *answers, *atB; // output to the host of `a` and to the host of `b`
    friend void PrintTo(const Sequence& s, std::ostream* out) { *out << s.name; }
};
const Sequence sequences[] = {
    {"BetweenGuardTimes", {}, {{"", 11}, {"+++", 11}}, true, "OK\r", ""},
    {"InADefaultGuardTime", {{"GT", 1000}}, {{"", 1000}, {"+++", 999}}, false, "", ""},
    {"AfterADefaultGuardTime", {{"GT", 1000}}, {{"", 1000}, {"+++", 1001}}, true, "OK\r", ""},
    {"WithoutSilenceBefore", {}, {{"", 11}, {"x", 5}, {"+++", 30}}, false, "", "x+++"},
    {"WithoutSilenceBehind", {}, {{"", 11}, {"+++", 5}, {"y", 30}}, false, "", "+++y"},
    {"InMoreThanASecond",
     {{"GT", 2000}},
     {{"", 2001}, {"+", 900}, {"+", 200}, {"+", 2100}},
     false,
     "",
     "+++"},
    {"OfFewerCharacters", {}, {{"", 11}, {"++", 30}}, false, "", "++"},
    {"OfAnotherCharacterThanCC", {{"CC", '-'}}, {{"", 11}, {"+++", 11}}, false, "", "+++"},
    {"OfCC", {{"CC", '-'}}, {{"", 11}, {"---", 11}}, true, "OK\r", ""},
    // With RO 0xFF the modem waits 265 ms before it sends data on the air. If the sequence is
    // completed, it sends the data before the sequence at once.
    {"ThatDoesNotCome", {{"RO", 0xFF}}, {{"", 11}, {"before", 11}}, false, "", ""},
    {"BehindData", {{"RO", 0xFF}}, {{"", 11}, {"before", 11}, {"+++", 20}}, true, "OK\r", "before"},
    {"ThenCN", {}, {{"", 11}, {"+++", 11}, {"ATCN\r", 1}, {"data", 20}}, false, "OK\rOK\r", "data"},
    {"WithinCT", // 500 ms
     {{"CT", 5}},
     {{"", 11}, {"+++", 411}, {"ATMY\r", 401}},
     true,
     "OK\r1\r",
     ""},
    {"BeyondCTByAWrongCommand", // a wrong command does not restart the time-out
     {{"CT", 5}},
     {{"", 11}, {"+++", 411}, {"ATMY\r", 401}, {"ATXX\r", 106}},
     false,
     "OK\r1\rERROR\r",
     ""}};

class Sequences : public TwoModems, public ::testing::WithParamInterface<Sequence> {};

TEST_P(Sequences, CommandModeBeginsAndEndsAsInTheManual) {
    power(GetParam().set);
    for (const auto& [text, then] : GetParam().sent)
        send(text, then * ms);
    EXPECT_EQ(a->inCommandMode(), GetParam().isCommandMode);
    EXPECT_EQ(heard(), GetParam().answers);
    EXPECT_EQ(heardB(), GetParam().atB);
}
INSTANTIATE_TEST_SUITE_P(CommandMode, Sequences, ::testing::ValuesIn(sequences));

using CommandMode = TwoModems;
TEST_F(CommandMode, OKWaitsUntilReceivedDataHasDrained) {
    power();
    lineA.paused = true; // the line to the host is slow
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

TEST_F(Commands, ParametersAreHexadecimal) {
    const std::vector<std::pair<std::string, std::string>> values = {
        {"MY", "1A2B"}, {"DH", "13A200"}, {"DL", "FFFF"}, {"ID", "BEEF"}, {"CH", "1A"},
        {"BD", "7"},    {"RO", "0"},      {"RN", "3"},    {"MM", "2"},    {"RR", "6"},
        {"EE", "1"},    {"GT", "CE4"},    {"CT", "2"},    {"CC", "2D"},   {"D6", "1"},
        {"D7", "0"},    {"AP", "2"},      {"EC", "0"},    {"EA", "0"}};
    for (auto& [letters, value] : values) {
        EXPECT_EQ(command("AT" + letters + value), "OK\r") << letters;
        EXPECT_EQ(command("AT" + letters), value + "\r") << letters;
    }
}

TEST_F(Commands, ValuesOutOfRangeAreRefusedAndChangeNothing) {
    for (std::string line :
         {"ATMY10000", "ATCH0A", "ATCH1B", "ATRN4", "ATMM4", "ATRR7", "ATEE2", "ATGT1", "ATGTCE5",
          "ATAP3", "ATBD3D091", "ATBD8", "ATBD7F", "ATD66", "ATMYG", "ATMY123456789"}) {
        std::string before = command(line.substr(0, 4));
        EXPECT_EQ(command(line), "ERROR\r") << line;
        EXPECT_EQ(command(line.substr(0, 4)), before) << line;
    }
}

TEST_F(Commands, UnknownAndMalformedCommandsAreRefused) {
    for (std::string line :
         {"ATZZ", "ATZZ1", "ATFT", "ATFT80", "ATM", "A", "", "MY", "XXMY", "ATMY0x"})
        EXPECT_EQ(command(line), "ERROR\r") << line;
    EXPECT_EQ(command("atmy"), "1\r") << "commands may be written in lower case";
    EXPECT_EQ(command("AT"), "OK\r");
}

TEST_F(Commands, ValuesMayBeginWith0x) {
    EXPECT_EQ(command("ATMY0x1F"), "OK\r");
    EXPECT_EQ(command("ATMY"), "1F\r");
    EXPECT_EQ(command("ATMY 0X2F"), "OK\r");
    EXPECT_EQ(command("ATKY0x1"), "OK\r");
    EXPECT_EQ(a->key(), std::string(31, '0') + "1");
}

TEST_F(Commands, ALineMayHaveSeveralCommands) {
    EXPECT_EQ(command("ATMY5,DL6,MY,ZZ,CN"), "OK\rOK\r5\rERROR\rOK\r");
    EXPECT_FALSE(a->inCommandMode());
    EXPECT_EQ(a->parameter("DL"), 6u);
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

TEST_F(Commands, ChangesTakeEffectAfterACOrCN) {
    command("ATMY99");
    EXPECT_EQ(a->parameter("MY"), 1u);
    command("ATAC");
    EXPECT_EQ(a->parameter("MY"), 0x99u);
    command("ATDL77");
    command("ATCN");
    EXPECT_EQ(a->parameter("DL"), 0x77u);
}

TEST_F(Commands, OnlySettingsSavedByWRSurviveAReset) {
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

TEST_F(Commands, RERestoresTheFactorySettings) {
    EXPECT_EQ(command("ATRE"), "OK\r");
    EXPECT_EQ(command("ATMY"), "0\r");
    EXPECT_EQ(command("ATGT"), "3E8\r");
    EXPECT_EQ(command("ATSL"), "A\r") << "ATRE must not change the serial number";
}

TEST_F(Commands, FRRepliesAndThenResets) {
    command("ATMY66");
    EXPECT_EQ(command("ATFR"), "OK\r");
    EXPECT_EQ(a->parameter("MY"), 1u);
    EXPECT_EQ(across("lost", 60 * ms), "") << "a modem must not receive while it restarts";
    EXPECT_EQ(across("data", 20 * ms), "data");
}

TEST_F(Commands, ABaudRateIsRoundedToTheNearestSupportedRate) {
    EXPECT_EQ(command("ATBD3D090"), "OK\r");
    EXPECT_EQ(command("ATBD"), "3D090\r") << "250,000 baud can be set exactly";
    EXPECT_EQ(command("ATBD1C200"), "OK\r"); // 115,200
    EXPECT_EQ(command("ATBD"), "1B207\r") << "111,111";
}

class Api : public TwoModems, public ::testing::WithParamInterface<uint32_t> {
protected:
    bool escapes() const { return GetParam() == 2; }
    Bytes framed(Bytes contents) const {
        Bytes inside = {static_cast<uint8_t>(contents.size() >> 8),
                        static_cast<uint8_t>(contents.size())};
        uint8_t sum = 0;
        for (uint8_t byte : contents)
            sum = static_cast<uint8_t>(sum + byte);
        inside.insert(inside.end(), contents.begin(), contents.end());
        inside.push_back(static_cast<uint8_t>(0xFF - sum));
        Bytes out = {0x7E};
        for (uint8_t byte : inside) {
            bool special =
                escapes() && (byte == 0x7E || byte == 0x7D || byte == 0x11 || byte == 0x13);
            if (special)
                out.push_back(0x7D);
            out.push_back(special ? byte ^ 0x20 : byte);
        }
        return out;
    }
    void SetUp() override { power({{"AP", GetParam()}}); }
    void api(Bytes contents, uint64_t ns = 0) {
        lineA.send(framed(std::move(contents)), now);
        run(ns);
    }
    Bytes answer() { return std::exchange(lineA.received, {}); }
    Bytes command(Bytes contents) {
        api(std::move(contents), ms);
        return answer();
    }
};

TEST_P(Api, TransmitRequestsAreSentAndTheirStatusReported) {
    const struct {
        Bytes sent;
        std::string atB;
        Bytes answer;
    } cases[] = {
        {{0x01, 0x52, 0, 2, 0, 'h', 0x7E, 0x11, 'i'}, "h\x7E\x11i", framed({0x89, 0x52, 0})},
        {{0x01, 0x07, 0x99, 0x99, 0, 'x'}, "", framed({0x89, 0x07, 1})}, // no receiver
        // this frame requests no status
        {{0x01, 0x00, 0, 2, 0, 'x'}, "x", {}},
        {{0x00, 0x01, 0, 0x13, 0xA2, 0, 0, 0, 0, 0x0B, 0, 'x'}, "x", framed({0x89, 0x01, 0})}};
    for (const auto& c : cases) {
        api(c.sent, 100 * ms);
        EXPECT_EQ(heardB(), c.atB);
        EXPECT_EQ(answer(), c.answer) << c.atB;
    }
}

TEST_P(Api, PacketsWithoutAckAreNotRetried) {
    air.weather.tryLoss = 1;
    api({0x01, 0x01, 0x00, 0x02, 0x01, 'x'}, 100 * ms);
    EXPECT_EQ(air.counters().retries, 0u);
}

TEST_P(Api, TheOptionAllNetworksReachesAnotherNetworkAndIsMarked) {
    power({{"AP", GetParam()}}, {{"AP", GetParam()}, {"ID", 0x1111}});
    api({0x01, 0x01, 0x00, 0x02, 0x04, 'x'}, 100 * ms);
    EXPECT_EQ(answer(), framed({0x89, 0x01, 0}));
    EXPECT_EQ(std::exchange(lineB.received, {}), framed({0x81, 0x00, 0x01, 0x28, 0x04, 'x'}));
}

TEST_P(Api, TheLongBroadcastAddressIsABroadcast) {
    power({{"AP", GetParam()}}, {{"AP", GetParam()}});
    api({0x00, 0x01, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 0, 'x'}, 100 * ms);
    EXPECT_EQ(answer(), framed({0x89, 0x01, 0}));
    EXPECT_EQ(std::exchange(lineB.received, {}), framed({0x81, 0x00, 0x01, 0x28, 0x02, 'x'}));
}

TEST_P(Api, AReceivedPacketHasSourceAndSignal) {
    lineB.send({'h', 'i'}, now);
    run(20 * ms);
    EXPECT_EQ(answer(), framed({0x81, 0x00, 0x02, 0x28, 0x00, 'h', 'i'}));
}

TEST_P(Api, ABroadcastIsMarked) {
    power({{"AP", GetParam()}}, {{"DL", 0xFFFF}});
    lineB.send({'x'}, now);
    run(20 * ms);
    EXPECT_EQ(answer(), framed({0x81, 0x00, 0x02, 0x28, 0x02, 'x'}));
}

TEST_P(Api, CommandsAreAnsweredWithAStatus) {
    // An example in the manual.
    EXPECT_EQ(command({0x08, 0x52, 'D', 'L'}), framed({0x88, 0x52, 'D', 'L', 0, 0, 0, 0, 2}));
    EXPECT_EQ(command({0x08, 0x4D, 'D', 'L', 0x50, 0x00}), framed({0x88, 0x4D, 'D', 'L', 0}));
    EXPECT_EQ(a->parameter("DL"), 0x5000u);
    EXPECT_EQ(command({0x08, 0x01, 'Z', 'Z'}), framed({0x88, 0x01, 'Z', 'Z', 2}));
    EXPECT_EQ(command({0x08, 0x01, 'C', 'H', 0x55}), framed({0x88, 0x01, 'C', 'H', 3}));
}

TEST_P(Api, AQueuedCommandWaitsForAC) {
    command({0x09, 0x01, 'M', 'Y', 0x00, 0x44});
    EXPECT_EQ(a->parameter("MY"), 1u);
    command({0x08, 0x02, 'A', 'C'});
    EXPECT_EQ(a->parameter("MY"), 0x44u);
}

TEST_P(Api, BadFramesAreCountedAndTheNextFrameIsRead) {
    Bytes bad = framed({0x01, 0x00, 0x00, 0x02, 0x00, 'x'});
    bad.back() ^= 1; // checksum
    lineA.send(bad, now);
    lineA.send({'n', 'o', 'i', 's', 'e'}, now);
    lineA.send({0x7E, 0xF0, 0x00}, now); // an impossible length
    api({0x33, 0x00});                   // unknown type
    Bytes longPayload = {0x01, 0x00, 0x00, 0x02, 0x00};
    longPayload.resize(longPayload.size() + 101, 'x');
    api(longPayload);
    EXPECT_EQ(a->counters().badFrames, 4u);
    api({0x01, 0x00, 0x00, 0x02, 0x00, 'o', 'k'}, 20 * ms);
    EXPECT_EQ(heardB(), "ok");
}

TEST_P(Api, AResetIsReported) {
    a->resetPin(true, now);
    run(1000);
    a->resetPin(false, now);
    run(100 * ms);
    EXPECT_EQ(answer(), framed({0x8A, 0x00}));
}

TEST_P(Api, TheCommandSequenceIsIgnored) {
    EXPECT_EQ(enter(), "");
    EXPECT_FALSE(a->inCommandMode());
}

INSTANTIATE_TEST_SUITE_P(Modes, Api, ::testing::Values(1u, 2u));

TEST_P(Api, WithEscapesALostByteLosesOnlyOneFrame) {
    Bytes cut = framed({0x01, 0x00, 0x00, 0x02, 0x00, 'x', 'y', 'z'});
    cut.pop_back();
    lineA.send(cut, now);
    api({0x01, 0x00, 0x00, 0x02, 0x00, 'o', 'k'}, 20 * ms);
    EXPECT_EQ(heardB(), escapes() ? "ok" : "");
}

} // namespace
