// SPDX-License-Identifier: MIT
//
// designs: the designs to synthesise, and their limits (synth/designs.json and the modules found).

#pragma once

#include "sources.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

struct Chip {
    std::string name;
    int lut = 0, ff = 0, slices = 0, slicem = 0, ramb16 = 0, dsp = 0;
    double mhz = 0;
};

struct Design {
    std::string name, top, title, file; // file: where the module is, relative to the project
    std::map<std::string, std::string> parameters;
    std::map<std::string, int> limits; // "lut", "ff", "slices": not to be exceeded
    bool beside = false;               // the paper has figures for it
    int orders = 0; // further orders of inputs and outputs for mapping: one clock is luck
};

struct Plan {
    Chip chip;
    std::map<std::string, int> paper; // Table I: "lut", "ff", "slices"
    std::vector<Design> designs;
};

// The designs of the file, then every other module that has a file of its own; `*_rules` and
// `*_proof` are properties, not hardware.
Plan readPlan(const std::filesystem::path& file, const Library& library,
              const std::filesystem::path& root);
