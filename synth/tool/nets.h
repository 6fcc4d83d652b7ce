// SPDX-License-Identifier: MIT
//
// nets: clocks, resets and widest nets of a Spartan-6 netlist, and the place of each signal in the
// sources.

#pragma once

#include "netlist.h"
#include "timing.h"

#include <map>
#include <string>
#include <vector>

struct Net {
    std::string name; // the source's name, or "(for) " and the driven one
    std::string kind; // of a reset: synchronous, asynchronous; else the type of the driver's cell
    int ends = 0;     // pins that it drives
    int flipFlops = 0;
    double ns = 0; // of a clock: the longest path that ends with it, grade -3; 0: none
};

struct Nets {
    std::vector<Net> fanouts, clocks, resets;  // widest first; clocks are no fanouts
    std::map<std::string, std::string> places; // signal -> "hdl/modem/modem.v:97"
};

Nets netsOf(const Netlist& netlist, const std::vector<std::string>& owners, const Timing& timing,
            size_t count = 20);
bool isClock(const std::string& port);
std::string withoutIndex(const std::string& signal); // "u_modem.state[3]" -> "u_modem.state"

// File and line of a signal's declaration ("u_modem.state[3]"); for a core in VHDL the line that
// GHDL gives: names of intermediate values (n71_o) are GHDL's own. "": unknown.
std::string placeOf(const Netlist& netlist, const std::string& signal);
