// SPDX-License-Identifier: MIT
//
// designs: the designs to synthesise, and their limits (synth/designs.json and the modules found).

#include "designs.h"

#include "files.h"
#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

bool endsWith(const std::string& name, const std::string& end) {
    return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

// "// name: one sentence" at the head of a file, or a converted core's own sentence.
std::string sentenceOf(const fs::path& file, const std::string& module) {
    std::ifstream in(file);
    std::string line;
    for (int i = 0; i < 8 && std::getline(in, line); i++) {
        const std::string begin = "// " + module + ": ";
        if (line.rfind(begin, 0) == 0)
            return line.substr(begin.size());
    }
    return "";
}

} // namespace

Plan readPlan(const fs::path& file, const Library& library, const fs::path& root) {
    const json j = json::parse(readFile(file), nullptr, true, true);
    Plan plan;
    const json& chip = j.at("chip");
    plan.chip = {chip.at("name"),   chip.at("lut"),    chip.at("ff"),  chip.at("slices"),
                 chip.at("slicem"), chip.at("ramb16"), chip.at("dsp"), chip.at("mhz")};
    plan.paper = j.at("paper").get<std::map<std::string, int>>();
    for (const json& d : j.at("designs")) {
        Design design{d.at("name"), d.at("top"), d.at("title"),          "",
                      {},           {},          d.value("paper", false)};
        if (!library.has(design.top))
            throw std::runtime_error(
                fmt::format("{}: there is no module {}", file.string(), design.top));
        const json parameters = d.value("parameters", json::object());
        for (const auto& [name, value] : parameters.items())
            design.parameters[name] = value.is_string() ? value.get<std::string>() : value.dump();
        design.limits = d.value("limits", std::map<std::string, int>());
        design.orders = d.value("orders", 0);
        plan.designs.push_back(design);
    }
    for (const auto& [name, module] : library.modules()) {
        const bool known = std::any_of(plan.designs.begin(), plan.designs.end(),
                                       [&, &n = name](const Design& d) { return d.top == n; });
        const bool rules = endsWith(name, "_rules") || endsWith(name, "_proof");
        if (!known && !rules &&
            module.file.stem() == name) // of a converted core only the core itself
            plan.designs.push_back({name, name, sentenceOf(module.file, name), "", {}, {}, false});
    }
    for (Design& design : plan.designs)
        design.file = fs::proximate(library.modules().at(design.top).file, root).string();
    return plan;
}
