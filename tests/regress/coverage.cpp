// SPDX-License-Identifier: MIT
//
// coverage: what the tests ran of each file: points of the RTL (lines, branches, toggles, covers)
// from Verilator, lines of VHDL from GHDL, of C and C++ from gcov; against the gates of
// coverage_gates.json. `make coverage` calls it.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>
#include <vector>

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

struct Share {
    unsigned total = 0, covered = 0;
    double percent() const { return total ? 100.0 * covered / total : 100.0; }
    void add(bool hit) {
        ++total;
        covered += hit;
    }
    void add(const Share& other) {
        total += other.total;
        covered += other.covered;
    }
};
struct File {
    Share lines, toggles, points;
    std::map<std::string, uint64_t> counts; // of the points: `name: cover property` in the RTL
    std::vector<std::string> missed; // signals that never toggled, lines that never ran, points
    std::map<std::string, unsigned> explained; // why: so many points
};
// Points that cannot be reached, and why: they count as if they were not there.
class Explanations {
public:
    explicit Explanations(const json& list) {
        for (const json& each : list)
            rules_.push_back({each.value("file", ""),
                              std::regex(each.at("points").get<std::string>()), each.at("points"),
                              each.at("why"), 0, 0});
    }
    // The reason, or "".
    std::string of(const std::string& file, const std::string& point, bool covered) {
        for (Rule& rule : rules_) {
            if (file.rfind(rule.file, 0) != 0 || !std::regex_match(point, rule.points))
                continue;
            ++(covered ? rule.reached : rule.missed);
            if (!covered)
                return rule.why;
        }
        return "";
    }
    // Returns the rules that explain nothing: what they speak of is reached, or gone.
    std::vector<std::string> stale() const {
        std::vector<std::string> list;
        for (const Rule& rule : rules_)
            if (rule.missed == 0)
                list.push_back(fmt::format("{}: {} ({})", rule.file, rule.text,
                                           rule.reached ? "reached" : "no such point"));
        return list;
    }

private:
    struct Rule {
        std::string file;
        std::regex points;
        std::string text, why;
        unsigned missed, reached;
    };
    std::vector<Rule> rules_;
};
using Files = std::map<std::string, File>; // by path from the root

// Path from the root of the tree, or "" for files of others and generated ones.
std::string inside(const std::string& path, const std::string& root) {
    std::error_code none;
    std::string real = fs::weakly_canonical(path, none).string();
    if (real.rfind(root + "/", 0) != 0 || real.rfind(root + "/build/", 0) == 0 ||
        real.rfind(root + "/tests/", 0) == 0)
        return "";
    return real.substr(root.size() + 1);
}

// verilated.dat: C '\1key\2value\1key\2value...' count. A module that is there several times, in
// several models or with several parameters, is covered where any of them is.
void readVerilator(const std::string& path, const std::string& root, Explanations& explanations,
                   Files& files) {
    struct Point {
        std::string file, line, name;
        enum { Line, Toggle, User } kind;
        uint64_t count;
    };
    std::map<std::string, Point> points;
    std::ifstream in(path);
    if (!in)
        throw std::runtime_error("cannot read " + path);
    for (std::string text; std::getline(in, text);) {
        if (text.rfind("C '", 0) != 0)
            continue;
        auto end = text.rfind("' ");
        std::map<std::string, std::string> fields;
        for (size_t at = 3; at < end && text[at] == '\1';) {
            auto split = text.find('\2', at), next = std::min(text.find('\1', split), end);
            fields[text.substr(at + 1, split - at - 1)] = text.substr(split + 1, next - split - 1);
            at = next;
        }
        std::string file = inside(fields["f"], root);
        if (file.empty())
            continue;
        auto kind = fields["page"].rfind("v_toggle", 0) == 0 ? Point::Toggle
                    : fields["page"].rfind("v_user", 0) == 0 ? Point::User
                                                             : Point::Line;
        std::string key = file + ":" + fields["l"] + ":" + fields["n"] + ":" +
                          fields["page"].substr(0, 8) + ":" + fields["o"];
        auto& point =
            points.emplace(key, Point{file, fields["l"], fields["o"], kind, 0}).first->second;
        point.count += std::stoull(text.substr(end + 2));
    }
    for (auto& [key, point] : points) {
        File& file = files[point.file];
        if (std::string why = explanations.of(point.file, point.name, point.count > 0);
            !why.empty()) {
            ++file.explained[why];
            continue;
        }
        if (point.kind == Point::User)
            file.counts[point.name] += point.count;
        (point.kind == Point::User     ? file.points
         : point.kind == Point::Toggle ? file.toggles
                                       : file.lines)
            .add(point.count > 0);
        if (point.count == 0)
            file.missed.push_back(point.line + ": " + point.name);
    }
}

