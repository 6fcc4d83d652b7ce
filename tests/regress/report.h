// SPDX-License-Identifier: MIT
//
// report: the pages of a regression: report.html (offline), summary.md, badge.svg, report.json.

#ifndef REPORT_H
#define REPORT_H

#include "failures.h"
#include "history.h"
#include <nlohmann/json.hpp>

// Everything the page shows, from this run and from what other commands left in build/: coverage,
// mutants, utilisation, speed of simulation. What was not measured is absent, never invented.
nlohmann::json gather(const History& history, const std::vector<Test>& tests,
                      const std::vector<Result>& results, const std::vector<Failure>& failures,
                      const std::string& source);

void writeReports(const nlohmann::json& data, const std::string& out);

#endif
