// SPDX-License-Identifier: MIT
//
// waves: a failed RTL test once more, with a waveform of the clocks around its failure.

#include "failures.h"
#include "files.h"
#include "process.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <regex>
#include <sstream>

namespace fs = std::filesystem;

namespace {

constexpr unsigned clocksBefore = 2000, clocksAfter = 20;

const Test* find(const std::vector<Test>& tests, const std::string& name) {
    for (const Test& test : tests)
        if (test.name == name)
            return &test;
    return nullptr;
}

// Ports of a Verilated module: VL_IN8(&clk_i,0,0); in its header.
std::vector<std::string> portsOf(const fs::path& header) {
    const std::string text = readFile(header);
    static const std::regex port(R"(VL_(?:IN|OUT)[0-9W]*\(&(\w+),(\d+),(\d+))");
    std::vector<std::string> names;
    for (std::sregex_iterator it(text.begin(), text.end(), port), end; it != end; ++it) {
        std::string name = (*it)[1];
        unsigned msb = static_cast<unsigned>(std::stoul((*it)[2])),
                 lsb = static_cast<unsigned>(std::stoul((*it)[3]));
        names.push_back("TOP." + name + (msb > lsb ? fmt::format("[{}:{}]", msb, lsb) : ""));
    }
    return names;
}

void writeSaveFile(const std::string& path, const std::string& wave, const fs::path& folder) {
    std::ostringstream save;
    save << "[dumpfile] \"" << fs::absolute(wave).string()
         << "\"\n[size] 1600 900\n[treeopen] TOP.\n";
    for (auto& entry : fs::recursive_directory_iterator(folder)) {
        std::string stem = entry.path().stem().string();
        std::string parent = entry.path().parent_path().filename().string();
        if (entry.path().extension() == ".h" && parent == "verilated_" + stem.substr(1))
            for (const std::string& name : portsOf(entry.path()))
                save << name << '\n';
    }
    writeFile(path, save.str());
}

} // namespace

void addWaves(std::vector<Failure>& failures, const std::vector<Test>& tests,
              const std::string& source, unsigned jobs, unsigned limit) {
    const std::string build = source + "/build/trace";
    unsigned made = 0;
    static const std::regex atClock("at clock cycle ([0-9]+)");
    for (Failure& failure : failures) {
        const Test* test = find(tests, failure.result.name);
        if (!test ||
            std::find(test->labels.begin(), test->labels.end(), "rtl") == test->labels.end())
            continue;
        std::smatch match;
        if (!std::regex_search(failure.result.log, match, atClock))
            continue; // no clocked bench took part
        if (made == limit) {
            std::cout << fmt::format("No waveforms for more than {} failures (WAVES=n for more)\n",
                                     limit);
            return;
        }
        ++made;
        uint64_t clock = std::stoull(match[1]);
        std::cout << fmt::format("Waveform of {} around clock {} ...\n", failure.result.name, clock)
                  << std::flush;
        if (!fs::exists(build + "/build.ninja"))
            run({"cmake", "-S", source, "-B", build, "-G", "Ninja", "-DTRACE=ON"});
        std::string program = failure.result.name.substr(0, failure.result.name.find('.'));
        Output built = run({"ninja", "-C", build, "-j", std::to_string(jobs), program});
        if (built.status != 0) {
            std::cout << "  it does not build with waveforms:\n" << built.text;
            continue;
        }
        std::string base = failure.log.substr(0, failure.log.size() - 4);
        std::string wave = fs::absolute(base + ".fst").string();
        Output list =
            run({"ctest", "--test-dir", build, "--no-tests=error", "-R",
                 "^" +
                     std::regex_replace(failure.result.name, std::regex(R"([.+*?()\[\]{}|^$\\])"),
                                        "\\$&") +
                     "$"},
                {{"SEED", failure.result.seed},
                 {"WAVE", wave},
                 {"WAVE_FROM", std::to_string(clock > clocksBefore ? clock - clocksBefore : 0)},
                 {"WAVE_TO", std::to_string(clock + clocksAfter)}});
        if (!fs::exists(wave)) {
            std::cout << "  the test drove no traced model\n";
            continue;
        }
        failure.wave = wave;
        failure.save = base + ".gtkw";
        writeSaveFile(failure.save, wave, build + "/tests/" + test->place);
    }
}
