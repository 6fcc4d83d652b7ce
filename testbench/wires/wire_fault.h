// SPDX-License-Identifier: MIT
//
// wire_fault: parses a fault of a wire, as written in the option --wire:
//
//     D3:open  A5:stuck0  A5:stuck1  D1-D2:short  D0-D1:swapped  NWAIT:inverted  NWE:ringing
//     NWE:late=12ns  CLK:none  CLK:off=2%  D:second-driver  D:shifted  MODEM:none

#pragma once

#include <string>

struct WireFault {
    enum Kind {
        Open,
        Stuck0,
        Stuck1,
        Short,
        Swapped,
        Inverted,
        Ringing,
        Late,
        Missing,
        Off,
        SecondDriver,
        Shifted
    };
    // wire, and the other wire of a pair; `other` is empty for a single wire
    std::string wire, other;
    Kind kind = Open;
    double value = 0; // delay of a late wire, ns; error of a clock, percent

    // Parses one fault. Throws std::runtime_error, whose text shows the expected form.
    static WireFault parse(const std::string& text);
    // Returns the name of the wire, or of the pair, as in the report: "D1-D2".
    std::string name() const { return other.empty() ? wire : wire + "-" + other; }
};
