// SPDX-License-Identifier: MIT
//
// pictures: netlists of small modules as SVG, drawn by Yosys' `show` and Graphviz.

#include "pictures.h"

#include "files.h"
#include "process.h"
#include <algorithm>
#include <fmt/format.h>
#include <mutex>
#include <regex>

namespace fs = std::filesystem;
using std::string;

namespace {

constexpr size_t mostLines = 140;      // of the drawing's description: boxes and arrows
constexpr size_t mostBytes = 64 << 10; // of a picture, so that the page stays small

// The module's own netlist, before mapping: as in the source, with instances as boxes.
string scriptFor(const Library& library, const Design& design, const fs::path& stem) {
    string script;
    for (const fs::path& folder : library.includeFolders())
        script += fmt::format("verilog_defaults -add -I{}\n", folder.string());
    for (const fs::path& file : library.filesOf(design.top))
        script += fmt::format("read_verilog \"{}\"\n", file.string());
    return script + fmt::format("hierarchy -top {0}\nproc\nopt_expr\nopt_clean\ncd {0}\n"
                                "show -format dot -width -notitle -viewer none -prefix {1}\n",
                                design.top, stem.string());
}

void draw(const Library& library, const Design& design, const RunnerOptions& options,
          const fs::path& stem) {
    const string script = stem.string() + ".picture.ys", dot = stem.string() + ".dot";
    writeFile(script, scriptFor(library, design, stem));
    string svg; // empty if it is too large
    if (run({options.yosys, "-q", "-s", script}).status == 0) {
        const string text = readFile(dot);
        if (static_cast<size_t>(std::count(text.begin(), text.end(), '\n')) <= mostLines &&
            run({"dot", "-Tsvg", dot, "-o", dot + ".svg"}).status == 0) {
            const string drawn = readFile(dot + ".svg");
            if (drawn.size() <= mostBytes && drawn.find("<svg") != string::npos)
                svg = drawn.substr(drawn.find("<svg"));
        }
    }
    writeFile(stem.string() + ".svg", svg);
}

} // namespace

std::map<string, string> drawNetlists(const Plan& plan, const Library& library,
                                      const RunnerOptions& options) {
    std::map<string, string> pictures;
    try {
        run({"dot", "-V"});
    } catch (const std::runtime_error&) {
        fmt::print(stderr, "no netlist pictures: Graphviz' dot does not run\n");
        return pictures;
    }
    // Removes a quarter of Graphviz' text, which the page does not show.
    const std::regex unused("<!--[^>]*>\n|<title>[^<]*</title>\n|"
                            " font-(family|size)=\"[^\"]*\"| (id|class)=\"[^\"]*\"");
    std::mutex mutex;
    inParallel(options.jobs, plan.designs.size(), [&](size_t i) {
        const Design& design = plan.designs[i];
        const fs::path stem =
            options.cache / fmt::format("{}.{}", design.top, library.hashOf(design.top));
        if (!fs::exists(stem.string() + ".svg"))
            draw(library, design, options, stem);
        const string svg = readFile(stem.string() + ".svg");
        const std::lock_guard<std::mutex> lock(mutex);
        if (!svg.empty())
            pictures[design.top] = std::regex_replace(svg, unused, "");
    });
    return pictures;
}
