// SPDX-License-Identifier: MIT
//
// utilisation: the cost of the chip and of each of its parts, beside limits and the paper.

#include "cores.h"
#include "designs.h"
#include "files.h"
#include "pictures.h"
#include "placement.h"
#include "report.h"
#include "runner.h"
#include "table.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

namespace fs = std::filesystem;

namespace {

constexpr const char* mainFamily = "xc6s";
constexpr const char* wholeChip = "soc";

struct Options {
    fs::path source = ".", generated = "build/main/gen", output = "build/synth";
    std::vector<std::string> only, families{mainFamily};
    std::string yosys = "yosys";
    unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
    bool accept = false;
    std::vector<std::string> cores; // print only their cost
    std::string nextpnr;            // places the designs for ECP5
    std::string edif;               // a design's name
    std::string compare;            // another report.json
};

constexpr size_t shownCommits = 30;

// Returns every folder of platform RTL, cores and generated files, in this order.
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

// The Verilog of all cores of the build, wherever it is, or (`isRead` false) the headers.
std::vector<fs::path> coreFiles(const Options& o, bool isRead) {
    static const std::regex verilog("\\.s?v", std::regex::icase);
    std::vector<fs::path> files;
    std::ifstream list(o.generated / "cores.files");
    for (std::string line; std::getline(list, line);)
        if (std::regex_match(fs::path(line).extension().string(), verilog) == isRead &&
            fs::exists(line))
            files.push_back(line);
    return files;
}

void print(const Report& r) {
    for (const Row& row : r.rows)
        if (row.design->beside && row.main->wanted && row.main->error.empty())
            fmt::print("{}\n{}\n{}\n{}\n", row.design->title, paperTable(*r.plan, row).plain(),
                       costTable(*r.library, row, 2).plain(), pathTable(*r.plan, row, 5).plain());
    if (!r.cores.rows().empty())
        fmt::print("{}\n", r.cores.plain());
    std::vector<Row> wanted;
    std::copy_if(r.rows.begin(), r.rows.end(), std::back_inserter(wanted),
                 [](const Row& row) { return row.main->wanted; });
    fmt::print("{}", designTable(*r.plan, wanted, countsOf(r.baseline)).plain());
    if (!r.baseline.yosys.empty() && shortVersion(r.baseline.yosys) != shortVersion(r.yosys))
        fmt::print("The accepted figures are by {}, these by {}: growth is not judged.\n",
                   shortVersion(r.baseline.yosys), shortVersion(r.yosys));
    std::string fresh;
    for (size_t i = 0; i < r.rows.size(); i++) {
        if (r.rows[i].main->wanted && r.baseline.designs.count(r.rows[i].design->name) == 0)
            fresh += " " + r.rows[i].design->name;
        for (const std::string& note : r.verdicts[i].notes)
            fmt::print("{}\n", note);
        for (const std::string& failure : r.verdicts[i].failures)
            fmt::print("FAILED {}\n", failure);
    }
    if (!fresh.empty())
        fmt::print("No accepted figures yet (`make synth-accept` records them):{}\n", fresh);
}

void writeReports(const Report& r, const Options& o) {
    writeFile(o.output / "report.json", entriesJson(r));
    writeFile(o.output / "report.md", markdown(r));
    const fs::path parts = o.source / "synth/report";
    writeFile(o.output / "report.html",
              html(r, readFile(parts / "page.html"), pageStyle() + readFile(parts / "page.css"),
                   pageScript() + readFile(parts / "page.js")));
    fmt::print("Page: {}\n", (o.output / "report.html").string());
}

// Records the measured figures; other designs stay as they are. A figure above a limit of
// synth/designs.json is refused: only an edit moves a limit.
int accept(const Report& r, const fs::path& file) {
    Baseline b = r.baseline;
    if (shortVersion(b.yosys) != shortVersion(r.yosys))
        b.designs.clear(); // figures of two versions do not belong together
    b.yosys = r.yosys;
    std::map<std::string, Accepted> kept; // without removed designs
    for (const Row& row : r.rows) {
        const std::string& name = row.design->name;
        if (!row.main->wanted) {
            if (b.designs.count(name))
                kept[name] = b.designs[name];
            continue;
        }
        if (!row.main->error.empty())
            throw std::runtime_error(fmt::format("{} failed: nothing is accepted", name));
        const auto above = aboveLimits(row);
        if (!above.empty())
            throw std::runtime_error(
                fmt::format("{}: nothing is accepted; limits are in synth/designs.json", above[0]));
        kept[name] = acceptedFrom(row.main->figures);
    }
    b.designs = kept;
    writeFile(file, written(b));
    fmt::print("Accepted: {}; commit it.\n", file.string());
    return 0;
}

Library rtlOf(const Options& o) {
    if (!fs::is_directory(o.generated))
        throw std::runtime_error(fmt::format("{} is not there: build first", o.generated.string()));
    const std::vector<fs::path> folders = rtlFolders(o); // include files lie beside the modules
    const std::vector<fs::path> files = coreFiles(o, true);
    std::vector<fs::path> includes = folders;
    for (const auto& some : {files, coreFiles(o, false)})
        for (const fs::path& file : some)
            includes.push_back(file.parent_path());
    return Library(folders, includes, files);
}

// Throws if a design that the command line names is not in the plan.
void checkNames(const Plan& plan, const Options& o) {
    std::vector<std::string> wanted = o.only;
    if (!o.edif.empty())
        wanted.push_back(o.edif);
    for (const std::string& name : wanted)
        if (std::none_of(plan.designs.begin(), plan.designs.end(),
                         [&](const Design& d) { return d.name == name; }))
            throw std::runtime_error(fmt::format("there is no design {}", name));
}

void edif(const Plan& plan, const Library& library, const RunnerOptions& options,
          const Options& o) {
    const auto design = std::find_if(plan.designs.begin(), plan.designs.end(),
                                     [&](const Design& d) { return d.name == o.edif; });
    fmt::print(stderr, "{} as EDIF ...\n", o.edif);
    writeEdif(*design, library, options, o.output / "ise");
    fmt::print("{} and its Verilog in {}; docs/utilisation.md says how to go on.\n",
               (o.output / "ise" / (o.edif + ".edf")).string(),
               (o.output / "ise/verilog").string());
}

// Synthesises the wanted designs for each family; the others come from the cache.
std::vector<Run> synthesise(const Plan& plan, const Library& library, const RunnerOptions& options,
                            const Options& o) {
    const auto isWanted = [&](const Design& design) {
        return o.only.empty() ||
               std::find(o.only.begin(), o.only.end(), design.name) != o.only.end();
    };
    std::vector<Run> runs;
    for (const std::string& family : o.families)
        for (const Design& design : plan.designs)
            runs.push_back({&design, family, {}, {}, {}, false, isWanted(design)});
    carryOut(runs, library, options);
    for (const Run& run : runs)
        if (run.wanted && !run.error.empty())
            fmt::print(stderr, "utilisation: {} for {}: {}\n", run.design->name, run.family,
                       run.error);
    return runs;
}

// Reads a project file; exceptions have its name.
template <class Read> auto named(const fs::path& file, Read read) {
    try {
        return read();
    } catch (const nlohmann::json::exception& e) {
        throw std::runtime_error(fmt::format("{}: {}", file.string(), e.what()));
    }
}

Baseline acceptedOf(const Options& o) {
    const fs::path file = o.source / "synth/baseline.json";
    return named(file, [&] { return readBaseline(fs::exists(file) ? readFile(file) : ""); });
}

// Prints some cores' cost in the chip, whatever the limits: in the synthesised chip, the only
// requested design, or, without `runs`, in the accepted one, where missing cores are allowed.
// Returns 1 if the synthesis failed.
int tellCores(const Library& library, const RunnerOptions& options, const Options& o,
              const std::vector<Run>& runs) {
    const auto run = std::find_if(runs.begin(), runs.end(), [](const Run& r) { return r.wanted; });
    const bool accepted = run == runs.end();
    if (!accepted && !run->error.empty())
        return 1;
    const Accepted chip = accepted ? acceptedOf(o).designs[wholeChip] : acceptedFrom(run->figures);
    const ChipMap map = readMap(o.generated / "map.regs.json");
    if (map.empty())
        throw std::runtime_error(
            fmt::format("{} has no map.regs.json: build first", o.generated.string()));
    try {
        const TextTable table = coreTable(chip.costs, map, slotCost(library, options, map, true),
                                          o.cores, accepted ? "synth/baseline.json" : "the list");
        fmt::print("{}The chip: {} LUT, {} FF, {:g} block RAMs, {} DSP\n", table.plain(), chip.lut,
                   chip.ff, chip.ram, chip.dsp);
    } catch (const NotInChip& missing) {
        if (!accepted)
            throw;
        fmt::print("{}\n", missing.what());
    }
    return 0;
}

// Returns a row for each core of the chip; none if the chip was not synthesised.
TextTable coresOf(const Report& r, const RunnerOptions& options, const Options& o) {
    const ChipMap map = readMap(o.generated / "map.regs.json");
    for (const Row& row : r.rows)
        if (row.design->name == wholeChip && row.main->error.empty() && !map.empty())
            return coreTable(row.main->figures.costs, map,
                             slotCost(*r.library, options, map, row.main->wanted), {}, "");
    return {};
}

int report(const Options& o) {
    const Library library = rtlOf(o);
    const fs::path designs = o.source / "synth/designs.json";
    Plan plan = named(designs, [&] { return readPlan(designs, library, o.source); });
    if (!o.cores.empty()) // other orders only serve the median of clocks
        for (Design& design : plan.designs)
            design.orders = 0;
    checkNames(plan, o);
    // The cache then has a design that another run is synthesising.
    const FolderLock lock(o.output, "utilisation");
    const RunnerOptions options{o.source / "synth/yosys", o.output / "cache", o.yosys, o.jobs};
    if (!o.edif.empty()) {
        edif(plan, library, options, o);
        return 0;
    }
    const std::string tree = treeState(o.source, "bus hdl ip slice synth");
    if (!o.cores.empty())
        return tellCores(library, options, o,
                         o.only.empty() ? std::vector<Run>{}
                                        : synthesise(plan, library, options, o));
    const std::vector<Run> runs = synthesise(plan, library, options, o);

    Report r;
    r.plan = &plan;
    r.library = &library;
    r.rows = rowsOf(plan, runs, mainFamily);
    r.yosys = versionOf(o.yosys);
    r.baseline = acceptedOf(o);
    for (const Row& row : r.rows)
        r.verdicts.push_back(judge(row, r.baseline, r.yosys, plan.chip.mhz));
    r.commits = history(o.source, shownCommits);
    r.commit = currentCommit(o.source);
    r.pictures = drawNetlists(plan, library, options);

    if (o.accept)
        return accept(r, o.source / "synth/baseline.json");
    r.cores = coresOf(r, options, o);
    print(r);
    writeReports(r, o);
    if (!o.nextpnr.empty()) {
        const TextTable table = placed(r.rows, o.nextpnr, o.jobs);
        fmt::print("\n{}", table.plain());
        writeFile(o.output / "placed.md", table.markdown());
    }
    writeFile(o.output / "tree", tree + "\n");
    return std::any_of(r.verdicts.begin(), r.verdicts.end(),
                       [](const Verdict& v) { return !v.failures.empty(); });
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
    app.add_option("--family", o.families, "these chips, too, beside xc6s: xc7, ecp5")
        ->check(CLI::IsMember({"xc6s", "xc7", "ecp5"}));
    app.add_option("--yosys", o.yosys, "the program")->capture_default_str();
    app.add_option("--jobs", o.jobs, "synthesis runs at a time")->capture_default_str();
    app.add_flag("--accept", o.accept, "record these figures in synth/baseline.json");
    app.add_option("--core", o.cores,
                   "only tell what this core costs in the accepted chip (may be repeated); with "
                   "--design soc in the chip of now");
    app.add_option("--compare", o.compare,
                   "only tell how the last report differs from this report.json")
        ->check(CLI::ExistingFile);
    app.add_option("--place", o.nextpnr, "place the designs for ECP5 by this nextpnr-ecp5");
    app.add_option("--edif", o.edif, "only write this design as EDIF for ISE, into the folder ise");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "utilisation: {}; see --help\n", error.what());
        return 2;
    }
    if (std::find(o.families.begin(), o.families.end(), mainFamily) == o.families.end())
        o.families.insert(o.families.begin(), mainFamily);
    if (!o.nextpnr.empty() &&
        std::find(o.families.begin(), o.families.end(), "ecp5") == o.families.end())
        o.families.push_back("ecp5");
    try {
        if (!o.compare.empty()) {
            fmt::print("{}", differences(readFile(o.compare), readFile(o.output / "report.json")));
            return 0;
        }
        return report(o);
    } catch (const std::exception& e) {
        fmt::print(stderr, "utilisation: {}\n", e.what());
        return 2;
    }
}
