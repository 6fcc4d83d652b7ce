// SPDX-License-Identifier: MIT
//
// utilisation: what the chip and each of its parts take of the FPGA, beside limits and the paper.

#include "designs.h"
#include "runner.h"
#include "table.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <iostream>
#include <thread>

namespace fs = std::filesystem;

namespace {

constexpr const char* mainFamily = "xc6s";

struct Options {
    fs::path source = ".", generated = "build/main/gen", output = "build/synth";
    std::vector<std::string> only, families{mainFamily, "xc7", "ecp5"};
    std::string yosys = "yosys";
    unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
};

// Every folder of platform RTL, cores and what was generated, in this order.
std::vector<fs::path> rtlFolders(const Options& o) {
    std::vector<fs::path> folders{o.source / "synth", o.source / "hdl", o.source / "bus"};
    for (const char* room : {"hdl", "ip"})
        for (const auto& entry : fs::directory_iterator(o.source / room))
            if (entry.is_directory())
                folders.push_back(entry.path());
    std::sort(folders.begin() + 3, folders.end());
    folders.push_back(o.generated);
    return folders;
}

int report(const Options& o) {
    if (!fs::is_directory(o.generated))
        throw std::runtime_error(fmt::format("{} is not there: build first", o.generated.string()));
    const Library library(rtlFolders(o), {o.generated});
    Plan plan = readPlan(o.source / "synth/designs.json", library, o.source);
    for (const std::string& name : o.only)
        if (std::none_of(plan.designs.begin(), plan.designs.end(),
                         [&](const Design& d) { return d.name == name; }))
            throw std::runtime_error(fmt::format("there is no design {}", name));
    if (!o.only.empty())
        plan.designs.erase(std::remove_if(plan.designs.begin(), plan.designs.end(),
                                          [&](const Design& d) {
                                              return std::find(o.only.begin(), o.only.end(),
                                                               d.name) == o.only.end();
                                          }),
                           plan.designs.end());

    std::vector<Run> runs;
    for (const std::string& family : o.families)
        for (const Design& design : plan.designs)
            runs.push_back({&design, family, {}, {}, {}, false});
    carryOut(runs, library, {o.source / "synth/yosys", o.output / "cache", o.yosys, o.jobs});

    const std::vector<Row> rows = rowsOf(plan, runs, mainFamily);
    int status = 0;
    for (const Row& row : rows)
        if (row.design->beside && row.main->error.empty())
            fmt::print("{}\n{}\n{}\n{}\n", row.design->title, paperTable(plan, row).plain(),
                       costTable(library, row, 2).plain(), pathTable(plan, row, 5).plain());
    fmt::print("{}", designTable(plan, rows).plain());
    for (const Run& run : runs)
        if (!run.error.empty()) {
            fmt::print(stderr, "utilisation: {} for {}: {}\n", run.design->name, run.family,
                       run.error);
            status = 1;
        }
    return status;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "What the chip and each of its parts take of the FPGA, beside limits and the paper."};
    Options o;
    app.add_option("--source", o.source, "the project's folder")->capture_default_str();
    app.add_option("--generated", o.generated, "folder of generated Verilog")
        ->capture_default_str();
    app.add_option("--output", o.output, "folder of the reports")->capture_default_str();
    app.add_option("--design", o.only, "only this design (may be repeated)");
    app.add_option("--family", o.families, "only these chips: xc6s (always), xc7, ecp5")
        ->check(CLI::IsMember({"xc6s", "xc7", "ecp5"}));
    app.add_option("--yosys", o.yosys, "the program")->capture_default_str();
    app.add_option("--jobs", o.jobs, "synthesis runs at a time")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    if (std::find(o.families.begin(), o.families.end(), mainFamily) == o.families.end())
        o.families.insert(o.families.begin(), mainFamily);
    try {
        return report(o);
    } catch (const std::exception& e) {
        fmt::print(stderr, "utilisation: {}\n", e.what());
        return 2;
    }
}
