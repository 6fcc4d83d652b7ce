// SPDX-License-Identifier: MIT
//
// placement: one run of nextpnr a seed, and its report in JSON.

#include "placement.h"

#include "files.h"
#include "process.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace fs = std::filesystem;

namespace {

constexpr size_t seeds = 5;

fs::path reportOf(const Run& run, size_t seed) {
    return fs::absolute(fmt::format("{}.placed.{}", run.netlist.string(), seed));
}

// LFE5U-45F, speed grade 6, the slowest. The memory's ports end within the chip, so there are no
// pads: a block "out of context".
void place(const Run& run, size_t seed, const std::string& nextpnr) {
    const fs::path report = reportOf(run, seed);
    if (fs::exists(report))
        return;
    const std::string part = report.string() + ".part";
    const Output output =
        ::run({nextpnr, "-q", "--45k", "--package", "CABGA381", "--speed", "6", "--out-of-context",
               "--json", fs::absolute(run.netlist).string(), "--top", run.design->top, "--freq",
               "100", "--timing-allow-fail", "--seed", std::to_string(seed), "--report", part});
    if (output.status != 0)
        throw std::runtime_error(
            fmt::format("nextpnr cannot place {}: {}", run.design->name, output.text));
    fs::rename(part, report);
}

} // namespace

TextTable placed(const std::vector<Row>& rows, const std::string& nextpnr, unsigned jobs) {
    std::vector<const Run*> runs;
    std::vector<double> estimates;
    for (const Row& row : rows)
        for (const Run* run : row.others)
            if (run->family == "ecp5" && run->wanted && run->error.empty()) {
                runs.push_back(run);
                estimates.push_back(row.main->figures.clock());
            }
    inParallel(jobs, seeds * runs.size(),
               [&](size_t i) { place(*runs[i / seeds], i % seeds + 1, nextpnr); });
    TextTable table;
    table.add({"placed on ECP5", "MHz, median", "least", "most", "Spartan-6, estimated", "LUT4",
               "FF", "of the chip"});
    for (size_t i = 0; i < runs.size(); ++i) {
        std::vector<double> mhz;
        nlohmann::json used;
        for (size_t seed = 1; seed <= seeds; ++seed) {
            const auto report = nlohmann::json::parse(readFile(reportOf(*runs[i], seed)));
            used = report.at("utilization");
            double slowest = 1e9;
            for (const auto& [clock, figures] : report.at("fmax").items())
                slowest = std::min<double>(slowest, figures.at("achieved"));
            mhz.push_back(slowest);
        }
        std::sort(mhz.begin(), mhz.end());
        const int luts = used.at("TRELLIS_COMB").at("used");
        table.add({runs[i]->design->name, fmt::format("{:.0f}", mhz[seeds / 2]),
                   fmt::format("{:.0f}", mhz.front()), fmt::format("{:.0f}", mhz.back()),
                   fmt::format("{:.0f}", estimates[i]), std::to_string(luts),
                   std::to_string(int(used.at("TRELLIS_FF").at("used"))),
                   percent(luts, used.at("TRELLIS_COMB").at("available"))});
    }
    return table;
}
