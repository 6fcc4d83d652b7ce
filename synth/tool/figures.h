// SPDX-License-Identifier: MIT
//
// figures: the cost of one design on one chip family: the result of a synthesis run.

#pragma once

#include "nets.h"
#include "owners.h"
#include "slices.h"
#include "timing.h"

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

struct Figures {
    std::map<std::string, int> cells; // by type, as Yosys names them
    int lut = 0;                      // all look-up tables, those used as memory included
    int lutRam = 0;                   // of these: memory
    int shift = 0;                    // of these: shift registers
    int ff = 0;                       // flip-flops and latches
    int carry = 0;                    // carry chain segments of four bits (ECP5: two)
    double ram = 0;                   // block RAMs of 16 or 18 Kbit; half ones count half
    int dsp = 0;
    int pins = 0;  // ports that leave the chip: not those of the memory controller (mcb_*)
    Slices slices; // not for ECP5
    Timing timing; // only for Spartan-6
    Nets nets;     // the same
    Costs costs;

    // LUTs and clock() of the netlist in other orders; this one has the median of LUTs.
    std::vector<int> otherLuts;
    std::vector<double> clocks;

    // Clock rate that the longest path allows, MHz; 0 if there is no path. At the slower speed
    // grade.
    double clock() const;
    // The median of all orders' clocks, which is judged; the slowest and the fastest of them.
    double mhz() const;
    std::pair<double, double> mhzRange() const;
    int luts(int inputs) const; // logic LUTs with this many inputs
};

Figures figuresOf(const Netlist& netlist, bool spartan6, const FilesAlong& filesAlong);

void to_json(nlohmann::json& j, const Timing& t);
void from_json(const nlohmann::json& j, Timing& t);
void to_json(nlohmann::json& j, const Figures& f);
void from_json(const nlohmann::json& j, Figures& f);
