// SPDX-License-Identifier: MIT

#include "history.h"
#include "files.h"
#include <ctime>
#include <fstream>
#include <set>

namespace {
constexpr size_t keptRuns = 300;
}

History::History(std::string path) : path_(std::move(path)) {
    std::ifstream file(path_);
    for (std::string line; std::getline(file, line);) {
        auto run = nlohmann::json::parse(line, nullptr, false);
        if (run.is_discarded() || !run.contains("tests"))
            ++damaged_;
        else
            runs_.push_back(std::move(run));
    }
}

void History::add(const nlohmann::json& run) {
    runs_.push_back(run);
    if (runs_.size() > keptRuns)
        runs_.erase(runs_.begin(), runs_.end() - keptRuns);
    std::string text;
    for (const auto& each : runs_)
        text += each.dump() + "\n";
    writeFile(path_, text);
}

std::string History::passedWith(const std::string& test) const {
    const nlohmann::json end = newest(test, "p");
    return end.is_null() ? "" : end.at(2);
}

std::optional<Pass> History::lastPass(const std::string& test) const {
    for (auto run = runs_.rbegin(); run != runs_.rend(); ++run)
        if (auto it = run->at("tests").find(test); it != run->at("tests").end() && it->at(0) == "p")
            return Pass{run->at("commit"), run->value("tree", ""),
                        it->size() > 3 ? it->at(3).get<std::string>() : ""};
    return {};
}

std::string History::last(const std::string& test) const {
    const nlohmann::json end = newest(test, "");
    return end.is_null() ? "" : end.at(0);
}

double History::seconds(const std::string& test) const {
    const nlohmann::json end = newest(test, "");
    return end.is_null() ? 0 : end.at(1).get<double>();
}

nlohmann::json History::newest(const std::string& test, const std::string& how) const {
    for (auto run = runs_.rbegin(); run != runs_.rend(); ++run) {
        auto it = run->at("tests").find(test);
        if (it != run->at("tests").end() && (how.empty() || it->at(0) == how))
            return *it;
    }
    return {};
}

std::vector<std::string> History::flaky() const {
    // test; fingerprint and seed: how
    std::map<std::string, std::map<std::string, std::set<std::string>>> ends;
    for (const auto& run : runs_)
        for (auto& [name, end] : run.at("tests").items())
            ends[name][end.at(2).get<std::string>() + " " +
                       (end.size() > 3 ? end.at(3).get<std::string>() : "")]
                .insert(end.at(0).get<std::string>());
    std::vector<std::string> names;
    for (auto& [name, prints] : ends)
        for (auto& [print, how] : prints)
            if (how.count("p") && how.count("f")) {
                names.push_back(name);
                break;
            }
    return names;
}

nlohmann::json History::makeRun(const std::vector<Test>& tests, const std::vector<Result>& results,
                                const std::string& commit, double seconds) {
    std::map<std::string, std::string> print;
    for (const Test& test : tests)
        print[test.name] = test.print;
    nlohmann::json run = {{"time", static_cast<int64_t>(std::time(nullptr))},
                          {"commit", commit},
                          {"seconds", seconds}};
    auto& ends = run["tests"] = nlohmann::json::object();
    unsigned passed = 0, failed = 0, skipped = 0;
    for (const Result& result : results) {
        std::string how = result.status.substr(0, 1);
        (how == "p" ? passed : how == "f" ? failed : skipped) += 1;
        auto it = ends.find(result.name);
        if (it != ends.end() && it->at(0) == "f") // repeated: one failure counts
            continue;
        ends[result.name] = {how, result.seconds, print[result.name], result.seed};
    }
    run["passed"] = passed;
    run["failed"] = failed;
    run["skipped"] = skipped;
    return run;
}
