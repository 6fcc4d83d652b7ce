// SPDX-License-Identifier: MIT
//
// timing: estimates the longest paths of a Spartan-6 netlist, as XST does before placement.
// Cell delays are XST 14.7's for speed grade -3; a net's delay depends on its fan-out alone. Grade
// -2 is slower by slowGrade. Clock skew, pads and placement are unknown here.

#pragma once

#include "netlist.h"

#include <map>
#include <string>
#include <vector>

struct Step {
    std::string cell; // type
    std::string name; // of the net that it drives, "" without a name
    int fanout = 0;
    double delay = 0; // of the net that it drives, "" without a name
    double net = 0;   // ns, of the net behind it
};

struct Path {
    std::string from, to; // registers, memories: as the source names them
    std::string pin;      // that ends the path: D, CE, R, ADDRA, ...
    int levels = 0;       // LUTs, wide multiplexers and carry chains
    double ns = 0;
    std::vector<Step> steps;
};

struct Timing {
    std::vector<Path> paths; // between clocked cells, longest first, one for each end register
    std::vector<int>
        ends; // registers and memories by their longest path, half a ns each, of grade -2
    int inputLevels = 0, outputLevels = 0, throughLevels = 0; // from, to, and between ports
    std::map<int, double> byClock; // registers and memories by their longest path, half a ns each,
                                   // of grade -2
};

constexpr double slowGrade =
    1.2; // -2 over -3, about: DS162 has 0.26 for 0.21 ns (LUT), 0.53 for 0.45 (clock to out)

// `owners`: names for cells without one of their own (owners.h).
Timing timingOf(const Netlist& netlist, const std::vector<std::string>& owners, size_t count = 10);
double netDelay(int fanout); // `owners`: names for cells without one of their own (owners.h).
