// SPDX-License-Identifier: MIT
//
// table: the report as text, for the terminal and as Markdown.

#include "table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

using std::string;

std::vector<Row> rowsOf(const Plan& plan, const std::vector<Run>& runs, const string& family) {
    std::vector<Row> rows;
    for (const Design& design : plan.designs) {
        Row row{&design, nullptr, {}};
        for (const Run& run : runs)
            if (run.design == &design) {
                if (run.family == family)
                    row.main = &run;
                else
                    row.others.push_back(&run);
            }
        if (row.main)
            rows.push_back(row);
    }
    return rows;
}

string TextTable::plain() const {
    std::vector<size_t> widths;
    for (const auto& row : rows_)
        for (size_t i = 0; i < row.size(); i++) {
            widths.resize(std::max(widths.size(), row.size()));
            widths[i] = std::max(widths[i], row[i].size());
        }
    string text;
    for (const auto& row : rows_) {
        string line;
        for (size_t i = 0; i < row.size(); i++)
            line += i == 0 ? fmt::format("{:<{}}", row[i], widths[i])
                           : fmt::format("  {:>{}}", row[i], widths[i]);
        line.resize(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

string TextTable::markdown() const {
    string text;
    for (size_t r = 0; r < rows_.size(); r++) {
        text += "|";
        for (const string& cell : rows_[r])
            text += " " + cell + " |";
        text += "\n";
        if (r == 0) {
            text += "|---|";
            for (size_t i = 1; i < rows_[0].size(); i++)
                text += "---:|";
            text += "\n";
        }
    }
    return text;
}

string percent(double part, double whole) {
    return fmt::format("{:.1f} %", 100 * part / whole);
}

// Sites of LUTs, route-throughs included, two functions in some of them.
static int lutsOfMap(const Figures& f) {
    const int memory = f.lutRam + f.shift;
    return static_cast<int>(
        std::lround(memory + (1 - usualPairing) * (f.lut - memory + f.slices.through)));
}

TextTable paperTable(const Plan& plan, const Row& row) {
    const Figures& f = row.main->figures;
    TextTable t;
    t.add({"", "here", plan.chip.name, "paper", "here / paper", "limit", ""});
    const auto line = [&](const string& name, const string& key, int value, int chip) {
        const int paper = plan.paper.at(key);
        const auto limit = row.design->limits.find(key);
        const bool limited = limit != row.design->limits.end();
        t.add({name, std::to_string(value), percent(value, chip),
               fmt::format("{} ({})", paper, percent(paper, chip)),
               fmt::format("{:.2f}", static_cast<double>(value) / paper),
               limited ? std::to_string(limit->second) : "",
               !limited                 ? ""
               : value <= limit->second ? "ok"
                                        : fmt::format("{} over", value - limit->second)});
    };
    line("flip-flops", "ff", f.ff, plan.chip.ff);
    line("LUTs of the netlist", "lut", f.lut, plan.chip.lut);
    line("LUTs and route-throughs, before map pairs them", "lut", f.lut + f.slices.through,
         plan.chip.lut);
    line("LUTs as map counts them (estimate)", "lut", lutsOfMap(f), plan.chip.lut);
    line(fmt::format("slices (estimate, {:.0f} % off on average)", 100 * slicesError), "slices",
         f.slices.estimate, plan.chip.slices);
    return t;
}

// The LUTs, with their range over other orders of the netlist: "863 (858-865)".
static string lutText(const Figures& f) {
    return f.otherLuts.empty()
               ? std::to_string(f.lut)
               : fmt::format("{} ({}-{})", f.lut, f.otherLuts.front(), f.otherLuts.back());
}

// The clock, the same way.
static string clockText(const Figures& f) {
    const auto [slowest, fastest] = f.mhzRange();
    if (f.timing.paths.empty())
        return "";
    return f.clocks.empty() ? fmt::format("{:.0f}", f.mhz())
                            : fmt::format("{:.0f} ({:.0f}-{:.0f})", f.mhz(), slowest, fastest);
}

TextTable designTable(const Plan& plan, const std::vector<Row>& rows,
                      const AcceptedCounts& accepted) {
    TextTable t;
    std::vector<string> head{"design", "LUT",    "change",   "chip",   "1-2",   "3",
                             "4",      "5",      "6",        "RAM",    "SRL",   "thru",
                             "FF",     "change", "sets",     "carry",  "RAM16", "DSP",
                             "pins",   "slices", "low-high", "levels", "MHz"};
    for (const Run* other : rows.empty() ? std::vector<const Run*>{} : rows[0].others) {
        head.push_back(other->family + " LUT");
        head.push_back("FF");
    }
    t.add(head);
    for (const Row& row : rows) {
        if (!row.main->error.empty()) {
            t.add({row.design->name, "failed"});
            continue;
        }
        const Figures& f = row.main->figures;
        const auto before = accepted.find(row.design->name);
        const auto change = [&](int now, int then) {
            return before == accepted.end() ? "new"
                   : now == then            ? ""
                                            : fmt::format("{:+d}", now - then);
        };
        const auto [luts, flipFlops] = before == accepted.end() ? std::pair(0, 0) : before->second;
        std::vector<string> line{row.design->name, lutText(f), change(f.lut, luts),
                                 percent(f.lut, plan.chip.lut),
                                 std::to_string(f.luts(1) + f.luts(2))};
        for (int inputs = 3; inputs <= 6; inputs++)
            line.push_back(std::to_string(f.luts(inputs)));
        for (const int value : {f.lutRam, f.shift, f.slices.through, f.ff})
            line.push_back(std::to_string(value));
        line.push_back(change(f.ff, flipFlops));
        for (const int value : {f.slices.controlSets, f.carry})
            line.push_back(std::to_string(value));
        line.push_back(fmt::format("{:g}", f.ram));
        for (const int value : {f.dsp, f.pins, f.slices.estimate})
            line.push_back(std::to_string(value));
        line.push_back(fmt::format("{}-{}", f.slices.low, f.slices.high));
        line.push_back(f.timing.paths.empty() ? "" : std::to_string(f.timing.paths[0].levels));
        line.push_back(clockText(f));
        for (const Run* other : row.others) {
            line.push_back(other->error.empty() ? std::to_string(other->figures.lut) : "failed");
            line.push_back(other->error.empty() ? std::to_string(other->figures.ff) : "");
        }
        t.add(line);
    }
    return t;
}

TextTable costTable(const Library& library, const Row& row, size_t depth) {
    std::map<string, Cost> paths; // with all below
    for (const auto& [owner, cost] : row.main->figures.costs) {
        string path = owner.first;
        while (!path.empty()) {
            paths[path] += cost;
            const size_t dot = path.rfind('.');
            path.resize(dot == string::npos ? 0 : dot);
        }
        paths[""] += cost;
    }
    TextTable t;
    t.add({"instance", "module", "LUT", "of these RAM", "FF", "carry"});
    for (const auto& [path, cost] : paths) {
        const size_t level = path.empty() ? 0 : 1 + std::count(path.begin(), path.end(), '.');
        if (level <= depth)
            t.add({string(2 * level, ' ') +
                       (path.empty() ? row.design->top : path.substr(path.rfind('.') + 1)),
                   library.moduleAt(row.design->top, path), std::to_string(cost.lut),
                   std::to_string(cost.memory), std::to_string(cost.ff),
                   std::to_string(cost.carry)});
    }
    return t;
}

TextTable pathTable(const Plan& plan, const Row& row, size_t count) {
    TextTable t;
    t.add({"longest paths, estimated", "to", "levels", "ns (-3)", "ns (-2)",
           fmt::format("of {:g} MHz", plan.chip.mhz)});
    const std::vector<Path>& paths = row.main->figures.timing.paths;
    for (size_t i = 0; i < std::min(count, paths.size()); i++)
        t.add({paths[i].from, fmt::format("{} {}", paths[i].to, paths[i].pin),
               std::to_string(paths[i].levels), fmt::format("{:.2f}", paths[i].ns),
               fmt::format("{:.2f}", paths[i].ns * slowGrade),
               percent(paths[i].ns * slowGrade, 1000 / plan.chip.mhz)});
    return t;
}
