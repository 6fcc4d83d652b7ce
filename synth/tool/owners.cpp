// SPDX-License-Identifier: MIT
//
// owners: the owner of each cell in a flat netlist: an instance path and a signal of the source.

#include "owners.h"

#include <cctype>
#include <vector>

using std::string;

namespace {

bool isNumber(const string& s) {
    for (const char c : s)
        if (!std::isdigit(static_cast<unsigned char>(c)))
            return false;
    return !s.empty();
}

// "u_fifo.words.0.1" -> "u_fifo.words"
string withoutNumbers(string name) {
    for (size_t dot; (dot = name.rfind('.')) != string::npos && isNumber(name.substr(dot + 1));)
        name.resize(dot);
    return name;
}

bool isCombinational(const string& type) {
    return lutInputs(type) != 0 || type == "CARRY4" || type == "MUXF7" || type == "MUXF8" ||
           type == "CCU2C" || type == "PFUMX" || type == "L6MUX21";
}

double blockRams(const string& type) {
    if (type == "RAMB8BWER")
        return 0.5;
    if (type == "RAMB16BWER" || type == "RAMB18E1" || type == "DP16KD" || type == "PDPW16KD")
        return 1;
    return type == "RAMB36E1" ? 2 : 0;
}

bool isMultiplier(const string& type) {
    return type.rfind("DSP48", 0) == 0 || type == "MULT18X18D" || type == "ALU54B";
}

string blockOf(const string& owner) { // of the top: "u_fir.u_filter.sum" -> "u_fir"
    return owner.substr(0, owner.find('.'));
}

// Gives the logic that reads a slot's registers to the block in the slot. It is one cone with the
// bus decoder's multiplexer, without names of its own, and so the decoder's by now. Logic with only
// one block's signals at its inputs, besides the decoder's own, belongs to that block.
class SlotReads {
public:
    SlotReads(const Netlist& n, std::vector<string>& owners) : n_(n), owners_(owners) {
        for (size_t i = 0; i < owners.size(); i++)
            if (isInside(i))
                blocksBehind(i);
        for (const auto& [cell, blocks] : behind_)
            if (blocks.size() == 1)
                owners[cell] = *blocks.begin() + ".bus_rdata_o";
    }

private:
    bool isInside(size_t cell) const {
        return isCombinational(n_.cells[cell].type) && blockOf(owners_[cell]) == decoder;
    }

    const std::set<string>& blocksBehind(size_t cell) {
        const auto [at, isNew] = behind_.emplace(cell, std::set<string>());
        std::set<string>& blocks = at->second; // valid while others are inserted
        if (isNew)
            for (const Pin& pin : n_.cells[cell].pins)
                for (const int bit : pin.bits)
                    if (!pin.output && n_.driver.count(bit))
                        add(blocks, n_.driver.at(bit));
        return blocks;
    }

    void add(std::set<string>& blocks, size_t driver) {
        if (isInside(driver)) {
            const std::set<string> more = blocksBehind(driver);
            blocks.insert(more.begin(), more.end());
        } else if (!owners_[driver].empty() && blockOf(owners_[driver]) != decoder) {
            blocks.insert(blockOf(owners_[driver]));
        }
    }

    static constexpr const char* decoder = "u_bus_decoder";
    const Netlist& n_;
    const std::vector<string>& owners_;
    std::map<size_t, std::set<string>> behind_;
};

class Finder {
public:
    Finder(const Netlist& n, const FilesAlong& filesAlong)
        : n_(n), filesAlong_(filesAlong), owner_(n.cells.size()), state_(n.cells.size()) {}

    const string& ownerOf(int index) {
        if (state_[index] == 0) {
            state_[index] = 1; // a loop through this cell finds no owner here
            owner_[index] = find(index);
            state_[index] = 2;
        }
        return owner_[index];
    }

private:
    string find(int index) {
        const Cell& cell = n_.cells[index];
        if (cell.named && !isCombinational(cell.type))
            return withoutNumbers(cell.name);
        for (const Pin& pin : cell.pins)
            for (const int bit : pin.bits)
                if (pin.output && n_.names.count(bit))
                    return nameFor(cell, n_.names.at(bit));
        std::map<string, int> votes;
        for (const Pin& pin : cell.pins)
            for (const int bit : pin.bits)
                if (pin.output && n_.readers.count(bit))
                    for (const int reader : n_.readers.at(bit))
                        if (state_[reader] != 1 && !ownerOf(reader).empty())
                            votes[ownerOf(reader)]++;
        string best;
        for (const auto& [name, count] : votes)
            if (best.empty() || count > votes[best])
                best = name;
        return best;
    }

    // The best of several names of one net is in the module that the cell comes from.
    string nameFor(const Cell& cell, const std::vector<Netlist::Name>& names) {
        for (const Netlist::Name& name : names) {
            const string path = splitName(name.name).first;
            auto it = files_.find(path);
            if (it == files_.end())
                it = files_.emplace(path, filesAlong_(path)).first;
            if (it->second == cell.sources)
                return name.name;
        }
        return names.front().name;
    }

    const Netlist& n_;
    const FilesAlong& filesAlong_;
    std::map<string, std::set<string>> files_;
    std::vector<string> owner_;
    std::vector<char> state_;
};

} // namespace

Cost& Cost::operator+=(const Cost& o) {
    lut += o.lut;
    memory += o.memory;
    ff += o.ff;
    carry += o.carry;
    ram += o.ram;
    dsp += o.dsp;
    return *this;
}

Cost costOf(const Cell& cell) {
    Cost c;
    c.memory = memoryLuts(cell.type) + (isShiftRegister(cell.type) ? 1 : 0);
    c.lut = c.memory + (lutInputs(cell.type) != 0 ? 1 : 0) + (cell.type == "CCU2C" ? 2 : 0);
    c.ff = isFlipFlop(cell.type) || isLatch(cell.type) ? 1 : 0;
    c.carry = cell.type == "CARRY4" || cell.type == "CCU2C" ? 1 : 0;
    c.ram = blockRams(cell.type);
    c.dsp = isMultiplier(cell.type) ? 1 : 0;
    return c;
}

std::pair<string, string> splitName(const string& name) {
    const size_t dot = name.rfind('.');
    if (dot == string::npos)
        return {"", name};
    return {name.substr(0, dot), name.substr(dot + 1)};
}

std::vector<string> ownersOf(const Netlist& netlist, const FilesAlong& filesAlong) {
    Finder finder(netlist, filesAlong);
    std::vector<string> owners;
    for (size_t i = 0; i < netlist.cells.size(); i++)
        owners.push_back(finder.ownerOf(static_cast<int>(i)));
    SlotReads(netlist, owners);
    return owners;
}

Costs costsOf(const Netlist& netlist, const std::vector<string>& owners) {
    Costs costs;
    for (size_t i = 0; i < netlist.cells.size(); i++) {
        const Cost cost = costOf(netlist.cells[i]);
        if (!cost.empty())
            costs[splitName(owners[i])] += cost;
    }
    return costs;
}
