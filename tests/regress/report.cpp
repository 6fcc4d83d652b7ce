// SPDX-License-Identifier: MIT

#include "report.h"
#include "files.h"
#include "lights.h"
#include "plan.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

json readJson(const std::string& path) {
    std::ifstream in(path);
    return in ? json::parse(in, nullptr, false) : json();
}

json readMutants(const std::string& path) {
    std::ifstream in(path);
    json rows = json::array();
    for (std::string line; std::getline(in, line);) {
        std::istringstream cells(line);
        std::string name, result, test, seconds, place;
        std::getline(cells, name, '\t');
        std::getline(cells, result, '\t');
        std::getline(cells, test, '\t');
        std::getline(cells, seconds, '\t');
        std::getline(cells, place, '\t');
        rows.push_back({name, result, test, seconds, place});
    }
    return rows;
}

// The page has room for so much; all of it is in coverage's own summary.
void shorten(json& missed) {
    constexpr size_t shown = 40;
    if (!missed.is_array() || missed.size() <= shown)
        return;
    size_t more = missed.size() - shown;
    missed.erase(missed.begin() + shown, missed.end());
    missed.push_back(fmt::format("and {} more", more));
}

// Collects the results of prove.sh from logs: "X: proven, 47 clauses with 33 flops", "X: 2 covers
// reached".
json proofsOf(const std::vector<Result>& results) {
    json rows = json::array();
    static const std::regex proven("proven[,]? *([^\n]*)"), bounded("bounded, ([0-9]+) clocks"),
        covers("([0-9]+) covers reached");
    for (const Result& result : results) {
        if (result.name.rfind("formal.", 0) != 0)
            continue;
        std::smatch match;
        auto text = [&](const std::regex& what) {
            return std::regex_search(result.log, match, what) ? match[1].str() : std::string("-");
        };
        rows.push_back({result.name.substr(7), result.status, text(bounded), text(proven),
                        text(covers), result.seconds});
    }
    return rows;
}

std::string badge(unsigned passed, unsigned failed) {
    std::string value =
        failed ? fmt::format("{} failed", failed) : fmt::format("{} passed", passed);
    unsigned width = 74 + 7 * static_cast<unsigned>(value.size()) + 14;
    return fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="20" role="img" aria-label="regression: {1}">)"
        R"(<rect width="{0}" height="20" rx="3" fill="#555"/><rect x="78" width="{2}" height="20" rx="3" fill="{3}"/>)"
        R"(<g fill="#fff" font-family="DejaVu Sans,Verdana,sans-serif" font-size="11">)"
        R"(<text x="6" y="14">regression</text><text x="85" y="14">{1}</text></g></svg>)"
        "\n",
        width, value, width - 78, failed ? "#c0392b" : "#2e8b57");
}

// Text in a table of Markdown.
std::string cell(std::string text) {
    for (const auto& [from, to] : {std::pair{"&", "&amp;"}, {"<", "&lt;"}, {"\\|", "\\|"}})
        text = std::regex_replace(text, std::regex(from), to);
    return text.substr(0, 300);
}

std::string located(const json& failure) {
    const std::string place = failure["place"], reason = failure["reason"];
    return place.empty() ? reason : place + ": " + reason;
}

std::string markdown(const json& data) {
    std::string text =
        fmt::format("# Regression: {} passed, {} failed, {} skipped\n\n", data["passed"].get<int>(),
                    data["failed"].get<int>(), data["skipped"].get<int>());
    text += fmt::format("Commit `{}`, {:.0f} s.\n", data["commit"].get<std::string>(),
                        data["seconds"].get<double>());
    text += "\n| light | | |\n|---|---|---|\n";
    for (auto& each : data["lights"])
        text += fmt::format("| {} | {} | {} |\n", each["name"].get<std::string>(),
                            each["state"].get<std::string>(), each["text"].get<std::string>());
    if (!data["failures"].empty()) {
        text += "\n| reason | test | changed | repeat |\n|---|---|---|---|\n";
        for (auto& f : data["failures"])
            text += fmt::format("| {} | {} | {} | `{}` |\n", cell(located(f)), cell(f["name"]),
                                cell(f["changed"]), f["repeat"].get<std::string>());
    }
    bool first = true;
    for (auto& each : data["plan"])
        if (each["state"] == "failed") {
            text +=
                first ? "\n| requirement that is not proven | page | tests |\n|---|---|---|\n" : "";
            text += fmt::format("| {} | {} | {} |\n", each["text"].get<std::string>(),
                                each["page"].get<std::string>(),
                                fmt::join(each["open"].get<std::vector<std::string>>(), ", "));
            first = false;
        }
    if (!data["flaky"].empty()) {
        text += "\nFlaky (passed and failed with the same code):\n";
        for (auto& name : data["flaky"])
            text += "- " + name.get<std::string>() + "\n";
    }
    if (!data["seeds"].empty()) {
        text += "\nSeeds that failed, and have not passed since (`make regress KEPT=1`):\n";
        for (auto& kept : data["seeds"])
            text += fmt::format("- {} SEED={}\n", kept["test"].get<std::string>(),
                                kept["seed"].get<std::string>());
    }
    return text;
}

} // namespace

