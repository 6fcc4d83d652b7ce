// SPDX-License-Identifier: MIT
//
// nets: clocks, resets and the nets with most ends of a Spartan-6 netlist, and where each signal
// stands in the sources.

#pragma once

#include "netlist.h"
#include "timing.h"

#include <map>
#include <string>
#include <vector>

struct Net {
    std::string name; // as the source has it, or "(for) " and what it drives
    std::string kind; // of a reset: synchronous, asynchronous; else the type of the driver's cell
    int ends = 0;     // pins that it drives
    int flipFlops = 0;
    double ns = 0; // of a clock: the longest path that ends with it, grade -3; 0: none
};

struct Nets {
    std::vector<Net> fanouts, clocks, resets;  // most ends first; clocks are no fanouts
    std::map<std::string, std::string> places; // signal -> "hdl/modem/modem.v:97"
};

Nets netsOf(const Netlist& netlist, const std::vector<std::string>& owners, const Timing& timing,
            size_t count = 20);
bool isClock(const std::string& port);
std::string withoutIndex(const std::string& signal); // "u_modem.state[3]" -> "u_modem.state"

// File and line where a signal ("u_modem.state[3]") is declared; of a core in VHDL, where GHDL
// says that it is made: names of intermediate values (n71_o) are GHDL's own. "": not known.
std::string placeOf(const Netlist& netlist, const std::string& signal);
