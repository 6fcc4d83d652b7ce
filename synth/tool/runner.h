// SPDX-License-Identifier: MIT
//
// runner: synthesis runs by Yosys, in parallel, each result kept under the hash of its sources.

#pragma once

#include "designs.h"
#include "figures.h"

#include <filesystem>
#include <string>
#include <vector>

struct Run {
    const Design* design = nullptr;
    std::string family; // "xc6s", "xc7", "ecp5": the script of that name

    std::filesystem::path netlist; // where Yosys wrote it
    Figures figures;
    std::string error; // why there are no figures, "" if there are
    bool cached = false;
    bool wanted = true; // false: only the cache is read
};

struct RunnerOptions {
    std::filesystem::path scripts; // *.ys
    std::filesystem::path cache;
    std::string yosys = "yosys";
    unsigned jobs = 1;
};

// Executes all runs and prints each end on stderr. A failed run does not stop the others.
void carryOut(std::vector<Run>& runs, const Library& library, const RunnerOptions& options);

// Writes a design as EDIF, FOLDER/<name>.edf, by the script edif.ys, and its Verilog to
// FOLDER/verilog.
void writeEdif(const Design& design, const Library& library, const RunnerOptions& options,
               const std::filesystem::path& folder);

// Returns the program's version text; throws if it does not run.
std::string versionOf(const std::string& yosys);
