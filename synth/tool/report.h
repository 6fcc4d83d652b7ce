// SPDX-License-Identifier: MIT
//
// report: the figures as JSON for machines, as Markdown, and as one HTML page that needs no
// network.

#pragma once

#include "history.h"
#include "table.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

struct Report {
    const Plan* plan = nullptr;
    const Library* library = nullptr;
    std::vector<Row> rows;
    std::vector<Verdict> verdicts; // one for each row
    Baseline baseline;
    std::vector<Commit> commits;
    std::string yosys, commit;
    std::map<std::string, std::string> pictures; // module -> SVG of its netlist
    TextTable cores;                             // each core's cost in the chip; empty if unknown
};

std::string entriesJson(const Report& report); // docs: the contract of all figures
std::string markdown(const Report& report);
// The differences between two files of entriesJson as a table in Markdown; entries of only one file
// are new or gone.
std::string differences(const std::string& before, const std::string& after);
// Writes the page from the files of synth/report, with "@STYLE@", "@SCRIPT@" and "@DATA@" replaced.
std::string html(const Report& report, const std::string& page, const std::string& style,
                 const std::string& script);
