// SPDX-License-Identifier: MIT
//
// baseline: the accepted figures of all designs (synth/baseline.json), and growth since.

#pragma once

#include "owners.h"
#include "table.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

struct Accepted {
    int lut = 0, ff = 0, slices = 0, carry = 0, dsp = 0;
    double ram = 0, mhz = 0;
    Costs costs; // LUT, flip-flops, block RAM and DSP only
};

struct Baseline {
    std::string yosys; // version that measured it, "" if there is no baseline
    std::map<std::string, Accepted> designs;
};

Baseline readBaseline(const std::string& text); // throws for malformed text; "" gives an empty one
std::string written(const Baseline& baseline);
Accepted acceptedFrom(const Figures& figures);
AcceptedCounts countsOf(const Baseline& baseline);
std::string shortVersion(const std::string& yosys); // "Yosys 0.23"

// A signal or a module whose cost has changed.
struct Change {
    std::string name;
    Cost before, after;
    int grown() const { return after.lut + after.ff - before.lut - before.ff; }
};
// Largest growth first; those that shrank come last.
std::vector<Change> changedSignals(const Costs& before, const Costs& after);
std::vector<Change> changedInstances(const Costs& before, const Costs& after);

// Findings of a design: errors, and notes that only tell.
struct Verdict {
    std::vector<std::string> failures, notes;
};
// Judges a design. Its budget is a little more than the accepted figure, since optimisation is a
// heuristic: 3 % + 4 LUTs, 1 % + 2 flip-flops. A limit must be kept, whatever is accepted. So must
// the clock (`goal`, MHz) by a design that was accepted with it; one that was accepted below it may
// lose a tenth.
Verdict judge(const Row& row, const Baseline& baseline, const std::string& yosys, double goal);
// Returns a sentence for each limit of synth/designs.json that is exceeded.
std::vector<std::string> aboveLimits(const Row& row);
int lutBudget(int accepted);
int ffBudget(int accepted);
