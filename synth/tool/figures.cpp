// SPDX-License-Identifier: MIT
//
// figures: the cost of one design on one chip family: the result of a synthesis run.

#include "figures.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

using nlohmann::json;

double Figures::clock() const {
    return timing.paths.empty() ? 0 : 1000 / (timing.paths.front().ns * slowGrade);
}

double Figures::mhz() const {
    std::vector<double> all = clocks;
    all.push_back(clock());
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return *middle;
}

std::pair<double, double> Figures::mhzRange() const {
    std::pair<double, double> range{clock(), clock()};
    for (const double mhz : clocks)
        range = {std::min(range.first, mhz), std::max(range.second, mhz)};
    return range;
}

int Figures::luts(int inputs) const {
    const auto count = [&](const std::string& type) {
        const auto it = cells.find(type);
        return it == cells.end() ? 0 : it->second;
    };
    return count(fmt::format("LUT{}", inputs)) + (inputs == 1 ? count("INV") : 0);
}

Figures figuresOf(const Netlist& netlist, bool spartan6, const FilesAlong& filesAlong) {
    Figures f;
    const std::vector<std::string> owners = ownersOf(netlist, filesAlong);
    for (const Cell& cell : netlist.cells) {
        const Cost cost = costOf(cell);
        f.cells[cell.type]++;
        f.lut += cost.lut;
        f.lutRam += memoryLuts(cell.type);
        f.shift += isShiftRegister(cell.type) ? 1 : 0;
        f.ff += cost.ff;
        f.carry += cost.carry;
        f.ram += cost.ram;
        f.dsp += cost.dsp;
    }
    for (const Port& port : netlist.ports)
        if (port.name.rfind("mcb_", 0) != 0)
            f.pins += static_cast<int>(port.bits.size());
    f.slices = slicesOf(netlist);
    f.costs = costsOf(netlist, owners);
    if (spartan6) {
        f.timing = timingOf(netlist, owners);
        f.nets = netsOf(netlist, owners, f.timing);
        // Finds the file and line of a signal that the report names.
        const auto place = [&](const std::string& signal) {
            const std::string at = placeOf(netlist, signal);
            if (!at.empty())
                f.nets.places[withoutIndex(signal)] = at;
        };
        for (const auto& [owner, cost] : f.costs)
            place(owner.first.empty() ? owner.second : owner.first + "." + owner.second);
        for (const Path& path : f.timing.paths) {
            place(path.from);
            place(path.to);
            for (const Step& step : path.steps)
                place(step.name);
        }
        for (const auto* nets : {&f.nets.fanouts, &f.nets.clocks, &f.nets.resets})
            for (const Net& net : *nets)
                place(net.name);
    }
    return f;
}

void to_json(json& j, const Timing& t) {
    json paths = json::array();
    for (const Path& p : t.paths) {
        json steps = json::array(); // cell, net, fan-out, delay of cell, of net
        for (const Step& s : p.steps)
            steps.push_back({s.cell, s.name, s.fanout, s.delay, s.net});
        paths.push_back({{"from", p.from},
                         {"to", p.to},
                         {"pin", p.pin},
                         {"levels", p.levels},
                         {"ns", p.ns},
                         {"steps", steps}});
    }
    j = {{"paths", paths},
         {"ends", t.ends},
         {"inputLevels", t.inputLevels},
         {"outputLevels", t.outputLevels},
         {"throughLevels", t.throughLevels}};
}

void from_json(const json& j, Timing& t) {
    for (const json& p : j.at("paths")) {
        Path path{p.at("from"), p.at("to"), p.at("pin"), p.at("levels"), p.at("ns"), {}};
        for (const json& s : p.at("steps"))
            path.steps.push_back({s[0], s[1], s[2], s[3], s[4]});
        t.paths.push_back(path);
    }
    j.at("ends").get_to(t.ends);
    t.inputLevels = j.at("inputLevels");
    t.outputLevels = j.at("outputLevels");
    t.throughLevels = j.at("throughLevels");
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Net, name, kind, ends, flipFlops, ns)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Nets, fanouts, clocks, resets, places)

void to_json(json& j, const Figures& f) {
    json costs = json::array(); // path, signal, LUT, memory LUT, FF, carry, block RAM, DSP
    for (const auto& [owner, c] : f.costs)
        costs.push_back({owner.first, owner.second, c.lut, c.memory, c.ff, c.carry, c.ram, c.dsp});
    const Slices& s = f.slices;
    j = {{"cells", f.cells},      {"lut", f.lut},       {"lutRam", f.lutRam},
         {"shift", f.shift},      {"ff", f.ff},         {"carry", f.carry},
         {"ram", f.ram},          {"dsp", f.dsp},       {"pins", f.pins},
         {"costs", costs},        {"timing", f.timing}, {"slices", s.estimate},
         {"low", s.low},          {"high", s.high},     {"slicem", s.slicem},
         {"sites", s.sites},      {"pairs", s.pairs},   {"through", s.through},
         {"sets", s.controlSets}, {"clocks", f.clocks}, {"otherLuts", f.otherLuts},
         {"nets", f.nets}};
}

void from_json(const json& j, Figures& f) {
    j.at("cells").get_to(f.cells);
    j.at("lut").get_to(f.lut);
    j.at("lutRam").get_to(f.lutRam);
    j.at("shift").get_to(f.shift);
    j.at("ff").get_to(f.ff);
    j.at("carry").get_to(f.carry);
    j.at("ram").get_to(f.ram);
    j.at("dsp").get_to(f.dsp);
    j.at("pins").get_to(f.pins);
    for (const json& c : j.at("costs"))
        f.costs[{c[0], c[1]}] = {c[2], c[3], c[4], c[5], c[6], c[7]};
    j.at("timing").get_to(f.timing);
    j.at("clocks").get_to(f.clocks);
    j.at("otherLuts").get_to(f.otherLuts);
    j.at("nets").get_to(f.nets);
    f.slices = {j.at("low"),   j.at("slices"), j.at("high"),    j.at("slicem"),
                j.at("sites"), j.at("pairs"),  j.at("through"), j.at("sets")};
}
