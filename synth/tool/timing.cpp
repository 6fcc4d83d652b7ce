// SPDX-License-Identifier: MIT
//
// timing: estimates the longest paths of a Spartan-6 netlist, as XST does before placement.

#include "timing.h"

#include "nets.h"
#include "owners.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>

using std::string;

namespace {

// ns, grade -3
constexpr double clockToOut = 0.447, lut = 0.205, setup = 0.102, enableSetup = 0.322,
                 resetSetup = 0.430, carryIn = 0.172, carryBit = 0.019, carryOut = 0.180,
                 wideMux = 0.140, ramClock = 1.850, ramSetup = 0.400, lutRamClock = 0.900,
                 lutRamSetup = 0.300, multiplierClock = 4.700, multiplierSetup = 1.500;

bool startsWith(const string& s, const char* prefix) {
    return s.rfind(prefix, 0) == 0;
}

bool isBlockRam(const string& type) {
    return startsWith(type, "RAMB");
}
bool isMultiplier(const string& type) {
    return startsWith(type, "DSP48");
}
bool isCombinational(const string& type) {
    return lutInputs(type) != 0 || startsWith(type, "MUXF") || type == "CARRY4";
}
bool isAddress(const string& port) {
    return port[0] == 'A' || startsWith(port, "DPRA"); // ADDRA.., A0.., DPRA0..
}

// True if a memory's output follows this address port: DOA follows ADDRA, DPO DPRA0.., SPO A0..; no
// output follows the write port.
bool isRead(const string& address, const string& output) {
    if (startsWith(address, "ADDR"))
        return output.size() < 3 || address.back() == output[2];
    return startsWith(address, "DPRA") ? output == "DPO" : output != "DPO";
}

// True for an unused write address: no path ends there.
bool isReadOnly(const string& port) {
    return port == "ADDRA" || port == "ADDRB" || port == "ADDRC" || startsWith(port, "DPRA");
}

// The delay of a clocked cell's output, and of a pin that ends a path.
double startDelay(const string& type) {
    if (isBlockRam(type))
        return ramClock;
    if (isMultiplier(type))
        return multiplierClock;
    return isFlipFlop(type) || isLatch(type) ? clockToOut : lutRamClock;
}

double endDelay(const string& type, const string& port) {
    if (isBlockRam(type))
        return ramSetup;
    if (isMultiplier(type))
        return multiplierSetup;
    if (isFlipFlop(type) || isLatch(type))
        return port == "D" ? setup : port == "CE" ? enableSetup : resetSetup;
    return lutRamSetup;
}

// The delay of a combinational cell from a pin (bit i of it) to an output (bit o); negative: no
// such path.
double throughDelay(const Cell& cell, const Pin& from, size_t i, const Pin& to, size_t o) {
    if (cell.type != "CARRY4")
        return startsWith(cell.type, "MUXF") ? wideMux : lut;
    const bool single = from.port == "CI" || from.port == "CYINIT";
    if (!single && (i > o || (i == o && to.port == "CO" && from.port == "O")))
        return -1;
    const double entry = single ? 0 : carryIn;
    const double along = carryBit * static_cast<double>(o - (single ? 0 : i));
    return entry + along + (to.port == "O" ? carryOut : carryBit);
}

struct Arrival {
    double ns = -1;
    int levels = 0;
    int cell = -1;   // that drives the bit
    int before = -1; // bit of the path before, -1 where it starts
    bool clocked = false;
    double delay = 0;
};

class Analysis {
public:
    explicit Analysis(const Netlist& n) : n_(n) {
        for (const Port& port : n.ports)
            if (port.input)
                inputs_.insert(port.bits.begin(), port.bits.end());
    }

    // The latest arrival at a bit that starts at a clocked cell (or, if not `clocked`, at a port).
    const Arrival& at(int bit, bool clocked) {
        auto& known = known_[clocked ? 1 : 0];
        const auto it = known.find(bit);
        if (it != known.end())
            return it->second;
        known[bit] = {}; // a loop ends here
        return known[bit] = arrive(bit, clocked);
    }

    double net(int bit, int reader) const {
        // No wire is needed from a LUT into the flip-flop, wide multiplexer or carry beside it.
        const auto readers = n_.readers.find(bit);
        const int fanout =
            readers == n_.readers.end() ? 0 : static_cast<int>(readers->second.size());
        const auto driver = n_.driver.find(bit);
        if (driver != n_.driver.end() && reader >= 0) {
            const string& from = n_.cells[driver->second].type;
            const string& to = n_.cells[reader].type;
            const bool beside =
                fanout == 1 && (isFlipFlop(to) || startsWith(to, "MUXF") || to == "CARRY4");
            if (isCombinational(from) && beside)
                return 0;
            if (from == "CARRY4" && to == "CARRY4")
                return 0;
        }
        return netDelay(fanout);
    }

private:
    Arrival arrive(int bit, bool clocked) {
        Arrival best;
        const auto driver = n_.driver.find(bit);
        if (driver == n_.driver.end()) {
            if (!clocked && inputs_.count(bit))
                best.ns = 0;
            return best;
        }
        const int index = driver->second;
        const Cell& cell = n_.cells[index];
        const bool memory = memoryLuts(cell.type) != 0 || isShiftRegister(cell.type);
        if (!isCombinational(cell.type)) {
            if (clocked)
                best = {startDelay(cell.type), 0, index, -1, true, startDelay(cell.type)};
            if (!memory)
                return best;
        }
        const Pin* to = nullptr;
        size_t o = 0;
        for (const Pin& pin : cell.pins)
            for (size_t k = 0; k < pin.bits.size(); k++)
                if (pin.output && pin.bits[k] == bit) {
                    to = &pin;
                    o = k;
                }
        for (const Pin& pin : cell.pins)
            for (size_t i = 0; i < pin.bits.size(); i++) {
                if (pin.output || pin.bits[i] < 0 ||
                    (memory && !(isAddress(pin.port) && isRead(pin.port, to->port))))
                    continue;
                const double delay = memory ? lut : throughDelay(cell, pin, i, *to, o);
                const Arrival& before = at(pin.bits[i], clocked);
                if (delay < 0 || before.ns < 0)
                    continue;
                const double ns = before.ns + net(pin.bits[i], index) + delay;
                const bool chain =
                    cell.type == "CARRY4" && (pin.port == "CI" || pin.port == "CYINIT");
                if (ns > best.ns)
                    best = {ns,   before.levels + (chain ? 0 : 1), index, pin.bits[i], clocked,
                            delay};
            }
        return best;
    }

