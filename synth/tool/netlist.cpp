// SPDX-License-Identifier: MIT
//
// netlist: a flat, mapped netlist as Yosys writes it (write_json), as a graph of cells and bits.

#include "netlist.h"

#include "files.h"
#include "sources.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tuple>

using nlohmann::json;

namespace {

std::vector<int> bitsOf(const json& j) {
    std::vector<int> bits;
    for (const json& b : j) {
        if (b.is_number())
            bits.push_back(b.get<int>());
        else
            bits.push_back(b == "0" ? bitZero : b == "1" ? bitOne : bitUndefined);
    }
    return bits;
}

bool generated(const std::string& last) { // names that GHDL makes up: n123_o, n45_q
    size_t i = 1;
    while (i < last.size() && std::isdigit(static_cast<unsigned char>(last[i])))
        i++;
    return last[0] == 'n' && i > 1 && (i == last.size() || last[i] == '_');
}

// Ranks the names of one bit; the lowest is its driver's. It is not an input of the block below,
// and is the deepest, since outputs are passed up.
std::tuple<bool, bool, long, size_t> rank(const std::string& name) {
    const std::string last = name.substr(name.rfind('.') + 1);
    const bool input = last.size() > 2 && last.compare(last.size() - 2, 2, "_i") == 0;
    return {generated(last), input, -std::count(name.begin(), name.end(), '.'), name.size()};
}

// "hdl/soc.v:1.2-3.4|/usr/share/yosys/xilinx/ff_map.v:5.6-7.8" -> {"soc.v"}
std::set<std::string> sourcesOf(const std::string& attribute) {
    std::set<std::string> files;
    for (size_t begin = 0; begin < attribute.size();) {
        const size_t end = std::min(attribute.find('|', begin), attribute.size());
        const std::string place = attribute.substr(begin, end - begin);
        if (place.find("/share/yosys/") == std::string::npos)
            files.insert(std::filesystem::path(place.substr(0, place.rfind(':'))).filename());
        begin = end + 1;
    }
    return files;
}

} // namespace

const Pin* Cell::pin(const std::string& port) const {
    for (const Pin& p : pins)
        if (p.port == port)
            return &p;
    return nullptr;
}

int Cell::bit(const std::string& port) const {
    const Pin* p = pin(port);
    return p && !p->bits.empty() ? p->bits[0] : bitUndefined;
}

std::string Netlist::Name::text() const {
    return index < 0 ? name : fmt::format("{}[{}]", name, index);
}

std::string Netlist::nameOf(int bit) const {
    const auto it = names.find(bit);
    return it == names.end() ? "" : it->second.front().text();
}

Netlist readNetlist(const std::filesystem::path& file) {
    const json j = json::parse(readFile(file));
    if (!j.contains("modules") || j["modules"].size() != 1)
        throw std::runtime_error(fmt::format("{} is not a netlist of one module", file.string()));
    Netlist n;
    n.top = j["modules"].begin().key();
    const json& module = j["modules"].begin().value();

    for (const auto& [name, port] : module["ports"].items()) {
        const std::string direction = port["direction"];
        n.ports.push_back(
            {name, direction != "output", direction != "input", bitsOf(port["bits"])});
    }
    for (const auto& [name, cell] : module["cells"].items()) {
        Cell c{name, cell["type"], cell["hide_name"] == 0, {}, {}};
        c.sources = sourcesOf(cell["attributes"].value("src", ""));
        if (c.type[0] == '$') // scopes and the like, no hardware
            continue;
        for (const auto& [port, bits] : cell["connections"].items())
            c.pins.push_back({port, cell["port_directions"][port] == "output", bitsOf(bits)});
        const int index = static_cast<int>(n.cells.size());
        for (const Pin& p : c.pins)
            for (const int bit : p.bits)
                if (bit >= 0) {
                    if (p.output)
                        n.driver[bit] = index;
                    else
                        n.readers[bit].push_back(index);
                }
        n.cells.push_back(std::move(c));
    }
    for (const auto& [name, net] : module["netnames"].items()) {
        if (net["hide_name"] != 0)
            continue;
        n.sources[name] = net["attributes"].value("src", "");
        const std::vector<int> bits = bitsOf(net["bits"]);
        for (size_t i = 0; i < bits.size(); i++)
            if (bits[i] >= 0)
                n.names[bits[i]].push_back(
                    {name, bits.size() > 1 ? static_cast<int>(i) + net.value("offset", 0) : -1});
    }
    for (auto& [bit, names] : n.names)
        std::sort(names.begin(), names.end(), [](const Netlist::Name& a, const Netlist::Name& b) {
            return std::pair(rank(a.name), a.name) < std::pair(rank(b.name), b.name);
        });
    return n;
}

int lutInputs(const std::string& type) {
    if (type == "INV")
        return 1;
    return type.size() == 4 && type.rfind("LUT", 0) == 0 ? type[3] - '0' : 0;
}

int memoryLuts(const std::string& type) {
    static const std::map<std::string, int> luts = {
        {"RAM32M", 4},          {"RAM64M", 4},    {"RAM32X1D", 2},  {"RAM64X1D", 2},
        {"RAM16X1D", 2},        {"RAM128X1D", 4}, {"RAM32X1S", 1},  {"RAM64X1S", 1},
        {"RAM16X1S", 1},        {"RAM128X1S", 2}, {"RAM256X1S", 4}, {"RAM32X2S", 2},
        {"RAM64X2S", 2},        {"RAM32X4S", 4},  {"RAM32X8S", 8},  {"RAM64X1S_1", 1},
        {"TRELLIS_DPR16X4", 6}, // four of data and two of the write port
    };
    const auto it = luts.find(type);
    return it == luts.end() ? 0 : it->second;
}

bool isShiftRegister(const std::string& type) {
    return type.rfind("SRL", 0) == 0;
}

bool isFlipFlop(const std::string& type) {
    return type == "TRELLIS_FF" || (type.rfind("FD", 0) == 0 && type.size() <= 6);
}

bool isLatch(const std::string& type) {
    return type == "LDCE" || type == "LDPE" || type == "LDCPE" || type == "LD";
}
