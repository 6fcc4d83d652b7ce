// SPDX-License-Identifier: MIT
//
// report: the figures as JSON for machines, as Markdown, and as one HTML page that needs no
// network.

#include "report.h"

#include "files.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

using nlohmann::json;
using std::string;

namespace {

double rounded(double value, int digits) {
    const double scale = std::pow(10, digits);
    return std::round(value * scale) / scale;
}

json entry(const string& name, double value, const string& unit, const string& command) {
    return {{"name", name}, {"value", value}, {"unit", unit}, {"command", command}};
}

json costsJson(const Costs& costs) { // {path: {signal: [LUT, FF, memory LUT]}}
    json j = json::object();
    for (const auto& [owner, c] : costs)
        if (c.lut != 0 || c.ff != 0)
            j[owner.first][owner.second] = {c.lut, c.ff, c.memory};
    return j;
}

json instancesJson(const Costs& costs) { // {path: [LUT, FF]}
    json j = json::object();
    for (const auto& [owner, c] : costs) {
        json& sum = j[owner.first];
        if (sum.is_null())
            sum = {0, 0};
        sum[0] = sum[0].get<int>() + c.lut;
        sum[1] = sum[1].get<int>() + c.ff;
    }
    return j;
}

// The figures as in the cache, without the costs (costsJson), and values calculated from them.
json figuresJson(const Figures& f) {
    json j = f;
    j.erase("costs");
    j["mhz"] = rounded(f.mhz(), 1);
    j["mhzRange"] = {rounded(f.mhzRange().first, 1), rounded(f.mhzRange().second, 1)};
    for (int inputs = 1; inputs <= 6; inputs++)
        j["luts"].push_back(f.luts(inputs));
    for (json& path : j["timing"]["paths"]) {
        path["ns"] = rounded(path["ns"], 3);
        for (json& step : path["steps"])
            step[4] = rounded(step[4], 3);
    }
    return j;
}

json acceptedJson(const Accepted& a) {
    return {{"lut", a.lut}, {"ff", a.ff},   {"slices", a.slices}, {"carry", a.carry},
            {"dsp", a.dsp}, {"ram", a.ram}, {"mhz", a.mhz}};
}

} // namespace

string entriesJson(const Report& r) {
    json entries = json::array();
    for (size_t i = 0; i < r.rows.size(); i++) {
        const Row& row = r.rows[i];
        if (!row.main->error.empty())
            continue;
        const Figures& f = row.main->figures;
        const string command = "make synth DESIGN=" + row.design->name;
        const auto accepted = r.baseline.designs.find(row.design->name);
        const auto add = [&](const string& key, double value, const string& unit) {
            json e = entry(row.design->name + " " + key, value, unit, command);
            const auto limit = row.design->limits.find(key);
            if (limit != row.design->limits.end()) {
                e["limit"] = limit->second;
            } else if (accepted != r.baseline.designs.end() && (key == "lut" || key == "ff")) {
                e["limit"] =
                    key == "lut" ? lutBudget(accepted->second.lut) : ffBudget(accepted->second.ff);
            }
            if (e.contains("limit") && e["limit"] != 0)
                e["share"] = rounded(value / e["limit"].get<double>(), 3);
            if (row.design->beside && r.plan->paper.count(key)) {
                e["peer"] = r.plan->paper.at(key);
                e["ratio"] = rounded(value / r.plan->paper.at(key), 3);
            }
            entries.push_back(e);
        };
        add("lut", f.lut, "LUT");
        add("ff", f.ff, "flip-flops");
        add("slices", f.slices.estimate,
            fmt::format("slices, estimated, {:.0f} % off on average", 100 * slicesError));
        if (!f.timing.paths.empty()) {
            json e = entry(row.design->name + " clock", rounded(f.mhz(), 1),
                           "MHz, estimated, at least", command);
            e["limit"] = r.plan->chip.mhz;
            e["share"] = rounded(f.mhz() / r.plan->chip.mhz, 3);
            entries.push_back(e);
        }
        for (const Run* other : row.others) {
            if (!other->error.empty())
                continue;
            entries.push_back(entry(row.design->name + " lut " + other->family, other->figures.lut,
                                    "LUT", command));
            entries.push_back(entry(row.design->name + " ff " + other->family, other->figures.ff,
                                    "flip-flops", command));
        }
    }
    json failures = json::array(), missing = json::array();
    for (size_t i = 0; i < r.rows.size(); i++) {
        for (const string& failure : r.verdicts[i].failures)
            failures.push_back(failure.substr(0, failure.find('\n')));
        if (!r.rows[i].main->wanted && !r.rows[i].main->error.empty())
            missing.push_back(r.rows[i].design->name);
    }
    return json{{"failures", failures}, {"missing", missing}, {"entries", entries}}.dump(1) + "\n";
}

