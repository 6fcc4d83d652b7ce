// SPDX-License-Identifier: MIT
//
// runner: synthesis runs by Yosys, in parallel, each result kept under the hash of its sources.

#include "runner.h"

#include "files.h"
#include "process.h"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <fmt/format.h>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace fs = std::filesystem;

namespace {

int ordersOf(const Run& run) {
    return run.family == "xc6s" ? run.design->orders : 0;
}

std::string netlistOfOrder(const fs::path& netlist, int order) {
    return fmt::format("{}.{}", netlist.string(), order);
}

std::string replaceAll(std::string text, const std::string& what, const std::string& by) {
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

std::string scriptOf(const Run& run, const Library& library, const RunnerOptions& options,
                     const std::string& output) {
    std::string sources, includes, parameters, system; // SystemVerilog has words of its own
    for (const fs::path& file : library.filesOf(run.design->top)) {
        const std::string end = file.extension().string();
        (end == ".sv" || end == ".SV" ? system : sources) += fmt::format(" \"{}\"", file.string());
    }
    if (!system.empty())
        sources += "\nread_verilog -sv @INCLUDES@" + system;
    for (const fs::path& folder : library.includeFolders())
        includes += fmt::format(" -I{}", folder.string());
    for (const auto& [name, value] : run.design->parameters)
        parameters += fmt::format("chparam -set {} {} {}\n", name, value, run.design->top);
    std::string script = readFile(options.scripts / (run.family + ".ys"));
    const std::string map = readFile(options.scripts / "xilinx_map.ys");
    std::string orders;
    if (ordersOf(run) != 0) // elaborated anew: an earlier copy would change the first mapping
        orders = fmt::format("design -reset\n{}design -save unmapped\n",
                             script.substr(0, script.find("@MAP@")));
    for (int order = 1; order <= ordersOf(run); order++) {
        const std::string permuted =
            replaceAll(map, "@ORDER@", fmt::format("permute,-S,{};strash;", order));
        orders += fmt::format("design -load unmapped\n{}select A:top\njson -o {}\nselect -clear\n",
                              permuted, netlistOfOrder(run.netlist, order));
    }
    script = replaceAll(script, "@MAP@", replaceAll(map, "@ORDER@", ""));
    script = replaceAll(script, "@ORDERS@", orders);
    script = replaceAll(script, "@SOURCES@", sources);
    script = replaceAll(script, "@INCLUDES@", includes);
    script = replaceAll(script, "@PARAMETERS@", parameters);
    script = replaceAll(script, "@TOP@", run.design->top);
    return replaceAll(script, "@OUTPUT@", output);
}

// The error lines of a log.
std::string errorsIn(const std::string& log) {
    std::istringstream lines(log);
    std::string line, errors, last;
    while (std::getline(lines, line)) {
        if (line.find("ERROR") != std::string::npos)
            errors += line + "\n";
        last = line;
    }
    return errors.empty() ? last + "\n" : errors;
}

void synthesise(const Run& run, const Library& library, const RunnerOptions& options) {
    const std::string part = run.netlist.string() + ".part";
    const std::string script = fs::path(run.netlist).replace_extension(".ys").string();
    const std::string log = fs::path(run.netlist).replace_extension(".log").string();
    writeFile(script, scriptOf(run, library, options, part));
    const Output yosys = ::run({options.yosys, "-q", "-s", script});
    writeFile(log, yosys.text);
    if (yosys.status != 0)
        throw std::runtime_error(errorsIn(yosys.text) + "whole log: " + log);
    fs::rename(part, run.netlist);
}

void carryOutOne(Run& run, const Library& library, const RunnerOptions& options,
                 const std::string& tools, const std::string& program) {
    const std::string sources =
        hexHash({library.hashOf(run.design->top), tools, scriptOf(run, library, options, "")});
    const fs::path stem =
        options.cache / fmt::format("{}.{}.{}", run.design->name, run.family, sources);
    run.netlist = stem.string() + ".json";
    const fs::path kept = fmt::format("{}.{}.figures", stem.string(), program);
    run.cached = fs::exists(run.netlist);
    if (run.cached && fs::exists(kept)) {
        run.figures = nlohmann::json::parse(readFile(kept)).get<Figures>();
        return;
    }
    if (!run.cached && !run.wanted) {
        run.error = "not synthesised since its sources changed";
        return;
    }
    if (!run.cached)
        synthesise(run, library, options);
    const FilesAlong filesAlong = [&](const std::string& path) {
        return library.filesAlong(run.design->top, path);
    };
    std::vector<Figures> orders{
        figuresOf(readNetlist(run.netlist), run.family == "xc6s", filesAlong)};
    for (int order = 1; order <= ordersOf(run); order++)
        orders.push_back(
            figuresOf(readNetlist(netlistOfOrder(run.netlist, order)), true, filesAlong));
    std::stable_sort(orders.begin(), orders.end(),
                     [](const Figures& a, const Figures& b) { return a.lut < b.lut; });
    const size_t middle = orders.size() / 2;
    run.figures = orders[middle];
    for (size_t order = 0; order < orders.size(); order++) {
        if (order == middle)
            continue;
        run.figures.otherLuts.push_back(orders[order].lut); // rising
        run.figures.clocks.push_back(orders[order].clock());
    }
    writeFile(kept, nlohmann::json(run.figures).dump());
}

} // namespace

void writeEdif(const Design& design, const Library& library, const RunnerOptions& options,
               const fs::path& folder) {
    const fs::path verilog = folder / "verilog";
    fs::remove_all(verilog);
    fs::create_directories(verilog);
    for (const fs::path& file : library.filesOf(design.top))
        fs::copy_file(file, verilog / file.filename());
    for (const fs::path& include : library.includeFolders())
        for (const auto& entry : fs::directory_iterator(include))
            if (entry.path().extension() == ".vh")
                fs::copy_file(entry.path(), verilog / entry.path().filename(),
                              fs::copy_options::skip_existing);
    Run run;
    run.design = &design;
    run.family = "edif";
    run.netlist = folder / (design.name + ".edf");
    synthesise(run, library, options);
    fs::rename(run.netlist.string() + ".part.json", folder / (design.name + ".json"));
}

std::string versionOf(const std::string& yosys) {
    const std::string text = run({yosys, "-V"}).text;
    return text.substr(0, text.find('\n'));
}

void carryOut(std::vector<Run>& runs, const Library& library, const RunnerOptions& options) {
    const std::string version = versionOf(options.yosys);
    fs::create_directories(options.cache);
    const std::string program = hexHash({readFile("/proc/self/exe")});

    // Designs with limits first, since these are looked at; then the largest, so that none starts
    // when all others are done.
    std::vector<std::pair<std::uintmax_t, size_t>> order;
    for (size_t i = 0; i < runs.size(); i++) {
        std::uintmax_t bytes = 0;
        for (const fs::path& file : library.filesOf(runs[i].design->top))
            bytes += fs::file_size(file);
        order.emplace_back(runs[i].design->limits.empty() ? bytes : UINTMAX_MAX, i);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });

    const auto total =
        std::count_if(runs.begin(), runs.end(), [](const Run& r) { return r.wanted; });
    std::atomic<size_t> done{0};
    std::mutex terminal;
    inParallel(options.jobs, runs.size(), [&](size_t place) {
        const size_t i = order[place].second;
        const auto begin = std::chrono::steady_clock::now();
        try {
            carryOutOne(runs[i], library, options, version, program);
        } catch (const std::exception& e) {
            runs[i].error = e.what();
        }
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        const std::lock_guard<std::mutex> lock(terminal);
        done += runs[i].wanted;
        if (!runs[i].cached && runs[i].wanted)
            fmt::print(stderr, "[{}/{}] {} for {}: {} ({:.1f} s)\n", done.load(), total,
                       runs[i].design->name, runs[i].family,
                       runs[i].error.empty()
                           ? fmt::format("{} LUT, {} FF", runs[i].figures.lut, runs[i].figures.ff)
                           : "failed",
                       took.count());
    });
}
