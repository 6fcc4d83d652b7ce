// SPDX-License-Identifier: MIT
//
// owners: the owner of each cell in a flat netlist: an instance path and a signal of the source.

#pragma once

#include "netlist.h"

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

struct Cost {
    int lut = 0;    // look-up tables, those used as memory included
    int memory = 0; // of these, used as memory or shift register
    int ff = 0;     // flip-flops and latches
    int carry = 0;  // carry chain segments of 4 bits
    double ram = 0; // block RAMs of 16 or 18 Kbit; half ones count half
    int dsp = 0;

    Cost& operator+=(const Cost& o);
    bool empty() const { return lut == 0 && ff == 0 && carry == 0 && ram == 0 && dsp == 0; }
};

// (instance path, "" for the top; signal) -> cost. A flip-flop belongs to its register. Logic
// belongs to the named wire that it drives; where optimisation has left no name, to the owner of
// most logic behind it.
using Costs = std::map<std::pair<std::string, std::string>, Cost>;

// Files (names only) of the modules along an instance path, the top's included.
using FilesAlong = std::function<std::set<std::string>(const std::string& path)>;

// Returns, for each cell, the signal with its path, "u_modem.u_at.state"; "" without a name nearby.
std::vector<std::string> ownersOf(const Netlist& netlist, const FilesAlong& filesAlong);
Costs costsOf(const Netlist& netlist, const std::vector<std::string>& owners);
Cost costOf(const Cell& cell);
std::pair<std::string, std::string> splitName(const std::string& name); // path, signal
