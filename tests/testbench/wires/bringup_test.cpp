// SPDX-License-Identifier: MIT
//
// bringup_test: tests that the self-test of a new board (sw/bringup) names the wire of every
// planted fault.

#include "chip_kit.h"
#include "line_kit.h"
#include <gtest/gtest.h>
#include <iostream>

extern "C" {
#include "bringup_pins.h"
}

namespace {

constexpr uint32_t wires = 1, clocks = 2, modemWires = 4, bus = 8, memory = 16, timing = 32,
                   all = ~0u; // BRINGUP_...

struct Limits { // Bringup_Limits
    uint32_t steps, modemBootMs = 2, guardMs = 20, patternKib = 1, retentionMs = 1;
};

// Runs the self-test with line_tester and one fault; "" is a board without faults.
std::string report(const std::string& fault, uint32_t steps, const char* elf = BRINGUP_FLASH_ELF) {
    LineKit::Options options;
    if (!fault.empty())
        options.faults.push_back(WireFault::parse(fault));
    LineKit kit(options);
    kit.onStart([steps](Stm32F2& stm32) {
        const Limits limits{steps};
        stm32.cpu().writeMemory(stm32.image()->symbol("bringup_limits"), &limits, sizeof limits);
    });
    const std::string text = kit.run(elf, 500);
    if (fault.empty()) {
        EXPECT_EQ(kit.wires().fights(), 0u) << "two drivers on one wire";
    }
    return text;
}

// Returns the name of the wire and the kind of each failure, as in "D3 open".
std::vector<std::string> failures(const std::string& text) {
    std::vector<std::string> found;
    std::istringstream lines(text);
    for (std::string line, word, step, wire, kind; std::getline(lines, line);) {
        std::istringstream words(line);
        if (words >> word >> step >> wire >> kind && word == "FAIL")
            found.push_back(wire + " " + kind.substr(0, kind.find(':')));
    }
    return found;
}

std::vector<std::string> wiredLines() {
    std::vector<std::string> names;
#define LINE(name, place)                        \
    if (std::pair<int, int>{place}.first != 255) \
        names.push_back(#name);
    BRINGUP_LINES(LINE)
#undef LINE
    return names;
}

// Expects that the report of a board with this fault names this failure and no other one.
void expectNamed(uint32_t steps, const std::string& fault, const std::string& expected) {
    const std::string text = report(fault, steps);
    EXPECT_NE(text.find("\nEND "), std::string::npos) << fault << ": the self-test hangs";
    EXPECT_EQ(failures(text), std::vector<std::string>{expected}) << fault << ":\n" << text;
}

TEST(Bringup, FindsEachOpenLine) {
    for (const std::string& line : wiredLines())
        expectNamed(wires, line + ":open", line + " open");
}

TEST(Bringup, FindsEachStuckLine) {
    bool high = false;
    for (const std::string& line : wiredLines()) {
        const std::string kind = (high = !high) ? "stuck1" : "stuck0";
        expectNamed(wires, line + ":" + kind, line + " " + kind);
    }
}

TEST(Bringup, FindsEachShortBetweenNeighbours) {
    const std::vector<std::string> lines = wiredLines();
    for (size_t i = 0; i + 1 < lines.size(); i += 2) {
        const std::string pair = lines[i] + "-" + lines[i + 1];
        expectNamed(wires, pair + ":short", pair + " short");
    }
}

TEST(Bringup, FindsEachSwapOfNeighbours) {
    const std::vector<std::string> lines = wiredLines();
    for (size_t i = 0; i + 1 < lines.size(); i += 2) {
        const std::string pair = lines[i] + "-" + lines[i + 1];
        expectNamed(wires, pair + ":swapped", pair + " swapped");
    }
}

TEST(Bringup, FindsFaultsBetweenDistantLines) {
    for (const std::string pair :
         {"NWAIT-IRQ", "NE1-NWE", "NOE-NWE", "D0-IRQ", "A16-NWAIT", "NE2-NBL0"})
        expectNamed(wires, pair + ":swapped", pair + " swapped");
    for (const std::string pair : {"NWAIT-IRQ", "D15-A24", "D0-NWAIT", "NE1-NBL0"})
        expectNamed(wires, pair + ":short", pair + " short");
}

TEST(Bringup, FindsInvertedAndRingingLines) {
    expectNamed(all, "NWAIT:inverted", "NWAIT inverted");
    expectNamed(all, "IRQ:inverted", "IRQ inverted");
    expectNamed(all, "NWE:ringing", "NWE ringing");
}

TEST(Bringup, FindsLinesPulledByAnotherPart) {
    for (const std::string line :
         {"IRQ:pull0", "D13:pull1", "A24:pull0", "NOE:pull1", "NWAIT:pull0", "NWAIT:pull1"})
        expectNamed(wires, line,
                    line.substr(0, line.find(':')) + " pulled" + std::string(1, line.back()));
}

// Replaces the code of a step by a loop that never ends.
TEST(Bringup, EndsAStepThatHangs) {
    LineKit kit({});
    kit.onStart([](Stm32F2& stm32) {
        const struct {
            Limits limits{wires};
            uint32_t watchdogMs = 40;
        } limits;
        stm32.cpu().writeMemory(stm32.image()->symbol("bringup_limits"), &limits, sizeof limits);
        const uint16_t loop = 0xE7FE; // b .
        stm32.cpu().writeMemory(stm32.image()->symbol("Lines_testThrough") & ~1u, &loop, 2);
    });
    const std::string text = kit.run(BRINGUP_FLASH_ELF, 500);
    EXPECT_EQ(failures(text), std::vector<std::string>{"MCU hung"}) << text;
    EXPECT_NE(text.find("FAIL shorts MCU hung: the watchdog has ended the step"), std::string::npos)
        << text;
    EXPECT_NE(text.find("END 1"), std::string::npos) << text;
}

TEST(Bringup, FindsAnotherMemoryOnTheBus) {
    expectNamed(all, "D:second-driver", "D second-driver");
}

TEST(Bringup, FindsShiftedAddressLines) {
    expectNamed(all, "A:shifted", BOARD_MUXED ? "A16-A24 shifted" : "A0-A24 shifted");
}

TEST(Bringup, FindsAnUnpoweredBank) {
    expectNamed(clocks, "BANK0:unpowered", "CLK no-clock");
    EXPECT_NE(report("BANK0:unpowered", clocks).find("the supply of bank 0"), std::string::npos);
    expectNamed(all, "BANK1:unpowered", "FPGA silent");
    EXPECT_NE(report("BANK1:unpowered", wires).find("VCCO of bank 1"), std::string::npos);
    expectNamed(modemWires, "BANK2:unpowered", "BANK2 no-supply");
}

TEST(Bringup, FindsAMissingOrWrongClock) {
    expectNamed(clocks, "CLK:none", "CLK no-clock");
    expectNamed(clocks, "CLK:off=2%", "CLK wrong-rate");
    expectNamed(clocks, "CLK:off=-2%", "CLK wrong-rate");
}

TEST(Bringup, FindsFaultsOfEachModemLine) {
    expectNamed(modemWires, "MODEM:none", "MODEM silent");
    for (const std::string line : {"RXD", "TXD", "CTS", "RTS", "RESET"})
        for (const std::string kind : {"open", "stuck0", "stuck1"})
            expectNamed(modemWires, "MODEM_" + line + ":" + kind, "MODEM_" + line + " " + kind);
    for (const std::string pair : {"RXD-MODEM_TXD", "CTS-MODEM_RTS", "RXD-MODEM_CTS"})
        expectNamed(modemWires, "MODEM_" + pair + ":swapped", "MODEM_" + pair + " swapped");
    for (const std::string pair : {"RXD-MODEM_TXD", "CTS-MODEM_RTS"})
        expectNamed(modemWires, "MODEM_" + pair + ":short", "MODEM_" + pair + " short");
}

// Tests that the error for a wrong text states the expected form and the nearest name.
TEST(WireFault, NamesTheExpectedForm) {
    const std::pair<const char*, const char*> cases[] = {
        {"D3", "fault D3: expected WIRE:FAULT, such as D3:open or D1-D2:short"},
        {"D33:open", "fault D33:open: expected a wire such as D3, A24, NWE, MODEM_CTS or DDR_A5, "
                     "got 'D33'; did you mean D3?"},
        {"NWIAT:open", "fault NWIAT:open: expected a wire such as D3, A24, NWE, MODEM_CTS or "
                       "DDR_A5, got 'NWIAT'; did you mean NWAIT?"},
        {"D3:opne", "fault D3:opne: expected open, stuck0, stuck1, pull0, pull1, short, swapped, "
                    "inverted or late, got 'opne'; did you mean open?"},
        {"CLK:open", "fault CLK:open: expected none or off, got 'open'"},
        {"NWE-NOE:ringing", "fault NWE-NOE:ringing: expected open, stuck0, stuck1, pull0, pull1, "
                            "short, swapped, inverted or late, got 'ringing'"},
        {"D1:short", "fault D1:short: expected two wires, such as D1-D2, got 'D1'"},
        {"D1-D1:short", "fault D1-D1:short: expected two different wires, got 'D1-D1'"},
        {"D1-D2:open", "fault D1-D2:open: expected one wire, got 'D1-D2'"},
        {"NWE:late", "fault NWE:late: expected a value, such as late=2ns, got 'late'"},
        {"NWE:late=12", "fault NWE:late=12: expected at most 50 ns, such as 2ns, got '12'"},
        {"NWE:late=-1ns", "fault NWE:late=-1ns: expected at most 50 ns, such as 2ns, "
                          "got '-1ns'"},
        {"D3:open=1", "fault D3:open=1: expected no value, got 'open=1'"}};
    for (const auto& [text, expected] : cases) {
        try {
            (void)WireFault::parse(text);
            ADD_FAILURE() << text;
        } catch (const std::runtime_error& e) {
            EXPECT_STREQ(e.what(), expected);
        }
    }
    for (const std::string text : {"D1-D2:short", "CLK:off=-2%", "NWE:late=12ns", "A:shifted"})
        EXPECT_EQ(WireFault::parse(text).text(), text);
    EXPECT_EQ(WireFault::parseAll("D3:open  BANK1:unpowered").at(1).bank(), 1);
}

// ---- chip ----

std::string chipReport(const std::string& fault, uint32_t steps) {
    XBee::Options modem;
    modem.set["GT"] = 10;
    std::vector<WireFault> faults;
    if (!fault.empty())
        faults.push_back(WireFault::parse(fault));
    ChipKit kit(faults, modem);
    return kit.run(BRINGUP_FLASH_ELF, 5000, [steps](Stm32F2& stm32) {
        const Limits limits{steps};
        stm32.cpu().writeMemory(stm32.image()->symbol("bringup_limits"), &limits, sizeof limits);
    });
}

void expectNamedWithChip(uint32_t steps, const std::string& fault, const std::string& expected) {
    const std::string text = chipReport(fault, steps);
    EXPECT_NE(text.find("\nEND "), std::string::npos) << fault << ": the self-test hangs";
    EXPECT_EQ(failures(text), std::vector<std::string>{expected}) << fault << ":\n" << text;
}

TEST(Bringup, FindsDataShiftedByAHalfword) {
    expectNamedWithChip(all, "D:shifted", "D shifted");
}

TEST(Bringup, FindsALateStrobe) {
    expectNamedWithChip(bus, "NWE:late=12ns", "NWE late");
    for (const std::string line : {"NOE", "NE1", "NE2", "NWAIT"})
        expectNamedWithChip(memory | timing, line + ":late=20ns", line + " late");
#if BOARD_MUXED
    for (const std::string late : {"20", "40"})
        expectNamedWithChip(memory | timing, "NADV:late=" + late + "ns", "NADV late");
#endif
}

// Tests only some of the data and address lines, because each test of a board with the chip takes
// half a second.
TEST(Bringup, FindsFaultyMemoryLines) {
    for (unsigned line : {0, 7, 8, 15}) {
        const std::string name = "DDR_DQ" + std::to_string(line);
        expectNamedWithChip(memory, name + (line % 2 ? ":stuck0" : ":open"),
                            name + (line % 2 ? " stuck0" : " stuck1"));
    }
    for (unsigned line : {0, 5, 9, 12}) {
        const std::string name = "DDR_A" + std::to_string(line);
        expectNamedWithChip(memory, name + ":open", name + " stuck");
    }
    for (const std::string name : {"DDR_BA0", "DDR_BA2"})
        expectNamedWithChip(memory, name + ":open", name + " stuck");
    for (const std::string name : {"DDR_LDM", "DDR_UDM"})
        for (const std::string kind : {"stuck0", "stuck1"})
            expectNamedWithChip(memory, name + ":" + kind, name + " " + kind);
    for (const std::string name : {"DDR_LDQS", "DDR_UDQS"})
        expectNamedWithChip(memory, name + ":open", name + " open");
    for (const std::string pair : {"DDR_DQ3-DDR_DQ4", "DDR_A5-DDR_A6", "DDR_BA0-DDR_BA1"})
        expectNamedWithChip(memory, pair + ":short", pair + " short");
    for (const std::string fault : {"DDR_CK:open", "BANK3:unpowered"})
        expectNamedWithChip(memory, fault, "DDR no-calibration");
}

TEST(Bringup, AGoodBoardPassesWithTheChip) {
    const std::string text = chipReport("", all);
    EXPECT_NE(text.find("END 0"), std::string::npos) << text;
    EXPECT_NE(text.find("PASS modem"), std::string::npos) << text;
}

TEST(Bringup, AGoodBoardPasses) {
    for (const char* elf : {BRINGUP_ELF, BRINGUP_FLASH_ELF}) {
        const std::string text = report("", all, elf);
        EXPECT_NE(text.find("END 0"), std::string::npos) << elf << ":\n" << text;
    }
}

} // namespace
