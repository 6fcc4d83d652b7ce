// SPDX-License-Identifier: MIT
//
// wire_fault: parses a fault of a board, as written in the option --fault of the simulator and of
// the simulated self-test:
//
//     D3:open  A5:stuck0  A5:stuck1  IRQ:pull0  IRQ:pull1  D1-D2:short  D0-D1:swapped
//     NWAIT:inverted  NWE:ringing  NWE:late=12ns  D:second-driver  D:shifted  A:shifted
//     BANK1:unpowered  CLK:none  CLK:off=2%  DDR_A5:open  MODEM_CTS:open  MODEM:none

#pragma once

#include <string>
#include <vector>

struct WireFault {
    enum Kind {
        Open,
        Stuck0,
        Stuck1,
        Pull0, // another part pulls the line, more strongly than the pulls of the chips
        Pull1,
        Short,
        Swapped,
        Inverted,
        Ringing, // each rising edge arrives twice
        Late,
        Missing,
        Off,
        SecondDriver, // another memory, which answers to the same chip select, drives the data
        Shifted,      // D: a read returns the halfword of the previous read; A: each address line
                      // is wired to the next number
        Unpowered     // a bank of the FPGA without its supply
    };
    // wire, and the other wire of a pair; `other` is empty for a single wire
    std::string wire, other;
    Kind kind = Open;
    double value = 0; // delay of a late wire, ns; error of a clock, percent

    // Parses one fault. Throws std::runtime_error with the expected form and the nearest name.
    static WireFault parse(const std::string& text);
    // Parses faults that are separated by spaces.
    static std::vector<WireFault> parseAll(const std::string& texts);
    // Returns the name of the wire, or of the pair, as in the report: "D1-D2".
    std::string name() const { return other.empty() ? wire : wire + "-" + other; }
    // Returns the text that parse() reads.
    std::string text() const;

    bool isMemory() const { return wire.rfind("DDR_", 0) == 0; }
    // Returns the number of a bank of the FPGA, or -1.
    int bank() const { return kind == Unpowered ? wire.back() - '0' : -1; }
};