// lcov's .info: SF:file, DA:line,count
void readInfo(const std::string& path, const std::string& root, Files& files) {
    std::ifstream in(path);
    if (!in)
        throw std::runtime_error("cannot read " + path);
    std::string file;
    for (std::string text; std::getline(in, text);) {
        if (text.rfind("SF:", 0) == 0) {
            file = inside(text.substr(3), root);
        } else if (text.rfind("DA:", 0) == 0 && !file.empty()) {
            auto comma = text.find(',');
            bool hit = text.substr(comma + 1, 1) != "0";
            files[file].lines.add(hit);
            if (!hit)
                files[file].missed.push_back(text.substr(3, comma - 3));
        }
    }
}

struct Gate {
    double lines, toggles, points;
    std::string why;
};

// The gate of the longest path that the file begins with.
Gate gateOf(const json& gates, const std::string& file) {
    std::string best;
    for (auto& [path, gate] : gates.items())
        if (file.rfind(path, 0) == 0 && path.size() >= best.size())
            best = path;
    if (!gates.contains(best))
        return {0, 0, 100, ""};
    const json& gate = gates[best];
    return {gate.value("lines", 0.0), gate.value("toggles", 0.0), gate.value("points", 100.0),
            gate.value("why", "")};
}

int report(const Files& files, const json& gates, const Explanations& explanations,
           const std::string& out) {
    json rows = json::array();
    Share lines, toggles, points;
    std::vector<std::string> below;
    for (auto& [name, file] : files) {
        Gate gate = gateOf(gates, name);
        lines.add(file.lines);
        toggles.add(file.toggles);
        points.add(file.points);
        rows.push_back({{"file", name},
                        {"percent", file.lines.percent()},
                        {"lines", file.lines.total},
                        {"gate", gate.lines},
                        {"toggles", file.toggles.percent()},
                        {"toggle_points", file.toggles.total},
                        {"toggle_gate", gate.toggles},
                        {"points", file.counts},
                        {"point_percent", file.points.percent()},
                        {"point_gate", gate.points},
                        {"why", gate.why},
                        {"missed", file.missed},
                        {"explained", file.explained}});
        fmt::print("{:<44} {:6.1f} % of {:5} lines {:>22}{:>16}{}\n", name, file.lines.percent(),
                   file.lines.total,
                   file.toggles.total ? fmt::format("{:6.1f} % of {:5} toggles",
                                                    file.toggles.percent(), file.toggles.total)
                                      : "",
                   file.points.total
                       ? fmt::format("{} of {} points", file.points.covered, file.points.total)
                       : "",
                   gate.why.empty() ? "" : "  (" + gate.why + ")");
        if (file.lines.percent() < gate.lines ||
            (file.toggles.total && file.toggles.percent() < gate.toggles) ||
            file.points.percent() < gate.points)
            below.push_back(
                fmt::format("below its gate: {}: lines {:.1f} (gate {:.0f}), toggles {:.1f} (gate "
                            "{:.0f}), points {:.1f} "
                            "(gate {:.0f}); never: {}",
                            name, file.lines.percent(), gate.lines, file.toggles.percent(),
                            gate.toggles, file.points.percent(), gate.points,
                            fmt::join(file.missed.begin(),
                                      file.missed.begin() +
                                          std::min<long>(8, static_cast<long>(file.missed.size())),
                                      "; ")));
    }
    std::ofstream summary(out);
    summary << json{{"total", lines.percent()},
                    {"toggles", toggles.percent()},
                    {"points", points.covered},
                    {"points_total", points.total},
                    {"files", rows}}
                   .dump(1)
            << '\n';
    if (!summary.flush())
        throw std::runtime_error("cannot write " + out + ": is the disk full?");
    fmt::print("\n{:.1f} % of {} lines, {:.1f} % of {} toggle points, {} of {} cover points; {}\n",
               lines.percent(), lines.total, toggles.percent(), toggles.total, points.covered,
               points.total, out);
    for (const std::string& rule : explanations.stale())
        below.push_back("an explanation that explains nothing: " + rule);
    for (const std::string& line : below)
        std::cerr << "coverage: " << line << '\n';
    return below.empty() ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
    std::string root = ".", gates, verilator, out = "summary.json";
    std::vector<std::string> infos;
    CLI::App app("Coverage of RTL and host code against the gates. Exit status 1: a file is below "
                 "its gate.");
    app.add_option("--source", root, "root of the tree")->capture_default_str();
    app.add_option("--gates", gates, "JSON: least percentages by path")->required();
    app.add_option("--verilator", verilator, "merged data of verilator_coverage");
    app.add_option("--info", infos, "lcov files of C, C++ and VHDL");
    app.add_option("--out", out, "JSON summary")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        root = fs::canonical(root).string();
        std::ifstream in(gates);
        if (!in)
            throw std::runtime_error("cannot read " + gates);
        json limits = json::parse(in);
        Explanations explanations(limits.value("explained", json::array()));
        Files files;
        if (!verilator.empty())
            readVerilator(verilator, root, explanations, files);
        for (const std::string& info : infos)
            readInfo(info, root, files);
        if (files.empty())
            throw std::runtime_error("nothing was measured: did the tests run with COVERAGE_DIR?");
        return report(files, limits.at("gates"), explanations, out);
    } catch (const std::exception& error) {
        std::cerr << "coverage: " << error.what() << '\n';
        return 2;
    }
}
