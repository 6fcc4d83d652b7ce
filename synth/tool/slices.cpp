// SPDX-License-Identifier: MIT
//
// slices: estimates the slices of four LUT6 and eight flip-flops of a netlist
// (docs/utilisation.md).
// (docs/utilisation.md).

#include "slices.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

namespace {

constexpr int sitesPerSlice = 4, flipFlopsPerSlice = 8, muxesPerSlice = 2, sharedInputs = 5;

int upTo(int n, int unit) {
    return (n + unit - 1) / unit;
}

std::set<int> inputsOf(const Cell& cell) {
    std::set<int> bits;
    for (const Pin& pin : cell.pins)
        for (const int bit : pin.bits)
            if (!pin.output && bit >= 0)
                bits.insert(bit);
    return bits;
}

// LUT6 sites for these LUTs: two share one if together they have at most five inputs. Greedy, the
// partner with most inputs in common first; LUTs without common inputs stay apart, as in map.
int sitesFor(const std::vector<std::set<int>>& luts) {
    std::unordered_map<int, std::vector<size_t>> readers;
    for (size_t i = 0; i < luts.size(); i++)
        if (luts[i].size() <= sharedInputs)
            for (const int bit : luts[i])
                readers[bit].push_back(i);
    std::vector<bool> placed(luts.size());
    int sites = 0;
    for (size_t i = 0; i < luts.size(); i++) {
        if (placed[i])
            continue;
        placed[i] = true;
        sites++;
        if (luts[i].size() > sharedInputs)
            continue;
        std::map<size_t, int> common;
        for (const int bit : luts[i])
            if (readers[bit].size() <= 64) // a reset's readers are no neighbours
                for (const size_t k : readers[bit])
                    if (!placed[k])
                        common[k]++;
        size_t best = i;
        int bestCommon = 1; // at least two inputs in common
        for (const auto& [k, count] : common)
            if (count > bestCommon &&
                static_cast<int>(luts[i].size() + luts[k].size()) - count <= sharedInputs) {
                best = k;
                bestCommon = count;
            }
        placed[best] = true;
    }
    return sites;
}

} // namespace

double occupiedSlices(double sites, double flipFlops, double share) {
    return (sites + share * flipFlops) / sitesPerSlice;
}

Slices slicesOf(const Netlist& n) {
    Slices s;
    std::vector<std::set<int>> luts;
    std::map<std::tuple<int, int, int>, std::pair<int, int>> sets; // (pairs, others)
    int memory = 0, carry = 0, carrySites = 0, wide = 0, flipFlops = 0;

    for (const Cell& cell : n.cells) {
        if (lutInputs(cell.type) != 0) {
            luts.push_back(inputsOf(cell));
        } else if (memoryLuts(cell.type) != 0) {
            memory += memoryLuts(cell.type);
        } else if (isShiftRegister(cell.type)) {
            memory++;
        } else if (cell.type == "MUXF7") {
            wide++;
        } else if (cell.type == "CARRY4") {
            carry++;
            // A carry bit whose S is no LUT of its own takes a site as a route-through.
            for (const int bit : cell.pin("S")->bits) {
                const auto it = n.driver.find(bit);
                if (bit >= 0 && (it == n.driver.end() || lutInputs(n.cells[it->second].type) == 0))
                    carrySites++;
            }
        } else if (isFlipFlop(cell.type) || isLatch(cell.type)) {
            flipFlops++;
            int control = cell.bit("R");
            for (const char* port : {"S", "CLR", "PRE"})
                if (control == bitUndefined)
                    control = cell.bit(port);
            const int d = cell.bit("D");
            const auto it = n.driver.find(d);
            const bool fed = it != n.driver.end() && lutInputs(n.cells[it->second].type) != 0 &&
                             n.readers.at(d).size() == 1;
            auto& [pairs, others] = sets[{cell.bit("C"), cell.bit("CE"), control}];
            (fed ? pairs : others)++;
        }
    }

    int forFlipFlops = 0;
    for (const auto& [control, counts] : sets) {
        s.pairs += counts.first;
        forFlipFlops += std::max(upTo(counts.first, sitesPerSlice),
                                 upTo(counts.first + counts.second, flipFlopsPerSlice));
    }
    s.controlSets = static_cast<int>(sets.size());
    s.slicem = upTo(memory, sitesPerSlice);
    s.through = carrySites;
    const int others = memory + carrySites;
    s.sites = sitesFor(luts) + others;
    const double usual =
        std::max<double>(s.sites, (1 - usualPairing) * static_cast<double>(luts.size()) + others);
    s.low = std::max(
        {upTo(s.sites, sitesPerSlice), forFlipFlops, s.slicem + carry + upTo(wide, muxesPerSlice)});
    const auto atLeast = [&](double slices) {
        return std::max(s.low, static_cast<int>(std::lround(slices)));
    };
    s.estimate = atLeast(occupiedSlices(usual, flipFlops, usualShare));
    s.high =
        atLeast(occupiedSlices(static_cast<double>(luts.size()) + others, flipFlops, mostShare));
    return s;
}
