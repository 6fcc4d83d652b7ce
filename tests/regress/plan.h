// SPDX-License-Identifier: MIT
//
// plan: tests/plan.md, a line a requirement of docs/ with the tests that prove it.

#ifndef PLAN_H
#define PLAN_H

#include "history.h"
#include <nlohmann/json.hpp>

struct Requirement {
    std::string page; // "bus" of docs/bus.md: the heading above it
    std::string text;
    std::vector<std::string> patterns; // of test names; * is anything
};

// Reads a plan; a tree without one has none. Throws std::runtime_error with the line that is no
// requirement.
std::vector<Requirement> readPlan(const std::string& file);

// True if a pattern matches a test's name. A program that is not built stands for all of its cases.
bool mayMatch(const std::string& pattern, const Test& test);

// Returns the patterns that match no test of `tests`, "text: pattern".
std::vector<std::string> unmatched(const std::vector<Requirement>& plan,
                                   const std::vector<Test>& tests);

// Judges each requirement by how its tests ended last: [{page, text, state, patterns, tests,
// open}], `tests` their number, `open` those that failed or, if none did, have not passed with
// these sources. The state is "proven", "failed" (also where a pattern matches nothing) or "open".
nlohmann::json judgePlan(const std::vector<Requirement>& plan, const std::vector<Test>& tests,
                         const History& history);

#endif
