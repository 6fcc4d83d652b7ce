// SPDX-License-Identifier: MIT
//
// netlist: a flat, mapped netlist as Yosys writes it (write_json), as a graph of cells and bits.

#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

// Bits are numbered by Yosys from 2; these stand for constants.
constexpr int bitZero = -1, bitOne = -2, bitUndefined = -3;

struct Pin {
    std::string port;
    bool output = false;
    std::vector<int> bits;
};

struct Cell {
    std::string name, type;
    bool named = false; // the name is the design's, not the tool's
    std::set<std::string>
        sources; // files (names only) of the block it comes from and its instances
    std::vector<Pin> pins;

    const Pin* pin(const std::string& port) const;
    int bit(const std::string& port) const; // the port's only bit, bitUndefined without one
};

struct Port {
    std::string name;
    bool input = false, output = false;
    std::vector<int> bits;
};

struct Netlist {
    std::string top;
    std::vector<Cell> cells;
    std::vector<Port> ports;
    // Names of a bit in the source, "u_modem.u_at.state" and its index in the vector (-1 without
    // one), first the most likely name of its driver.
    struct Name {
        std::string name;
        int index = -1;

        std::string text() const; // with the index
    };
    std::unordered_map<int, std::vector<Name>> names;
    std::unordered_map<std::string, std::string> sources; // name -> its Yosys attribute src

    std::unordered_map<int, int> driver;               // bit -> cell
    std::unordered_map<int, std::vector<int>> readers; // bit -> cells

    // Name with index, "" if the source has no name for it.
    std::string nameOf(int bit) const;
};

Netlist readNetlist(const std::filesystem::path& file); // throws for another kind of file

// Kinds of cells, by the names of Xilinx's and Lattice's libraries.
int lutInputs(const std::string& type);  // LUT1..LUT6 and INV: 1..6; else 0
int memoryLuts(const std::string& type); // LUTs of a LUT RAM; else 0
bool isShiftRegister(const std::string& type);
bool isFlipFlop(const std::string& type);
bool isLatch(const std::string& type);
