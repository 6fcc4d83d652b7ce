// SPDX-License-Identifier: MIT
//
// wire_fault: parses the text of a fault, and checks its names.

#include "wire_fault.h"
#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace {

using Names = std::vector<std::string>;

struct KindName {
    const char* name;
    WireFault::Kind kind;
    const char* unit; // unit of the fault's value; empty if it has none
};
constexpr KindName kinds[] = {{"open", WireFault::Open, ""},
                              {"stuck0", WireFault::Stuck0, ""},
                              {"stuck1", WireFault::Stuck1, ""},
                              {"pull0", WireFault::Pull0, ""},
                              {"pull1", WireFault::Pull1, ""},
                              {"short", WireFault::Short, ""},
                              {"swapped", WireFault::Swapped, ""},
                              {"inverted", WireFault::Inverted, ""},
                              {"ringing", WireFault::Ringing, ""},
                              {"late", WireFault::Late, "ns"},
                              {"none", WireFault::Missing, ""},
                              {"off", WireFault::Off, "%"},
                              {"second-driver", WireFault::SecondDriver, ""},
                              {"shifted", WireFault::Shifted, ""},
                              {"unpowered", WireFault::Unpowered, ""}};

// Wires with the same possible faults. The number of a wire follows the name; there are `count`
// numbers, starting with `first`. A count of 0 means one wire without a number.
struct Group {
    const char* name;
    unsigned first, count;
    const char* faults; // names of the faults, each between spaces
};
constexpr char fsmc[] = " open stuck0 stuck1 pull0 pull1 short swapped inverted late ";
constexpr char line[] = " open stuck0 stuck1 pull0 pull1 short swapped inverted ";
constexpr char modem[] = " open stuck0 stuck1 short swapped ";
constexpr char memory[] = " open stuck0 short ";
constexpr char command[] = " open ";
constexpr Group groups[] = {
    {"D", 0, 16, fsmc},
    {"A", 0, 25, fsmc},
    {"NE", 1, 2, fsmc},
    {"NBL", 0, 2, fsmc},
    {"NOE", 0, 0, fsmc},
    {"NWE", 0, 0, " open stuck0 stuck1 pull0 pull1 short swapped inverted late ringing "},
    {"NADV", 0, 0, fsmc},
    {"NWAIT", 0, 0, fsmc},
    {"IRQ", 0, 0, line},
    {"D", 0, 0, " second-driver shifted "},
    {"A", 0, 0, " shifted "},
    {"BANK", 0, 4, " unpowered "},
    {"CLK", 0, 0, " none off "},
    {"MODEM", 0, 0, " none "},
    {"MODEM_RXD", 0, 0, modem},
    {"MODEM_TXD", 0, 0, modem},
    {"MODEM_CTS", 0, 0, modem},
    {"MODEM_RTS", 0, 0, modem},
    {"MODEM_RESET", 0, 0, modem},
    {"DDR_DQ", 0, 16, " open stuck0 stuck1 short "},
    {"DDR_A", 0, 13, memory},
    {"DDR_BA", 0, 3, memory},
    {"DDR_LDM", 0, 0, " stuck0 stuck1 "},
    {"DDR_UDM", 0, 0, " stuck0 stuck1 "},
    {"DDR_LDQS", 0, 0, command},
    {"DDR_UDQS", 0, 0, command},
    {"DDR_CK", 0, 0, command},
    {"DDR_CKE", 0, 0, command},
    {"DDR_RAS", 0, 0, command},
    {"DDR_CAS", 0, 0, command},
    {"DDR_WE", 0, 0, command}};

Names namesOf(const Group& group) {
    Names names;
    for (unsigned i = 0; i < group.count; ++i)
        names.push_back(group.name + std::to_string(group.first + i));
    return group.count ? names : Names{group.name};
}

// Returns the edit distance of two words: the number of letters to change, insert or remove.
size_t distance(const std::string& a, const std::string& b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t above = row[j];
            row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
            diagonal = above;
        }
    }
    return row[b.size()];
}

