// SPDX-License-Identifier: MIT
//
// budget: the tests that are worth most where there is not the time for all.

#ifndef BUDGET_H
#define BUDGET_H

#include "history.h"
#include "plan.h"

// Returns those of `tests` that take `seconds` of `jobs` processors together, best first: those
// that failed in one of the newest ten runs, then those that have not passed with these sources,
// then the rest; among each the next is the one that brings most per second of what none before it
// had: its program, its folder, patterns of the plan. A test takes what it took last, by `history`
// or by CTest's own notes in `build`, and what sets its fixtures up besides; one that has never run
// counts as a second.
std::vector<Test> withinBudget(std::vector<Test> tests, double seconds, unsigned jobs,
                               const std::string& build, const History& history,
                               const std::vector<Requirement>& plan);

#endif
