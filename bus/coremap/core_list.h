// SPDX-License-Identifier: MIT
//
// core_list: the lines of ip/cores.list, and what the chip gives each of them (docs/hw-mapping.md).

#ifndef CORE_LIST_H
#define CORE_LIST_H

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

struct Pin {
    std::string name; // of the core's port; its end says the direction
    unsigned width = 1;
    unsigned lsb = 0;        // in the chip's core_pins_i or core_pins_o; bits
    std::string source;      // instead of a pin: another core's output
    bool isInternal = false; // for other cores only: never a pin; an input that is not wired is 0
    bool isOut() const { return name.back() == 'o'; }
};

struct Core {
    std::string name, folder, identity;
    unsigned line = 0, slot = 0;
    int port = -1;       // memory port; -1: none
    unsigned memory = 0; // DDR3 byte address of its buffers
    std::string servantType, servantHeader;
    std::vector<Pin> pins;
};

struct Chip {
    std::vector<Core> cores; // by slot
    unsigned slots = 0, ports = 0;
    unsigned pins[2] = {0, 0}; // bits used of core_pins_i, core_pins_o
};

// `list`: the file's text; `base`: the platform's map; `descriptions`: folder to its *.regs.json.
// What is wrong is thrown, with the line.
Chip readCores(const std::string& list, const nlohmann::json& base,
               const std::map<std::string, nlohmann::json>& descriptions);

nlohmann::ordered_json mapOf(const Chip& chip, const nlohmann::ordered_json& base);
std::string verilogOf(const Chip& chip);
std::string instancesOf(const Chip& chip);

// A populated slot, the platform's too, with its *.regs.json.
struct Slot {
    std::string name;
    unsigned number;
    nlohmann::json description;
};
std::string svdOf(const std::vector<Slot>& slots);
std::string htmlOf(const std::vector<Slot>& slots);

#endif
