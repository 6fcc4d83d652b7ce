// SPDX-License-Identifier: MIT
//
// coremap: writes the cores of ip/cores.list, a line each, as map.regs.json (slots, memory ports,
// buffers in DDR3, pins), soc_cores.vh (instances, for soc.v), soc_cores.c (servants), soc_pins.h
// (for the simulator), core_pins.ucf (for ISE) and probes.json (the probes' signals).

#include "core_list.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

namespace {

std::string read(const std::string& path) {
    std::ifstream in(path);
    if (!in)
        throw std::runtime_error("1: error: cannot read '" + path + "'");
    return {std::istreambuf_iterator<char>(in), {}};
}

void save(const std::string& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.close();
    if (!out)
        throw std::runtime_error("1: error: cannot write '" + path + "'");
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Puts the cores of a list into the chip: address map, instances in Verilog, the "
                 "firmware's table."};
    std::string list, base, outputDir = ".";
    std::vector<std::string> cores, blocks, clocked, idle, clocks;
    app.add_option(
           "list", list,
           "a core a line: folder [name=] [identity=] [slot=] [memory=] [gate=on] [clock=3/8] "
           "[signals=u_fir.count:9] "
           "[input=core.output] [pin=@places]")
        ->required();
    app.add_option("--base", base, "the platform's map.regs.json")->required();
    app.add_option("--core", cores, "folder=its description (*.regs.json)");
    app.add_option("--clocked", clocked, "folder of a core with the parameter CLK_HZ");
    app.add_option("--own-clock", clocks, "folder=Hz at most, of a core with a clock of its own");
    app.add_option("--idle", idle, "folder of a core with the output idle_o");
    app.add_option("--block", blocks,
                   "slot=name=description of a block of the platform, for the pages");
    app.add_option("--output-dir", outputDir, "where the files go");
    CLI11_PARSE(app, argc, argv);
    try {
        std::map<std::string, nlohmann::json> descriptions;
        std::map<std::string, std::string> constraints;
        for (const std::string& c : cores) {
            size_t equals = c.find('=');
            if (equals == std::string::npos)
                throw std::runtime_error("1: error: --core folder=file, not '" + c + "'");
            std::string folder = c.substr(0, equals), file = c.substr(equals + 1);
            descriptions[folder] = nlohmann::json::parse(read(file));
            auto own = std::filesystem::path(file).replace_filename(folder + ".ucf");
            if (std::filesystem::exists(own))
                constraints[folder] = read(own.string());
        }
        for (const std::string& o : clocks)
            if (auto at = descriptions.find(o.substr(0, o.find('='))); at != descriptions.end())
                at->second["own_clock"] = std::stoul(o.substr(o.find('=') + 1));
        auto platform = nlohmann::ordered_json::parse(read(base));
        Chip chip = readCores(read(list), platform, descriptions);
        for (Core& c : chip.cores) {
            c.hasClock = std::count(clocked.begin(), clocked.end(), c.folder) != 0;
            c.saysIdle = std::count(idle.begin(), idle.end(), c.folder) != 0;
            if (c.hasGate && !c.saysIdle)
                throw std::runtime_error(std::to_string(c.line) + ": error: gate=on: '" + c.folder +
                                         "' has no output idle_o (icesoc_core(... IDLE))");
            c.constraints = constraints[c.folder];
        }
        save(outputDir + "/map.regs.json", mapOf(chip, platform).dump(2) + "\n");
        save(outputDir + "/probes.json", probesOf(chip).dump() + "\n");
        save(outputDir + "/soc_pins.h", pinTableOf(chip));
        save(outputDir + "/core_pins.ucf", constraintsOf(chip));
        std::vector<Slot> slots;
        auto add = [&](const std::string& name, unsigned slot, const nlohmann::json& description) {
            slots.push_back({name, slot, chip.registers + slotBytes * slot, description});
        };
        for (const std::string& b : blocks) {
            size_t first = b.find('='), second = b.find('=', first + 1);
            if (second == std::string::npos)
                throw std::runtime_error("1: error: --block slot=name=file, not '" + b + "'");
            add(b.substr(first + 1, second - first - 1),
                static_cast<unsigned>(std::stoul(b.substr(0, first))),
                nlohmann::json::parse(read(b.substr(second + 1))));
        }
        for (const Core& c : chip.cores)
            add(c.name, c.slot, descriptions.at(c.folder));
        save(outputDir + "/soc_cores.vh", verilogOf(chip, slots));
        save(outputDir + "/soc_cores.c", instancesOf(chip, slots));
        save(outputDir + "/icesoc.svd", svdOf(slots));
        save(outputDir + "/icesoc.rdl", rdlOf(slots));
        save(outputDir + "/icesoc.ipxact.xml", ipxactOf(slots));
        save(outputDir + "/registers.html", htmlOf(slots));
    } catch (const std::exception& e) {
        std::cerr << list << ":" << e.what() << "\n";
        return 1;
    }
    return 0;
}