json gather(const History& history, const std::vector<Test>& tests,
            const std::vector<Result>& results, const std::vector<Failure>& failures,
            const std::string& source) {
    const std::string build = source + "/build";
    json data = history.runs().back();
    data.erase("tests");
    std::map<std::string, const Test*> byName;
    for (const Test& test : tests)
        byName[test.name] = &test;
    auto& rows = data["results"] = json::array();
    for (const Result& result : results) {
        const Test* test = byName.count(result.name) ? byName[result.name] : nullptr;
        json ends = json::array(); // the last ten, newest last
        for (auto run = history.runs().rbegin(); run != history.runs().rend() && ends.size() < 10;
             ++run)
            if (auto it = run->at("tests").find(result.name); it != run->at("tests").end())
                ends.insert(ends.begin(), json::array({it->at(0), it->at(1)}));
        rows.push_back({result.name, result.status, result.seconds, test ? test->place : "",
                        test && !test->labels.empty() ? test->labels[0] : "", result.seed, ends});
    }
    std::set<std::string> ran;
    unsigned left[2] = {0, 0}; // tests and proofs that were not chosen
    unsigned kept[2] = {0, 0}; // that were not computed: tests/kept.py had their verdicts
    for (const Result& result : results) {
        ran.insert(result.name);
        kept[result.name.rfind("formal.", 0) == 0] += result.log.rfind("kept: the verdict", 0) == 0;
    }
    for (const Test& test : tests)
        left[test.name.rfind("formal.", 0) == 0] += ran.count(test.name) == 0;
    data["left"] = {{"tests", left[0]}, {"proofs", left[1]}};
    data["kept"] = {{"tests", kept[0]}, {"proofs", kept[1]}};
    auto& bad = data["failures"] = json::array();
    for (const Failure& failure : failures)
        bad.push_back({{"name", failure.result.name},
                       {"bucket", failure.bucket},
                       {"reason", failure.reason},
                       {"repeat", failure.repeat},
                       {"log", failure.log},
                       {"wave", failure.wave},
                       {"save", failure.save},
                       {"place", failure.place},
                       {"changed", failure.changed},
                       {"clock", failure.clock},
                       {"drawing", nullptr},
                       {"tail", failure.result.log.substr(failure.result.log.size() > 3000
                                                              ? failure.result.log.size() - 3000
                                                              : 0)}});
    data["trees"] = json::object();
    data["flaky"] = history.flaky();
    auto& past = data["history"] = json::array();
    for (size_t i = history.runs().size() > 60 ? history.runs().size() - 60 : 0;
         i < history.runs().size(); ++i) {
        const json& run = history.runs()[i];
        past.push_back({run["time"], run["commit"], run["passed"], run["failed"], run["seconds"],
                        run.value("subject", ""), run.value("reasons", json::array())});
    }
    data["proofs"] = proofsOf(results);
    data["mutants"] = readMutants(build + "/mutants/results.tsv");
    if (json drawn = readJson(build + "/mutants/drawn.json"); drawn.is_object())
        data["drawn"] = drawn;
    for (auto& [key, path] :
         std::map<std::string, std::string>{{"coverage", build + "/coverage/summary.json"},
                                            {"utilisation", build + "/synth/report.json"},
                                            {"speed", build + "/bench/speed.json"}}) {
        json found = readJson(path);
        if (!found.is_discarded() && !found.is_null())
            data[key] = found;
    }
    json simulator = readJson(build + "/bench/simulator.json");
    if (simulator.is_array() && data.contains("speed"))
        for (json& entry : simulator) { // beside the board's time, by which no run is judged
            if (entry.contains("limit"))
                entry["peer"] = fmt::format("real time: {}", entry["limit"].dump());
            entry.erase("limit");
            data["speed"]["entries"].push_back(entry);
        }
    if (data.contains("coverage"))
        for (json& file : data["coverage"]["files"])
            shorten(file["missed"]);
    for (auto& [name, folder] : std::map<std::string, std::string>{{"mutants", "mutants"},
                                                                   {"coverage", "coverage"},
                                                                   {"size", "synth"},
                                                                   {"speed", "bench"}})
        if (std::string file = build + "/" + folder + "/tree"; fs::exists(file)) {
            std::string state = readFile(file);
            data["trees"][name] = state.substr(0, state.find('\n'));
        }
    data["plan"] = judgePlan(readPlan(source + "/tests/plan.md"), tests, history);
    data["lights"] = lightsOf(data, source);
    // Drawings have what the rest leaves of the page's 2 MB.
    const size_t rest = pageStyle().size() + pageScript().size() + data.dump().size() + 60'000;
    const size_t drawings = std::count_if(failures.begin(), failures.end(),
                                          [](const Failure& f) { return !f.wave.empty(); });
    for (size_t i = 0; i < failures.size(); ++i)
        if (!failures[i].wave.empty())
            data["failures"][i]["drawing"] =
                drawingOf(failures[i], (2'000'000 - std::min<size_t>(2'000'000, rest)) / drawings);
    return data;
}

void writeReports(const json& data, const std::string& out) {
    writeFile(out + "/report.html",
              filled(readFile(PAGE), {{"/*COMMON*/", pageStyle()},
                                      {"//COMMON", pageScript()},
                                      {"/*DATA*/null", scriptSafe(data.dump())}}));
    writeFile(out + "/report.json", data.dump(1));
    writeFile(out + "/summary.md", markdown(data));
    writeFile(out + "/badge.svg",
              badge(data["passed"].get<unsigned>(), data["failed"].get<unsigned>()));
}
