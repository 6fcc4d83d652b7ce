// SPDX-License-Identifier: MIT
//
// baseline: the accepted figures of all designs (synth/baseline.json), and growth since.

#include "baseline.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sstream>

using nlohmann::json;
using std::string;

namespace {

constexpr size_t namedChanges = 6;

string joined(const string& path, const string& signal) {
    return path.empty() ? signal : path + "." + signal;
}

std::map<string, Cost> byInstance(const Costs& costs) {
    std::map<string, Cost> instances;
    for (const auto& [owner, cost] : costs)
        instances[owner.first] += cost;
    return instances;
}

std::vector<Change> sorted(std::map<string, Change> changes) {
    std::vector<Change> result;
    for (auto& [name, change] : changes)
        if (change.before.lut != change.after.lut || change.before.ff != change.after.ff)
            result.push_back(std::move(change));
    std::stable_sort(result.begin(), result.end(),
                     [](const Change& a, const Change& b) { return a.grown() > b.grown(); });
    return result;
}

// "u_rx.state +12 LUT, +3 FF"
string described(const Change& c) {
    string text = c.name.empty() ? "the top itself" : c.name;
    if (c.after.lut != c.before.lut)
        text += fmt::format(" {:+d} LUT", c.after.lut - c.before.lut);
    if (c.after.ff != c.before.ff)
        text += fmt::format("{} {:+d} FF", c.after.lut != c.before.lut ? "," : "",
                            c.after.ff - c.before.ff);
    return text;
}

// Returns lines below a title, or nothing where nothing grew.
string list(const string& title, const std::vector<Change>& changes) {
    string text;
    for (size_t i = 0; i < std::min(namedChanges, changes.size()) && changes[i].grown() > 0; i++)
        text += "\n      " + described(changes[i]);
    return text.empty() ? "" : "\n    " + title + text;
}

} // namespace

int lutBudget(int accepted) {
    return accepted + accepted * 3 / 100 + 4;
}
int ffBudget(int accepted) {
    return accepted + accepted / 100 + 2;
}

AcceptedCounts countsOf(const Baseline& baseline) {
    AcceptedCounts counts;
    for (const auto& [name, accepted] : baseline.designs)
        counts[name] = {accepted.lut, accepted.ff};
    return counts;
}

string shortVersion(const string& yosys) {
    std::istringstream words(yosys);
    string name, version;
    words >> name >> version;
    return name + " " + version;
}

Accepted acceptedFrom(const Figures& f) {
    return {f.lut, f.ff, f.slices.estimate, f.carry, f.dsp, f.ram, f.mhz(), f.costs};
}

Baseline readBaseline(const string& text) {
    Baseline b;
    if (text.empty())
        return b;
    const json j = json::parse(text);
    b.yosys = j.at("yosys");
    for (const auto& [name, d] : j.at("designs").items()) {
        Accepted a{d.at("lut"), d.at("ff"),  d.at("slices"), d.at("carry"),
                   d.at("dsp"), d.at("ram"), d.at("mhz"),    {}};
        for (const auto& [path, signals] : d.at("signals").items())
            for (const auto& [signal, cost] : signals.items()) {
                Cost& c = a.costs[{path, signal}];
                c.lut = cost.at(0);
                c.ff = cost.at(1);
                if (cost.size() == 4) {
                    c.ram = cost[2];
                    c.dsp = cost[3];
                }
            }
        b.designs[name] = a;
    }
    return b;
}

// Writes a line for each instance, so that a commit's difference can be read.
string written(const Baseline& b) {
    string text = fmt::format("{{\n\"yosys\": {},\n\"designs\": {{", json(b.yosys).dump());
    const char* betweenDesigns = "\n";
    for (const auto& [name, a] : b.designs) {
        text += fmt::format(
            "{}{}: {{\"lut\": {}, \"ff\": {}, \"slices\": {}, \"carry\": {}, \"dsp\": {}, "
            "\"ram\": {:g}, \"mhz\": {:.1f}, \"signals\": {{",
            betweenDesigns, json(name).dump(), a.lut, a.ff, a.slices, a.carry, a.dsp, a.ram, a.mhz);
        std::map<string, json> instances;
        for (const auto& [owner, cost] : a.costs)
            if (cost.ram != 0 || cost.dsp != 0)
                instances[owner.first][owner.second] = {cost.lut, cost.ff, cost.ram, cost.dsp};
            else if (cost.lut != 0 || cost.ff != 0)
                instances[owner.first][owner.second] = {cost.lut, cost.ff};
        const char* between = "\n";
        for (const auto& [path, signals] : instances) {
            text += fmt::format("{} {}: {}", between, json(path).dump(), signals.dump());
            between = ",\n";
        }
        text += "}}";
        betweenDesigns = ",\n";
    }
    return text + "}\n}\n";
}

