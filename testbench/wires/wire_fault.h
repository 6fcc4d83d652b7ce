// SPDX-License-Identifier: MIT
//
// wire_fault: a fault of a wire, as --wire names it.
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
    std::string wire, other; // other: of a pair, else empty
    Kind kind = Open;
    double value = 0; // Late: ns; Off: percent

    // Reads one fault. Throws std::runtime_error with the expected form.
    static WireFault parse(const std::string& text);
    // The name of a wire, or of a pair in alphabetical order of the report: "D1-D2".
    std::string name() const { return other.empty() ? wire : wire + "-" + other; }
};