    const Netlist& n_;
    std::set<int> inputs_;
    std::array<std::unordered_map<int, Arrival>, 2> known_;
};

// The register or memory that drives a bit; without a name of its own, its purpose.
string startName(const Netlist& n, const std::vector<string>& owners, int bit) {
    const string name = n.nameOf(bit);
    const auto driver = n.driver.find(bit);
    return name.empty() && driver != n.driver.end() ? "(for) " + owners[driver->second] : name;
}

string endName(const Netlist& n, const std::vector<string>& owners, size_t index) {
    const Cell& cell = n.cells[index];
    if (cell.named && !isFlipFlop(cell.type))
        return cell.name;
    for (const Pin& pin : cell.pins)
        if (pin.output && !pin.bits.empty())
            return startName(n, owners, pin.bits[0]);
    return owners[index];
}

} // namespace

double netDelay(int fanout) {
    // Fan-out, ns: points between which it is interpolated.
    static const std::vector<std::pair<int, double>> points = {
        {0, 0.0}, {1, 0.580}, {2, 0.617}, {5, 0.715}, {16, 1.004}, {26, 1.207}, {88, 1.799}};
    for (size_t i = 1; i < points.size(); i++)
        if (fanout <= points[i].first || i + 1 == points.size()) {
            const auto [x0, y0] = points[i - 1];
            const auto [x1, y1] = points[i];
            return y0 + (y1 - y0) * (std::min(fanout, 200) - x0) / (x1 - x0);
        }
    return 0;
}

Timing timingOf(const Netlist& n, const std::vector<string>& owners, size_t count) {
    Timing t;
    Analysis analysis(n);
    std::map<string, Path> worst; // by end register
    for (size_t i = 0; i < n.cells.size(); i++) {
        const Cell& cell = n.cells[i];
        if (isCombinational(cell.type))
            continue;
        const bool memory = memoryLuts(cell.type) != 0 || isShiftRegister(cell.type);
        double longest = -1;
        for (const Pin& pin : cell.pins)
            for (const int bit : pin.bits) {
                if (pin.output || bit < 0 || pin.port == "C" || (memory && isReadOnly(pin.port)))
                    continue;
                const Arrival& fromPort = analysis.at(bit, false);
                if (fromPort.ns >= 0)
                    t.inputLevels = std::max(t.inputLevels, fromPort.levels);
                const Arrival& arrival = analysis.at(bit, true);
                if (arrival.ns < 0)
                    continue;
                const double ns = arrival.ns + analysis.net(bit, static_cast<int>(i)) +
                                  endDelay(cell.type, pin.port);
                longest = std::max(longest, ns);
                const string end = endName(n, owners, i);
                Path& path = worst[end.substr(0, end.find('['))];
                if (ns <= path.ns)
                    continue;
                path = {"", end, pin.port, arrival.levels, ns, {}};
                int reader = static_cast<int>(i);
                for (int at = bit; at >= 0;) {
                    const Arrival& a = analysis.at(at, true);
                    const auto readers = n.readers.find(at);
                    path.steps.insert(
                        path.steps.begin(),
                        {n.cells[a.cell].type, n.nameOf(at),
                         readers == n.readers.end() ? 0 : static_cast<int>(readers->second.size()),
                         a.delay, analysis.net(at, reader)});
                    path.from = startName(n, owners, at);
                    reader = a.cell;
                    at = a.before;
                }
            }
        if (longest < 0)
            continue;
        for (const Pin& pin : cell.pins)
            if (isClock(pin.port) && !pin.bits.empty())
                t.byClock[pin.bits[0]] = std::max(t.byClock[pin.bits[0]], longest);
        const auto bin = static_cast<size_t>(2 * longest * slowGrade);
        t.ends.resize(std::max(t.ends.size(), bin + 1));
        t.ends[bin]++;
    }
    for (const Port& port : n.ports)
        for (const int bit : port.bits)
            if (port.output && bit >= 0) {
                t.outputLevels = std::max(t.outputLevels, analysis.at(bit, true).levels);
                t.throughLevels = std::max(t.throughLevels, analysis.at(bit, false).levels);
            }
    for (auto& [end, path] : worst)
        t.paths.push_back(std::move(path));
    std::sort(t.paths.begin(), t.paths.end(), [](const Path& a, const Path& b) {
        return a.ns != b.ns ? a.ns > b.ns : a.to < b.to;
    });
    t.paths.resize(std::min(t.paths.size(), count));
    return t;
}
