// SPDX-License-Identifier: MIT
//
// wire_fault: parses the text of a fault.

#include "wire_fault.h"
#include <cstdlib>
#include <map>
#include <stdexcept>

namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& expected) {
    throw std::runtime_error("--wire " + text + ": expected " + expected);
}

} // namespace

WireFault WireFault::parse(const std::string& text) {
    static const std::map<std::string, Kind> kinds = {
        {"open", Open},       {"stuck0", Stuck0},   {"stuck1", Stuck1},
        {"short", Short},     {"swapped", Swapped}, {"inverted", Inverted},
        {"ringing", Ringing}, {"late", Late},       {"none", Missing},
        {"off", Off},         {"shifted", Shifted}, {"second-driver", SecondDriver}};
    WireFault fault;
    const size_t colon = text.find(':');
    if (colon == std::string::npos || colon == 0)
        refuse(text, "WIRE:FAULT, such as D3:open or D1-D2:short");
    fault.wire = text.substr(0, colon);
    const size_t hyphen = fault.wire.find('-');
    if (hyphen != std::string::npos) {
        fault.other = fault.wire.substr(hyphen + 1);
        fault.wire.resize(hyphen);
    }
    const std::string what = text.substr(colon + 1);
    const size_t equals = what.find('=');
    auto found = kinds.find(what.substr(0, equals));
    if (found == kinds.end())
        refuse(text, "a fault: open, stuck0, stuck1, short, swapped, inverted, ringing, late=12ns, "
                     "none, off=2%, shifted or second-driver");
    fault.kind = found->second;
    if ((fault.kind == Short || fault.kind == Swapped) == fault.other.empty())
        refuse(text, fault.other.empty() ? "two wires, such as D1-D2:" + what
                                         : "one wire, such as D1:" + what);
    const std::string unit = fault.kind == Late ? "ns" : fault.kind == Off ? "%" : "";
    if (unit.empty() != (equals == std::string::npos))
        refuse(text, unit.empty() ? "no value" : "a value, such as " + what + "=2" + unit);
    if (!unit.empty()) {
        char* end = nullptr;
        fault.value = std::strtod(what.c_str() + equals + 1, &end);
        if (end == what.c_str() + equals + 1 || end != unit)
            refuse(text, "a number of " + unit + ", such as 2" + unit);
    }
    return fault;
}
