// SPDX-License-Identifier: MIT
//
// options: slice2c's command line.

#pragma once

#include "front/front.h"
#include "hw/generator.h"
#include <optional>
#include <string>
#include <vector>

// An option that names a folder for generated files, and the functions that make these files: one
// or two files for each [":hw"] interface.
struct HardwareOutput {
    const char *option, *help;
    GeneratedFile (*makes[2])(const hw::Block&);
};
const HardwareOutput hardwareOutputs[] = {
    {"hw-verilog",
     "folder for the wrappers of [\":hw\"] interfaces in Verilog (docs/hw-mapping.md)",
     {hw::verilogFile}},
    {"hw-vhdl", "folder for the wrappers of [\":hw\"] interfaces in VHDL", {hw::vhdlFile}},
    {"hw-regs",
     "folder for the register descriptions of [\":hw\"] interfaces, *.regs.json",
     {hw::registersFile}},
    {"hw-c",
     "folder for the servants of [\":hw\"] interfaces in C90",
     {hw::servantHeader, hw::servantSource}},
    {"hw-cpp",
     "folder for the C++ proxies of [\":hw\"] interfaces, for test benches",
     {hw::proxyFile}},
    {"hw-new-verilog",
     "folder for a first version of each core in Verilog, and its test",
     {hw::verilogSkeleton, hw::testSkeleton}},
    {"hw-new-vhdl",
     "folder for a first version of each core in VHDL, and its test",
     {hw::vhdlSkeleton, hw::testSkeleton}}};

struct Options {
    std::vector<std::string> files, includes, defines, undefines;
    std::string outputDir = ".", includeDir, headerExtension = "h", sourceExtension = "c",
                dependFile, hardware[std::size(hardwareOutputs)];
    bool oneProgram = false, preprocessOnly = false, depend = false, describe = false,
         validate = false, hwOwnClock = false;
    NameRules rules;
};

// Reads the command line. If slice2c has nothing more to do, returns its exit status: after --help,
// --version and --validate, or after the message about a wrong command line.
std::optional<int> readOptions(int argc, char** argv, Options& o);