// Returns the hint at the end of a message about an unknown word: the most similar known word.
std::string nearest(const std::string& word, const Names& known) {
    const auto best =
        std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
            return distance(word, a) < distance(word, b);
        });
    return best == known.end() || distance(word, *best) > std::max<size_t>(word.size() / 2, 1)
               ? ""
               : "; did you mean " + *best + "?";
}

[[noreturn]] void refuse(const std::string& text, const std::string& expected,
                         const std::string& got, const Names& known = {}) {
    throw std::runtime_error("fault " + text + ": expected " + expected + ", got '" + got + "'" +
                             nearest(got, known));
}

// Returns the possible faults of a wire, such as open. Throws if the board has no such wire.
Names faultsOf(const std::string& wire, const std::string& text) {
    Names all;
    for (const Group& group : groups)
        for (const std::string& name : namesOf(group)) {
            if (name == wire) {
                std::istringstream words(group.faults);
                return {std::istream_iterator<std::string>(words), {}};
            }
            all.push_back(name);
        }
    refuse(text, "a wire such as D3, A24, NWE, MODEM_CTS or DDR_A5", wire, all);
}

std::string listOf(const Names& names) {
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : name == names.back() ? " or " : ", ") + name;
    return text;
}

} // namespace

std::vector<WireFault> WireFault::parseAll(const std::string& texts) {
    std::vector<WireFault> faults;
    std::istringstream words(texts);
    for (std::string word; words >> word;)
        faults.push_back(parse(word));
    return faults;
}

WireFault WireFault::parse(const std::string& text) {
    WireFault fault;
    const size_t colon = text.find(':');
    if (colon == std::string::npos || colon == 0)
        throw std::runtime_error("fault " + text +
                                 ": expected WIRE:FAULT, such as D3:open or D1-D2:short");
    fault.wire = text.substr(0, colon);
    const size_t hyphen = fault.wire.find('-');
    if (hyphen != std::string::npos) {
        fault.other = fault.wire.substr(hyphen + 1);
        fault.wire.resize(hyphen);
    }
    Names possible = faultsOf(fault.wire, text);
    if (!fault.other.empty()) { // a pair has the faults that both wires can have
        const Names others = faultsOf(fault.other, text);
        auto lacks = [&others](const std::string& name) {
            return std::find(others.begin(), others.end(), name) == others.end();
        };
        possible.erase(std::remove_if(possible.begin(), possible.end(), lacks), possible.end());
    }
    const std::string what = text.substr(colon + 1);
    const size_t equals = what.find('=');
    const std::string name = what.substr(0, equals);
    if (std::find(possible.begin(), possible.end(), name) == possible.end())
        refuse(text, listOf(possible), name, possible);
    const KindName& kind = *std::find_if(std::begin(kinds), std::end(kinds),
                                         [&](const KindName& k) { return name == k.name; });
    fault.kind = kind.kind;
    const std::string unit = kind.unit;
    if ((fault.kind == Short || fault.kind == Swapped) == fault.other.empty())
        refuse(text, fault.other.empty() ? "two wires, such as D1-D2" : "one wire", fault.name());
    if (fault.wire == fault.other)
        refuse(text, "two different wires", fault.name());
    if (unit.empty() != (equals == std::string::npos))
        refuse(text, unit.empty() ? "no value" : "a value, such as " + name + "=2" + unit, what);
    if (!unit.empty()) {
        char* end = nullptr;
        fault.value = std::strtod(what.c_str() + equals + 1, &end);
        const bool isNumber = end != what.c_str() + equals + 1 && end == unit;
        if (!isNumber || fault.value > 50 || fault.value < (fault.kind == Off ? -50 : 0))
            refuse(text, "at most 50 " + unit + ", such as 2" + unit, what.substr(equals + 1));
    }
    return fault;
}

std::string WireFault::text() const {
    const KindName& name = *std::find_if(std::begin(kinds), std::end(kinds),
                                         [&](const KindName& k) { return k.kind == kind; });
    std::ostringstream text;
    text << this->name() << ":" << name.name;
    if (*name.unit)
        text << "=" << value << name.unit;
    return text.str();
}
