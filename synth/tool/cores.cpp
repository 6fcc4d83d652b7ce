// SPDX-License-Identifier: MIT
//
// cores: the cost of each core in the chip: itself, its registers, its slot of the decoder, its
// memory port.

#include "cores.h"

#include "files.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

using std::string;

namespace {

constexpr int firstSlot = 2; // lower ones are the platform's

// Sums up the instances with a matching path.
Cost costOf(const Costs& chip, const string& pattern) {
    const std::regex path(pattern);
    Cost sum;
    for (const auto& [owner, cost] : chip)
        if (std::regex_match(owner.first, path))
            sum += cost;
    return sum;
}

// "12 / 34": LUT and flip-flops.
string text(const Cost& c) {
    return c.empty() ? "" : fmt::format("{} / {}", c.lut, c.ff);
}

std::vector<string> rowOf(const string& name, const Costs& chip, const ChipMap& map,
                          const Cost& slot) {
    const string own = "u_" + name;
    const Cost whole = costOf(chip, own + "(\\..*)?");
    const Cost registers = costOf(
        chip, own + "\\.(u_core\\.)?u_(wrapper|registers|bus|crossing)(\\..*)?"); // VHDL: none
    Cost itself = whole, port, shared, sum = whole;
    itself.lut -= registers.lut;
    itself.ff -= registers.ff;
    string upper = name;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char c) { return std::toupper(c); });
    if (const auto number = map.find("NPI_PORT_" + upper); number != map.end()) {
        port = costOf(chip, fmt::format("u_memory\\.u_arbiter\\.g_port\\[{}\\].*", number->second));
        shared = costOf(chip, "u_memory(?!\\.u_arbiter\\.g_port\\[).*");
        const int ports = map.at("NPI_PORT_COUNT");
        shared = {shared.lut / ports, 0, shared.ff / ports, 0};
    }
    for (const Cost& part : {slot, port, shared})
        sum += part;
    return {name,
            std::to_string(sum.lut),
            std::to_string(sum.ff),
            fmt::format("{:g}", sum.ram),
            std::to_string(sum.dsp),
            text(itself),
            text(registers),
            text(slot),
            text(port),
            text(shared)};
}

} // namespace

ChipMap readMap(const std::filesystem::path& file) {
    ChipMap map;
    if (!std::filesystem::exists(file))
        return map;
    const auto j = nlohmann::json::parse(readFile(file));
    for (const auto& constant : j.at("constants"))
        map[constant.at("name")] = constant.at("value");
    return map;
}

Cost slotCost(const Library& library, const RunnerOptions& options, const ChipMap& map,
              bool wanted) {
    const string decoder = "bus_decoder";
    const int slots = map.at("SLOT_COUNT");
    std::vector<Design> designs(2);
    std::vector<Run> runs(2);
    for (size_t i = 0; i < 2; i++) {
        const string number = std::to_string(slots - static_cast<int>(i));
        designs[i].name = decoder + number;
        designs[i].top = decoder;
        designs[i].parameters["SLOTS"] = number;
        runs[i].design = &designs[i];
        runs[i].family = "xc6s";
        runs[i].wanted = wanted;
    }
    carryOut(runs, library, options);
    for (const Run& run : runs)
        if (!run.error.empty()) {
            if (wanted)
                throw std::runtime_error(fmt::format("{}: {}", run.design->name, run.error));
            return {};
        }
    return {runs[0].figures.lut - runs[1].figures.lut, 0, runs[0].figures.ff - runs[1].figures.ff,
            0};
}

TextTable coreTable(const Costs& chip, const ChipMap& map, const Cost& slot,
                    const std::vector<string>& names, const string& where) {
    std::map<int, string> cores; // by slot
    for (const auto& [constant, number] : map)
        if (constant.rfind("SLOT_", 0) == 0 && constant != "SLOT_COUNT" && number >= firstSlot) {
            string name = constant.substr(5);
            std::transform(name.begin(), name.end(), name.begin(),
                           [](unsigned char c) { return std::tolower(c); });
            if (!costOf(chip, fmt::format("u_{}(\\..*)?", name)).empty())
                cores[number] = name;
        }
    for (const string& name : names)
        if (std::none_of(cores.begin(), cores.end(),
                         [&](const auto& core) { return core.second == name; }))
            throw NotInChip(
                fmt::format("{0} is not in the chip of {1}: a line in ip/cores.list, then make "
                            "ip-synth IP={0} CHIP=1",
                            name, where));
    TextTable t;
    t.add({"core in the chip", "LUT", "FF", "RAM16", "DSP", "itself", "registers",
           fmt::format("slot {}", map.at("SLOT_COUNT")), "memory port", "of the arbiter"});
    for (const auto& [number, name] : cores)
        if (names.empty() || std::find(names.begin(), names.end(), name) != names.end())
            t.add(rowOf(name, chip, map, slot));
    return t;
}
