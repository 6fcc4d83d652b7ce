// SPDX-License-Identifier: MIT
//
// board_test: tests that the firmware can fly with the kit's generated pins and each of the modems
// that can be bought. Also tests that a flight fails if a pair of wires is swapped, an alternate
// function is wrong, a bank has no supply, or a location in the constraints is wrong, and that it
// ends as expected with planted faults of wires, clock, memory and modem.

#include "board_faults.h"
#include "ground.h"
#include "m3_machine.h"
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <regex>

namespace {

std::string textOf(const std::string& file) {
    std::ifstream in(std::string(BOARD_FOLDER) + "/" + file);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Replaces a text by another one. The text must exist.
std::string with(std::string text, const std::string& old, const std::string& other) {
    const size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return at == std::string::npos ? text : text.replace(at, old.size(), other);
}

// Swaps two words of a text.
std::string swapped(const std::string& text, const std::string& a, const std::string& b) {
    return with(with(with(text, a, "@"), b, a), "@", b);
}

struct Board {
    std::string wires = textOf("board.wires"), ucf = textOf("board.ucf");
    // Returns whether the data lines also carry the low half of the address.
    bool isMuxed() const { return wires.find("\nmuxed 1\n") != std::string::npos; }
};

// Flies on a board with faults until a call has been answered, the firmware has stopped trying, or
// the time has elapsed. Returns true if the call was answered.
bool answersACall(const Board& board, double seconds, const std::string& faults = "") {
    GroundAndChip flight;
    flight.soc.wires() = BoardWires(board.wires, board.ucf);
    plantFaults(flight.soc, WireFault::parseAll(faults));
    flight.soc.reset(true);
    auto script = flight.ground.pinging(1);
    bool isAnswered = false;
    M3Machine* running = nullptr;
    M3Machine machine(flight.soc, {FIRMWARE_ELF, 120'000'000, Ground::guardMs}, [&] {
        isAnswered = isAnswered || script();
        const Stm32F2::Resets& resets = running->stm32().resets();
        return !isAnswered && resets.software + resets.watchdog == 0 && flight.within(seconds);
    });
    running = &machine;
    machine.run();
    testing::Test::RecordProperty("ms", static_cast<int>(flight.soc.now() / 1'000'000));
    return isAnswered;
}

constexpr double enough = 3; // time limit, s; on a correct board the answer comes after 1.3 s

TEST(BoardWires, AreStraightOnceTheFirmwareHasSetTheAlternateFunctions) {
    Board kit;
    BoardWires wires(kit.wires, kit.ucf);
    EXPECT_TRUE(wires.isStraight()) << "without a list of pins, all pins count as switched";
    bool isAlternate = false;
    wires.follow([&](unsigned, unsigned) {
        PinSetting setting;
        setting.mode = isAlternate ? PinSetting::Alternate : PinSetting::Input;
        setting.function = 12;
        return setting;
    });
    EXPECT_FALSE(wires.isStraight());
    FsmcPins near;
    near.neN = 0xE; // NE1
    near.noeN = false;
    EXPECT_EQ(wires.atChip(near).neN & 3, 3)
        << "the pull-ups of the chip must keep the other lines high";
    EXPECT_TRUE(wires.atChip(near).noeN);
    isAlternate = true;
    for (unsigned port = 0; port < 9; ++port)
        wires.changed(port);
    EXPECT_TRUE(wires.isStraight());
    EXPECT_EQ(wires.oscillatorHz(), 8'000'000u);
    EXPECT_TRUE(wires.areOthersStraight());
    EXPECT_EQ(wires.modem(), "xb3");
    EXPECT_EQ(wires.isMuxed(), kit.isMuxed());
}

TEST(BoardWires, ASwappedPairExchangesItsLevels) {
    Board board;
    board.ucf = swapped(board.ucf, "\"E12\"", "\"E13\""); // swaps the locations of D0 and D1
    BoardWires wires(board.wires, board.ucf);
    EXPECT_FALSE(wires.isStraight());
    FsmcPins near;
    near.d = 0x8001;
    near.dOut = true;
    EXPECT_EQ(wires.atChip(near).d, 0x8002);
    FsmcPins chip, back;
    (void)wires.atChip(back);
    chip.dFromDesign = 0x4002;
    chip.dDriven = true;
    wires.toProcessor(chip, back);
    EXPECT_EQ(back.dFromDesign, 0x4001);
}

TEST(BoardWires, AnInvalidLineIsReported) {
    try {
        BoardWires("PD14 12 FSMC_D0\n", "");
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_STREQ(e.what(), "board.wires: expected pin, number, function, net, ball, bank and "
                               "volts, got 'PD14 12 FSMC_D0'");
    }
}

TEST(BoardFlight, TheKitAnswersACallThroughItsGeneratedPins) {
    EXPECT_TRUE(answersACall({}, enough));
}

// a board on which no call is answered: its name, and its fault
struct WrongBoard {
    const char* name;
    void (*spoil)(Board& board);
    friend void PrintTo(const WrongBoard& wrong, std::ostream* out) { *out << wrong.name; }
};
const WrongBoard wrongBoards[] = {
    {"TwoDataWiresInEachOthersPlaces",
     [](Board& board) { board.wires = swapped(board.wires, " E12 ", " E13 "); }},
    {"TwoAddressPlacesSwappedInTheConstraints", // swaps the locations of A0 and A1
     [](Board& board) {
         if (board.isMuxed()) // A0 and A1 are on the data lines D0 and D1
             board.ucf = swapped(board.ucf, "\"E12\"", "\"E13\"");
         else
             board.ucf = swapped(board.ucf, "\"K15\"", "\"K16\"");
     }},
    {"ASignalOnAnotherAlternateFunction",
     [](Board& board) { board.wires = with(board.wires, "PD4 12 FSMC_NOE", "PD4 11 FSMC_NOE"); }},
    {"ABankWithoutSupply",
     [](Board& board) {
         const std::regex bank1("( [B-T][0-9]+ 1) 3.3\n");
         board.wires = std::regex_replace(board.wires, bank1, "$1 0\n");
     }},
    {"NoWireForTheModemsData",
     [](Board& board) { board.wires = with(board.wires, "DOUT - - MODEM_RXD N9 2 3.3\n", ""); }},
    {"AnotherBallForTheInterrupt", [](Board& board) {
         board.ucf = with(board.ucf, "NET \"irq_o\" LOC = \"K11\"", "NET \"irq_o\" LOC = \"T14\"");
     }}};

class BoardFlights : public testing::TestWithParam<WrongBoard> {};
INSTANTIATE_TEST_SUITE_P(With, BoardFlights, testing::ValuesIn(wrongBoards),
                         [](const auto& each) { return each.param.name; });

TEST_P(BoardFlights, AFaultyBoardAnswersNoCall) {
    Board board;
    GetParam().spoil(board);
    EXPECT_FALSE(answersACall(board, enough));
}

// Faults of the kit, each with whether a call is still answered.
struct FaultyBoard {
    const char* fault;
    bool answers;
    friend void PrintTo(const FaultyBoard& board, std::ostream* out) { *out << board.fault; }
};
const FaultyBoard faultyBoards[] = {{"D3:open", false},
                                    {"NE2:stuck1", false},
                                    {"D1-D2:short", false},
                                    {"D0-D1:swapped", false},
                                    {"NWAIT:inverted", false},
                                    {"NWE:ringing", true},
                                    {"D:second-driver", false},
                                    {"D:shifted", false},
                                    {"A:shifted", false},
                                    {"BANK1:unpowered", false},
                                    {"BANK2:unpowered", false},
                                    {"CLK:none", false},
                                    {"CLK:off=12%", false},
                                    {"DDR_DQ3:stuck0", false},
                                    {"IRQ:stuck0", false},
                                    {"IRQ:inverted", false},
                                    {"MODEM_RXD:open", false},
                                    {"MODEM_CTS:open", true},
                                    {"MODEM_RXD-MODEM_TXD:swapped", false},
                                    {"MODEM:none", false},
                                    {"IRQ:pull0", true},
                                    {"NADV:open", true},
                                    {"CLK:off=2%", true}};

class FaultFlights : public testing::TestWithParam<FaultyBoard> {};
INSTANTIATE_TEST_SUITE_P(With, FaultFlights, testing::ValuesIn(faultyBoards), [](const auto& each) {
    return std::regex_replace(std::string(each.param.fault), std::regex("[^A-Za-z0-9]+"), "_");
});

// Returns whether a call is answered on the kit's board, in spite of the fault. On a multiplexed
// board, the flight needs NADV, and only address lines that carry zeros in this flight can be
// shifted. On the other board, NADV has no wire.
bool isExpectedToAnswer(const FaultyBoard& board) {
    const std::string fault = board.fault;
    if (!Board().isMuxed())
        return board.answers;
    return fault != "NADV:open" && (fault == "A:shifted" || board.answers);
}

// Tests that each flight ends as expected. If an access waits for ever, an error ends the flight.
TEST_P(FaultFlights, AFlightEndsAsItsFaultImplies) {
    bool isAnswered = false;
    try {
        isAnswered = answersACall({}, 1.6, GetParam().fault);
    } catch (const FsmcError& e) {
        EXPECT_NE(std::string(e.what()).find("NWAIT has been active for"), std::string::npos)
            << e.what();
    }
    EXPECT_EQ(isAnswered, isExpectedToAnswer(GetParam()));
}

// Flies the mission with the pins of the kit and each modem: the controller sets the modem up by AT
// commands, then a parameter is set, and a picture's result and telemetry are fetched.
class ModemFlights : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(With, ModemFlights, testing::Values("s1", "s2c", "xb3"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(ModemFlights, TheMissionSucceedsWithEachModem) {
    GroundAndChip flight(testSeed(), GetParam());
    flight.soc.reset(true);
    flight.provide(48, 32, [](uint32_t i) { return static_cast<uint8_t>(i % 7 ? 0 : 200); });
    auto mission = flight.ground.calling({{"hwengine1", "ice_ping", 2},
                                          {"hwengine1", "setParameterA", 0, {30, 0}},
                                          {"hwengine1", "startProcessing"},
                                          {"hwengine1", "getResult"},
                                          {"uav", "isAlive", 0, {7, 0}}});
    uint64_t upNs = 0;
    M3Machine machine(flight.soc, {FIRMWARE_ELF, 120'000'000, Ground::guardMs}, [&] {
        upNs = !upNs && flight.ground.isUp() ? flight.soc.now() : upNs;
        return !mission() && flight.within(10);
    });
    machine.run();
    EXPECT_TRUE(flight.soc.wires().isStraight());
    ASSERT_EQ(flight.ground.replies.size(), 5u);
    for (const auto& [id, status] : flight.ground.replies)
        EXPECT_EQ(status, 0) << id;
    const XBee& modem = flight.soc.modem();
    EXPECT_STREQ(modem.profile().name, GetParam());
    EXPECT_EQ(modem.baud(), 250'000);
    EXPECT_EQ(modem.parameter("AP"), 1u);
    EXPECT_EQ(modem.counters().refused, 0u);
    EXPECT_EQ(modem.counters().overflow, 0u);
    RecordProperty("busCycles", std::to_string(machine.cpu().busCycles()));
    RecordProperty("accesses", std::to_string(flight.soc.fsmc().accesses()));
    RecordProperty("upMs", static_cast<int>(upNs / 1'000'000));
    RecordProperty("ms", static_cast<int>(flight.soc.now() / 1'000'000));
}

TEST(BoardFlight, AnUnsupportedOscillatorIsReported) {
    Board board;
    board.wires = with(board.wires, "oscillator 8000000", "oscillator 25000000");
    try {
        (void)answersACall(board, enough);
        FAIL() << "a PLL with an input of 3 MHz was accepted";
    } catch (const std::exception& e) {
        EXPECT_NE(std::string(e.what()).find("PLL input of 3125 kHz"), std::string::npos)
            << e.what();
    }
}

} // namespace
