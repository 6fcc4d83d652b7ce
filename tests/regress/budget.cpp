// SPDX-License-Identifier: MIT

#include "budget.h"
#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

namespace {

constexpr size_t lately = 10;     // runs
constexpr double shortest = 0.02; // seconds: what a process costs that CTest calls 0.00

struct Candidate {
    Test test;
    double seconds;
    int rank; // 0: failed lately, 1: has not passed with these sources, 2: the rest
    std::set<std::string> brings;
};

// CTest's notes: "name runs seconds" a line, up to "---".
std::map<std::string, double> notesOf(const std::string& build) {
    std::map<std::string, double> notes;
    std::ifstream in(build + "/Testing/Temporary/CTestCostData.txt");
    for (std::string line; std::getline(in, line) && line != "---";) {
        const size_t cost = line.rfind(' '), runs = line.rfind(' ', cost - 1);
        if (cost != std::string::npos && runs != std::string::npos && cost > 0)
            notes[line.substr(0, runs)] = std::atof(line.c_str() + cost);
    }
    return notes;
}

bool failedLately(const std::string& name, const History& history) {
    const auto& runs = history.runs();
    return std::any_of(runs.rbegin(), runs.rbegin() + std::min(lately, runs.size()),
                       [&](const auto& run) {
                           auto it = run.at("tests").find(name);
                           return it != run.at("tests").end() && it->at(0) == "f";
                       });
}

} // namespace

std::vector<Test> withinBudget(std::vector<Test> tests, double seconds, unsigned jobs,
                               const std::string& build, const History& history,
                               const std::vector<Requirement>& plan) {
    const auto notes = notesOf(build);
    const auto secondsOf = [&](const Test& test) {
        const auto note = notes.find(test.name);
        const double takes = history.seconds(test.name);
        return std::max(shortest, takes > 0                                 ? takes
                                  : note != notes.end() && note->second > 0 ? note->second
                                                                            : 1);
    };
    std::map<std::string, double> setUp; // seconds by fixture
    for (const Test& test : tests)
        for (const std::string& fixture : test.sets)
            setUp[fixture] += secondsOf(test);
    std::vector<Candidate> candidates;
    for (Test& test : tests) {
        const std::string name = test.name;
        double takes = secondsOf(test);
        for (const std::string& fixture : test.needs)
            takes += setUp[fixture];
        const int rank = failedLately(name, history)              ? 0
                         : history.passedWith(name) != test.print ? 1
                                                                  : 2;
        std::set<std::string> brings = {"program " + name.substr(0, name.find('.')),
                                        "folder " + test.place};
        for (const Requirement& each : plan)
            for (const std::string& pattern : each.patterns)
                if (mayMatch(pattern, test))
                    brings.insert("plan " + each.text + pattern);
        candidates.push_back({std::move(test), takes, rank, brings});
    }
    std::vector<Test> chosen;
    std::set<std::string> had;
    const double longest = seconds;
    for (double left = seconds * jobs;;) {
        const auto worth =
            [&](const Candidate& each) { // one that brings nothing new is not worthless
                double fresh = 0.01;
                for (const std::string& what : each.brings)
                    fresh += had.count(what) == 0;
                return std::make_pair(-each.rank, fresh / each.seconds);
            };
        auto best = candidates.end();
        for (auto it = candidates.begin(); it != candidates.end(); ++it)
            if (it->seconds <= std::min(left, longest) &&
                (best == candidates.end() || worth(*it) > worth(*best)))
                best = it;
        if (best == candidates.end())
            return chosen;
        left -= best->seconds;
        had.insert(best->brings.begin(), best->brings.end());
        chosen.push_back(std::move(best->test));
        candidates.erase(best);
    }
}
