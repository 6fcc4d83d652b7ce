// SPDX-License-Identifier: MIT

#include "nets.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>

namespace fs = std::filesystem;
using std::string;

namespace {

const string forOwner = "(for) ";

using Lines = std::vector<string>;

const Lines& linesOf(const string& file) {
    thread_local std::map<string, Lines> files;
    const auto [at, isNew] = files.try_emplace(file);
    std::ifstream in(isNew ? file : "");
    for (string line; std::getline(in, line);)
        at->second.push_back(line);
    return at->second;
}

string relative(const fs::path& file) {
    return file.lexically_proximate(file.is_absolute() ? fs::current_path() : ".").string();
}

// The place in VHDL of a signal that GHDL declares at a line of its Verilog: the comment before the
// statement that assigns it. A port has none, but the signal assigned to it has.
string placeInVhdl(const Lines& lines, size_t declared, const string& name) {
    static const std::regex comment(R"(^ */\* (\S+\.vhdl?:\d+):\d+ +\*/$)");
    static const std::regex copied(R"(^ *assign \S+ = (\w+); // *\((module output|signal)\))");
    std::smatch found;
    string above;
    for (size_t i = declared; i < lines.size() && lines[i] != "endmodule"; i++) {
        if (std::regex_match(lines[i], found, comment)) {
            above = relative(found[1].str());
            continue;
        }
        const bool isAssigned = lines[i].find(" " + name + " = ") != string::npos ||
                                lines[i].find(" " + name + " <= ") != string::npos;
        if (!isAssigned) {
            if (lines[i].find(" always @") == string::npos &&
                lines[i].find(" case (") == string::npos)
                above.clear();
            continue;
        }
        const bool isCopy = std::regex_search(lines[i], found, copied) && found[1].str() != name;
        return above.empty() && isCopy ? placeInVhdl(lines, declared, found[1].str()) : above;
    }
    return "";
}

string nameOr(const Netlist& n, const std::vector<string>& owners, int bit) {
    const auto driver = n.driver.find(bit);
    if (const auto port = n.names.find(bit); driver == n.driver.end() && port != n.names.end())
        return port->second.back().text(); // the top's own, not an instance's input
    const string name = n.nameOf(bit);
    return !name.empty() || driver == n.driver.end() ? name : forOwner + owners[driver->second];
}

} // namespace

string withoutIndex(const string& signal) {
    return signal.empty()
               ? ""
               : signal.substr(0, signal.back() == ']' ? signal.rfind('[') : signal.size());
}

bool isClock(const string& port) {
    return port == "C" || port.rfind("CLK", 0) == 0 || port == "WCLK";
}

Nets netsOf(const Netlist& n, const std::vector<string>& owners, const Timing& timing,
            size_t count) {
    struct Ends {
        int pins = 0, clocked = 0, synchronous = 0, asynchronous = 0;
    };
    std::map<int, Ends> all;
    std::map<int, int> clocks; // flip-flops by clock
    for (const Cell& cell : n.cells)
        for (const Pin& pin : cell.pins)
            for (const int bit : pin.bits) {
                if (pin.output || bit < 0)
                    continue;
                Ends& ends = all[bit];
                ends.pins++;
                ends.clocked += isClock(pin.port);
                if (!isFlipFlop(cell.type) && !isLatch(cell.type))
                    continue;
                if (isClock(pin.port))
                    clocks[bit]++;
                ends.synchronous += pin.port == "R" || pin.port == "S";
                ends.asynchronous += pin.port == "CLR" || pin.port == "PRE";
            }
    Nets nets;
    for (const auto& [bit, ends] : all) {
        const string name = nameOr(n, owners, bit);
        const auto driver = n.driver.find(bit);
        const string from = driver == n.driver.end() ? "port" : n.cells[driver->second].type;
        if (ends.clocked != 0) {
            const auto longest = timing.byClock.find(bit);
            nets.clocks.push_back({name, from, ends.pins, clocks[bit],
                                   longest == timing.byClock.end() ? 0 : longest->second});
            continue;
        }
        nets.fanouts.push_back({name, from, ends.pins, 0, 0});
        if (ends.synchronous != 0)
            nets.resets.push_back({name, "synchronous", ends.pins, ends.synchronous, 0});
        if (ends.asynchronous != 0)
            nets.resets.push_back({name, "asynchronous", ends.pins, ends.asynchronous, 0});
    }
    for (auto* list : {&nets.fanouts, &nets.clocks, &nets.resets}) {
        std::sort(list->begin(), list->end(), [](const Net& a, const Net& b) {
            return std::pair(-a.ends, a.name) < std::pair(-b.ends, b.name);
        });
        list->resize(std::min(list->size(), count));
    }
    return nets;
}

string placeOf(const Netlist& netlist, const string& signal) {
    const bool isOwner = signal.rfind(forOwner, 0) == 0;
    const auto source =
        netlist.sources.find(withoutIndex(isOwner ? signal.substr(forOwner.size()) : signal));
    if (source == netlist.sources.end())
        return "";
    // "platform.vh:62.26-69.2|./hdl/modem/modem.v:97.88-97.94": instances' places, and the
    // declaration's, which is as wide as the name.
    static const std::regex place(R"(([^|:]+):(\d+)\.(\d+)-(\d+)\.(\d+))");
    const string name = source->first.substr(source->first.rfind('.') + 1);
    const string& text = source->second;
    for (std::sregex_iterator at(text.begin(), text.end(), place), end; at != end; ++at) {
        const std::smatch& m = *at;
        if (m[2] != m[4] || std::stoul(m[5]) - std::stoul(m[3]) != name.size())
            continue;
        const Lines& lines = linesOf(m[1]);
        const bool isGenerated = !lines.empty() && lines[0].find("by GHDL") != string::npos;
        const string inVhdl = isGenerated ? placeInVhdl(lines, std::stoul(m[2]), name) : "";
        return inVhdl.empty() ? relative(m[1].str()) + ":" + m[2].str() : inVhdl;
    }
    return "";
}