std::vector<Change> changedSignals(const Costs& before, const Costs& after) {
    std::map<string, Change> changes;
    for (const auto& [owner, cost] : before)
        changes[joined(owner.first, owner.second)].before = cost;
    for (const auto& [owner, cost] : after)
        changes[joined(owner.first, owner.second)].after = cost;
    for (auto& [name, change] : changes)
        change.name = name;
    return sorted(std::move(changes));
}

std::vector<Change> changedInstances(const Costs& before, const Costs& after) {
    std::map<string, Change> changes;
    for (const auto& [path, cost] : byInstance(before))
        changes[path].before = cost;
    for (const auto& [path, cost] : byInstance(after))
        changes[path].after = cost;
    for (auto& [name, change] : changes)
        change.name = name;
    return sorted(std::move(changes));
}

std::vector<string> aboveLimits(const Row& row) {
    const Figures& f = row.main->figures;
    const std::map<string, int> now = {{"lut", f.lut}, {"ff", f.ff}, {"slices", f.slices.estimate}};
    std::vector<string> texts;
    for (const auto& [key, limit] : row.design->limits)
        if (now.at(key) > limit)
            texts.push_back(fmt::format("{}: {} {}, {} above the limit of {}", row.design->name,
                                        now.at(key), key, now.at(key) - limit, limit));
    return texts;
}

Verdict judge(const Row& row, const Baseline& baseline, const string& yosys, double goal) {
    Verdict v;
    const string& name = row.design->name;
    if (!row.main->wanted && !row.main->error.empty())
        return v;
    if (!row.main->error.empty()) {
        v.failures.push_back(fmt::format("{}: synthesis failed", name));
        return v;
    }
    for (const Run* other : row.others)
        if (other->wanted && !other->error.empty())
            v.failures.push_back(
                fmt::format("{}: synthesis for {} failed", row.design->name, other->family));
    const Figures& f = row.main->figures;
    const auto accepted = baseline.designs.find(name);
    const bool known = accepted != baseline.designs.end();
    // Another Yosys counts differently: a design is judged only by the version of the accepted
    // figures.
    const bool comparable =
        baseline.yosys.empty() || shortVersion(baseline.yosys) == shortVersion(yosys);
    for (const string& text : aboveLimits(row))
        comparable ? v.failures.push_back(text)
                   : v.notes.push_back(text + " (by another Yosys than the limit was set with)");
    if (!known || !comparable)
        return v;
    const Accepted& a = accepted->second;
    const bool moreLuts = f.lut > lutBudget(a.lut), moreFlipFlops = f.ff > ffBudget(a.ff);
    if (moreLuts || moreFlipFlops) {
        string text =
            fmt::format("{}: {} LUT, {} FF; accepted were {} and {}, the budget is {} and {}", name,
                        f.lut, f.ff, a.lut, a.ff, lutBudget(a.lut), ffBudget(a.ff));
        text += list("modules that grew:", changedInstances(a.costs, f.costs));
        text += list("signals that grew:", changedSignals(a.costs, f.costs));
        v.failures.push_back(text);
    }
    const double slowest = a.mhz >= goal ? goal : 0.9 * a.mhz;
    if (f.mhz() > 0 && f.mhz() < slowest) {
        const Path& path = f.timing.paths.front();
        v.failures.push_back(fmt::format("{}: {:.0f} MHz; accepted were {:.0f}, the least is "
                                         "{:.0f}\n    the longest path:\n      "
                                         "{} to {} {}, {} levels",
                                         name, f.mhz(), a.mhz, slowest, path.from, path.to,
                                         path.pin, path.levels));
    }
    return v;
}
