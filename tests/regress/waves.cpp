// SPDX-License-Identifier: MIT
//
// waves: a failed test of RTL, or a failed flight, once more, with a waveform of the clocks around
// its failure.

#include "failures.h"
#include "files.h"
#include "process.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr double clocksPerSecond = 1e8; // of a flight's chip
double seconds(uint64_t clocks) {
    return static_cast<double>(clocks) / clocksPerSecond;
}

// What is to be seen again: a test's program, or a flight's recording, around a clock.
struct Scene {
    std::string program; // empty: nothing
    std::string flight;  // folder of the recording
    unsigned slot = 0;   // of the core of which the processor last heard; 0: of none
    uint64_t clock = 0, before = 2000, after = 20;
};

// Looks where the processor last heard of a core, or else of the modem, up to `end`.
void findLastEvent(Scene& scene, uint64_t end) {
    constexpr unsigned firstCore = 2;
    scene.clock = end;
    std::ifstream events(scene.flight + "/events.jsonl");
    for (std::string line; std::getline(events, line);)
        if (const json event = json::parse(line, nullptr, false);
            event.is_object() && event.contains("slot"))
            if (const auto slot = event["slot"].get<unsigned>();
                slot >= firstCore || scene.slot == 0) {
                scene.clock = event["ns"].get<uint64_t>() / 10;
                scene.slot = slot >= firstCore ? slot : 0;
            }
}

// Returns the instance in a slot, as the chip's list of cores names it.
std::string instanceIn(unsigned slot, const std::string& build) {
    const std::string list = build + "/gen/soc_cores.vh";
    const std::string text = fs::exists(list) ? readFile(list) : "";
    std::smatch match;
    const std::regex core(fmt::format("(u_\\w+) \\([^;]*`SLOT\\({}\\)", slot));
    return std::regex_search(text, match, core) ? match[1].str() : "u_modem";
}

Scene sceneOf(const Result& result, const Test& test) {
    static const std::regex atClock("at clock cycle ([0-9]+)"),
        replay("make run REPLAY='([^']+)' FROM=[0-9.]+ TO=([0-9.]+)");
    Scene scene;
    std::smatch match;
    if (std::regex_search(result.log, match, replay)) {
        scene.program = "icesoc-sim";
        scene.flight = match[1];
        findLastEvent(scene, static_cast<uint64_t>(std::stod(match[2]) * clocksPerSecond));
    } else if (std::regex_search(result.log, match, atClock)) {
        scene.program = result.name.substr(0, result.name.find('.'));
        scene.clock = std::stoull(match[1]);
    }
    // A mission's program is at work for longer than a block is.
    if (std::find(test.labels.begin(), test.labels.end(), "e2e") != test.labels.end()) {
        scene.before = 150'000;
        scene.after = 50'000;
    }
    return scene;
}

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

// Writes a save file for GTKWave: the program's rows, and ports of the models below `folder`, and
// below the folder of the block that is tested there: tests/hdl/fifo, hdl/fifo.
void writeSaveFile(const std::string& path, const std::string& wave, const fs::path& build,
                   const std::string& folder, bool hasProgram) {
    std::ostringstream save;
    save << "[dumpfile] \"" << fs::absolute(wave).string()
         << "\"\n[size] 1600 900\n[treeopen] TOP.\n"
         << (hasProgram ? "program.task\nprogram.interrupt\nprogram.function\n" : "");
    for (const std::string& place :
         std::set<std::string>{folder, std::regex_replace(folder, std::regex("^tests/"), "")}) {
        if (!fs::is_directory(build / place))
            continue;
        for (auto& entry : fs::recursive_directory_iterator(build / place)) {
            std::string stem = entry.path().stem().string();
            std::string parent = entry.path().parent_path().filename().string();
            if (entry.path().extension() == ".h" && parent == "verilated_" + stem.substr(1))
                for (const std::string& name : portsOf(entry.path()))
                    save << name << '\n';
        }
    }
    writeFile(path, save.str());
}

// Makes a failure's waveform by the build in build/trace, or says why there is none.
void addWave(Failure& failure, const Test& test, const Scene& scene, const std::string& source,
             const std::string& tested, const std::string& launcher, unsigned jobs) {
    const std::string build = source + "/build/trace";
    const auto launch = [&](std::vector<std::string> command,
                            const std::map<std::string, std::string>& environment = {}) {
        if (launcher ==
            "slurm") // where the tests ran; what it writes is in the folder that all share
            command.insert(command.begin(), {"srun", "--quiet", "--ntasks=1"});
        run(command, environment);
    };
    if (!fs::exists(build + "/build.ninja"))
        run({"cmake", "-S", source, "-B", build, "-G", "Ninja", "-DTRACE=ON"});
    Output built = run({"ninja", "-C", build, "-j", std::to_string(jobs), scene.program});
    if (built.status != 0)
        throw std::runtime_error("it does not build with waveforms:\n" + built.text);
    const std::string base = failure.log.substr(0, failure.log.size() - 4);
    const std::string wave = fs::absolute(base + ".fst").string();
    const uint64_t from = scene.clock - std::min(scene.clock, scene.before),
                   to = scene.clock + scene.after;
    if (scene.flight.empty())
        launch({"ctest", "--test-dir", build, "--no-tests=error", "-R",
                "^" +
                    std::regex_replace(failure.result.name, std::regex(R"([.+*?()\[\]{}|^$\\])"),
                                       "\\$&") +
                    "$"},
               {{"SEED", failure.result.seed},
                {"WAVE", wave},
                {"WAVE_FROM", std::to_string(from)},
                {"WAVE_TO", std::to_string(to)}});
    else
        launch({build + "/testbench/sim/icesoc-sim", "--replay", scene.flight, "--out",
                base + ".replay", "--wave", wave, "--from", fmt::format("{:.6f}", seconds(from)),
                "--to", fmt::format("{:.6f}", seconds(to))});
    if (!fs::exists(wave))
        throw std::runtime_error("the test drove no traced model");
    const bool hasProgram = fs::exists(wave + ".program.vcd");
    run({source + "/testbench/common/join_waves.sh", wave});
    failure.wave = base + ".fst";
    failure.clock = scene.clock;
    if (!scene.flight.empty())
        failure.scope = instanceIn(scene.slot, build);
    writeSaveFile(base + ".gtkw", wave, build,
                  scene.flight.empty() ? fs::relative(test.folder, tested).string()
                                       : "testbench/sim",
                  hasProgram);
    failure.save = base + ".gtkw";
}

} // namespace

void addWaves(std::vector<Failure>& failures, const std::vector<Test>& tests,
              const std::string& source, const std::string& build, const std::string& launcher,
              unsigned jobs, unsigned limit) {
    unsigned made = 0;
    for (Failure& failure : failures) {
        const Test* test = find(tests, failure.result.name);
        const Scene scene = test ? sceneOf(failure.result, *test) : Scene();
        if (scene.program.empty())
            continue;
        if (made++ == limit) {
            std::cout << fmt::format("No waveforms for more than {} failures (WAVES=n for more)\n",
                                     limit);
            return;
        }
        std::cout << fmt::format("Waveform of {} around clock {} ...\n", failure.result.name,
                                 scene.clock)
                  << std::flush;
        try {
            addWave(failure, *test, scene, source, build, launcher, jobs);
        } catch (const std::exception& error) { // the report is worth more than a waveform
            std::cout << "  none: " << error.what() << '\n';
        }
    }
}