string markdown(const Report& r) {
    string text = fmt::format("# Utilisation of {}\n\n{}, commit {}\n\n", r.plan->chip.name,
                              shortVersion(r.yosys), r.commit.empty() ? "unknown" : r.commit);
    for (const Row& row : r.rows)
        if (row.design->beside && row.main->error.empty())
            text += fmt::format(
                "## {}\n{}\n{}\n{}\n", row.design->title, paperTable(*r.plan, row).markdown(),
                costTable(*r.library, row, 2).markdown(), pathTable(*r.plan, row, 5).markdown());
    if (!r.cores.rows().empty())
        text += "## Cores\n" + r.cores.markdown() + "\n";
    text += "## All designs\n" + designTable(*r.plan, r.rows, countsOf(r.baseline)).markdown();
    for (const Verdict& v : r.verdicts) {
        for (const string& failure : v.failures)
            text += "\n**Failed:** " + failure + "\n";
        for (const string& note : v.notes)
            text += "\n" + note + "\n";
    }
    return text;
}

string differences(const string& before, const string& after) {
    std::map<string, std::map<string, std::pair<json, json>>> designs; // by name and kind of figure
    const auto note = [&](const string& text, json std::pair<json, json>::* member) {
        const json report = json::parse(text);
        for (const json& e : report.at("entries")) {
            const string name = e.at("name");
            const size_t space = name.rfind(' ');
            designs[name.substr(0, space)][name.substr(space + 1)].*member = e.at("value");
        }
    };
    note(before, &std::pair<json, json>::first);
    note(after, &std::pair<json, json>::second);
    TextTable t;
    t.add({"design", "LUT", "FF", "slices", "MHz"});
    bool isAny = false;
    for (auto& [name, figures] : designs) {
        std::vector<string> line{name};
        bool differs = false;
        for (const char* kind : {"lut", "ff", "slices", "clock"}) {
            const auto& [then, now] = figures[kind];
            differs |= then != now;
            const auto text = [](const json& value) {
                return value.is_null() ? "" : fmt::format("{:g}", value.get<double>());
            };
            line.push_back(then == now      ? text(now)
                           : then.is_null() ? text(now) + " (new)"
                           : now.is_null()  ? "gone"
                                            : fmt::format("{} -> {} ({:+g})", text(then), text(now),
                                                          now.get<double>() - then.get<double>()));
        }
        if (differs)
            t.add(line);
        isAny |= differs;
    }
    return isAny ? t.markdown() : "No figure of any design differs.\n";
}

string html(const Report& r, const string& page, const string& style, const string& script) {
    json data = {{"yosys", shortVersion(r.yosys)},
                 {"commit", r.commit},
                 {"paper", r.plan->paper},
                 {"chip",
                  {{"name", r.plan->chip.name},
                   {"lut", r.plan->chip.lut},
                   {"ff", r.plan->chip.ff},
                   {"slices", r.plan->chip.slices},
                   {"dsp", r.plan->chip.dsp},
                   {"ram", r.plan->chip.ramb16},
                   {"mhz", r.plan->chip.mhz}}},
                 {"slowGrade", slowGrade},
                 {"slicesError", slicesError},
                 {"designs", json::array()},
                 {"history", json::array()},
                 {"cores", r.cores.rows()},
                 {"pictures", r.pictures}};
    for (size_t i = 0; i < r.rows.size(); i++) {
        const Row& row = r.rows[i];
        json d = {{"name", row.design->name},
                  {"title", row.design->title},
                  {"file", row.design->file},
                  {"top", row.design->top},
                  {"paper", row.design->beside},
                  {"limits", row.design->limits},
                  {"failures", r.verdicts[i].failures},
                  {"notes", r.verdicts[i].notes},
                  {"error", row.main->error}};
        if (row.main->error.empty()) {
            const Figures& f = row.main->figures;
            d["figures"] = figuresJson(f);
            d["costs"] = costsJson(f.costs);
            for (const auto& [owner, cost] : f.costs) {
                for (string path = owner.first; !path.empty();) {
                    d["modules"][path] = r.library->moduleAt(row.design->top, path);
                    const size_t dot = path.rfind('.');
                    path.resize(dot == string::npos ? 0 : dot);
                }
            }
        }
        for (const Run* other : row.others)
            d["others"][other->family] = {{"lut", other->figures.lut},
                                          {"ff", other->figures.ff},
                                          {"ram", other->figures.ram},
                                          {"dsp", other->figures.dsp},
                                          {"error", other->error}};
        const auto accepted = r.baseline.designs.find(row.design->name);
        if (accepted != r.baseline.designs.end()) {
            d["accepted"] = acceptedJson(accepted->second);
            d["budget"] = {{"lut", lutBudget(accepted->second.lut)},
                           {"ff", ffBudget(accepted->second.ff)}};
        }
        data["designs"].push_back(d);
    }
    for (const Commit& c : r.commits) {
        json designs = json::object();
        for (const auto& [name, a] : c.baseline.designs) {
            designs[name] = acceptedJson(a);
            designs[name]["instances"] = instancesJson(a.costs);
        }
        data["history"].push_back(
            {{"id", c.id}, {"date", c.date}, {"subject", c.subject}, {"designs", designs}});
    }
    return filled(page,
                  {{"@STYLE@", style}, {"@SCRIPT@", script}, {"@DATA@", scriptSafe(data.dump())}});
}
