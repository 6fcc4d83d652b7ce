// SPDX-License-Identifier: MIT
//
// map: maps interfaces to slots: checks that the types are allowed in hardware, and assigns words.

#include "hw/generator.h"
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace hw {
namespace {

bool isReserved(const std::string& name) {
    static const std::string words = " "
#include "hw/keywords.inc"
        ;
    return words.find(" " + name + " ") != std::string::npos;
}

class Mapper {
public:
    Mapper(const Declaration& d, const Unit& unit, Diagnostics& diagnostics)
        : d_(d), unit_(unit), diagnostics_(diagnostics) {
        block_.interface = &d;
        block_.name = snakeCase(d.name);
    }

    Block run() {
        if (isReserved(block_.name))
            error(d_.at, "its module would have the name '" + block_.name +
                             "', a reserved word of Verilog, SystemVerilog or VHDL");
        identity();
        pins();
        if (!d_.bases.empty())
            error(d_.at, "has a base, but a slot implements one interface without bases");
        mapCalls(d_, unit_, block_, diagnostics_);
        if (block_.calls.size() > mostOperations)
            error(d_.at, "has " + std::to_string(block_.calls.size()) +
                             " operations and events; CONTROL has bits for " +
                             std::to_string(mostOperations));
        if (!hasErrors())
            place();
        if (!hasErrors())
            checkPorts();
        return block_;
    }

private:
    bool hasErrors() const { return diagnostics_.errors() > before_; }
    void error(const Location& at, const std::string& text) {
        diagnostics_.error(at, "interface '" + d_.name + "' in hardware: " + text);
    }

    // Reads the identity from [":hw", "hw:type:0x4144", "hw:version:0x0100"]. The default is the
    // first letters of the name, and version 1.0.
    void identity() {
        std::string letters = upperCase(d_.name + "_");
        block_.type = static_cast<unsigned>(letters[0]) << 8 | static_cast<unsigned>(letters[1]);
        block_.version = 0x0100;
        checkKeys(d_.metadata, {"hw:type", "hw:version", "hw:pin"}, "interface '" + d_.name + "'",
                  d_.at, diagnostics_);
        for (auto [key, value] :
             {std::pair{"hw:type", &block_.type}, std::pair{"hw:version", &block_.version}}) {
            std::string text = metadataValue(d_.metadata, key);
            if (!text.empty() && !number(text, 0, 0xFFFF, *value))
                error(d_.at, "[\"" + std::string(key) + ":" + text + "\"]: expected 0 to 0xFFFF");
        }
    }

    // Reads the pins from [":hw", "hw:pin:pwm_o:4", "hw:pin:fault_i"]: name and width of each port.
    void pins() {
        for (const std::string& m : d_.metadata) {
            if (m.compare(0, 6, "hw:pin") != 0)
                continue;
            Pin pin;
            std::string rest = m.substr(std::min<size_t>(m.size(), 7));
            size_t colon = rest.find(':');
            pin.name = rest.substr(0, colon);
            bool isGood = pin.name.size() > 2 && std::islower(pin.name[0]) &&
                          pin.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") ==
                              std::string::npos &&
                          pin.name[pin.name.size() - 2] == '_' &&
                          (pin.name.back() == 'i' || pin.name.back() == 'o') &&
                          (colon == std::string::npos ||
                           number(rest.substr(colon + 1), 1, mostPins, pin.width));
            if (!isGood)
                error(d_.at, "[\"" + m +
                                 "\"]: expected the name of the port in lower case, with _i or _o "
                                 "at the end, and its width, 1.." +
                                 std::to_string(mostPins) + ": [\"hw:pin:pwm_o:4\"]");
            else if (isSlotPort(pin.name))
                error(d_.at, "[\"" + m + "\"]: '" + pin.name + "' is a port of every core");
            else if (std::any_of(block_.pins.begin(), block_.pins.end(),
                                 [&](const Pin& p) { return p.name == pin.name; }))
                error(d_.at, "[\"" + m + "\"]: duplicate pin '" + pin.name + "'");
            block_.pins.push_back(pin);
        }
    }

    static bool isSlotPort(const std::string& name) {
        return name.compare(0, 4, "bus_") == 0 || name.compare(0, 4, "npi_") == 0 ||
               name == "clk_i" || name == "rst_i" || name == "irq_o";
    }

    // Assigns the word numbers that the source requests, then gives the free numbers to the other
    // words in order.
    void place() {
        std::map<unsigned, std::string> taken = {{control, "CONTROL"}};
        if (block_.hasLong())
            taken[status] = "STATUS";
        constexpr unsigned room = slotWords - firstWord;
        unsigned needed = static_cast<unsigned>(taken.size()) + (block_.memoryBytes ? 1 : 0);
        for (const Call& call : block_.calls)
            needed += static_cast<unsigned>(call.words.size());
        if (needed > room) {
            taken[page] = "PAGE";
            ++needed;
        }
        while (needed > room + pageWords * ((1u << block_.pageBits) - 1))
            ++block_.pageBits;
        std::string list = block_.hasLong() ? "CONTROL 1, STATUS 1" : "CONTROL 1";
        if (taken.count(page))
            list += ", PAGE 1";
        if (block_.memoryBytes)
            list += ", MEMORY 1";
        for (Call& call : block_.calls) {
            unsigned counts[2] = {0, 0};
            for (Word& w : call.words) {
                w.call = call.name;
                w.name = upperCase(call.name) + (w.isOut ? "_OUT" : "_IN") +
                         std::to_string(counts[w.isOut]++);
                if (w.number >= slotWords)
                    error(call.operation->at, w.name + " would be word " +
                                                  std::to_string(w.number) +
                                                  "; the last word of the slot is 15");
                else if (w.number && !taken.emplace(w.number, w.name).second)
                    error(call.operation->at, w.name + " needs word " + std::to_string(w.number) +
                                                  ", which " + taken[w.number] + " already uses");
            }
            if (counts[0] + counts[1])
                list += ", '" + call.operation->name + "' " + std::to_string(counts[0]) + " in " +
                        std::to_string(counts[1]) + " out";
        }
        constexpr unsigned most = room + pageWords * ((1u << mostPageBits) - 1);
        if (needed > most)
            error(d_.at, "needs " + std::to_string(needed) + " words, but a slot has " +
                             std::to_string(most) + "; words used: " + list);
        if (hasErrors())
            return;
        unsigned next = firstWord;
        auto take = [&](const std::string& name) {
            while (taken.count(next) || (next >= slotWords && next % slotWords < pageWords))
                ++next;
            taken[next] = name;
            return next;
        };
        if (block_.memoryBytes)
            block_.memoryWord = take("MEMORY");
        for (Call& call : block_.calls)
            for (Word& w : call.words)
                if (w.number == 0)
                    w.number = take(w.name);
    }

    // Reports an error if two Slice names lead to the same port name. Examples: aB and a_b; the
    // member x of p, and a parameter p_x.
    void checkPorts() {
        std::map<std::string, std::string> owners; // Slice names by port name
        for (const Port& p : wrapperPorts(block_)) {
            std::string owner = p.call ? p.call->operation->name : "the wrapper";
            auto [it, isNew] = owners.emplace(p.name.substr(0, p.name.size() - 2), owner);
            if (!isNew)
                error(p.call->operation->at, "two ports would be named '" + it->first +
                                                 "': one for '" + owner + "', one for '" +
                                                 it->second + "'");
        }
    }

    const Declaration& d_;
    const Unit& unit_;
    Diagnostics& diagnostics_;
    Block block_;
    int before_ = diagnostics_.errors();
};

} // namespace

bool Block::hasLong() const {
    return std::any_of(calls.begin(), calls.end(), [](const Call& c) { return c.isLong; });
}

unsigned Block::memoryLsb() const {
    unsigned lsb = 0;
    while (1u << lsb < memoryBytes)
        ++lsb;
    return lsb;
}

unsigned Block::events() const {
    unsigned count = 0;
    for (const Call& c : calls)
        if (c.isLong || c.isEvent)
            count = c.bit + 1;
    return count;
}

unsigned Block::raised() const {
    unsigned mask = 0;
    for (const Call& c : calls)
        if (c.isLong || c.isEvent)
            mask |= 1u << c.bit;
    return mask;
}

unsigned Block::numbers() const {
    auto list = words();
    return list.empty() ? slotWords : (list.back()->number / slotWords + 1) * slotWords;
}

std::vector<const Word*> Block::words() const {
    std::vector<const Word*> list;
    for (const Call& c : calls)
        for (const Word& w : c.words)
            list.push_back(&w);
    std::sort(list.begin(), list.end(),
              [](const Word* a, const Word* b) { return a->number < b->number; });
    return list;
}

std::vector<Port> wrapperPorts(const Block& b) {
    std::vector<Port> list = {{"clk_i", false, 1, "clock, reset"},
                              {"rst_i", false, 1, ""},
                              {"bus_valid_i", false, 1, "register bus"},
                              {"bus_write_i", false, 1, ""},
                              {"bus_addr_i", false, 4, ""},
                              {"bus_wdata_i", false, 32, ""},
                              {"bus_ready_o", true, 1, ""},
                              {"bus_rdata_o", true, 32, ""},
                              {"bus_error_o", true, 1, ""},
                              {"irq_o", true, 1, "interrupt"},
                              {"core_rst_o", true, 1, "the core's reset"}};
    for (const Call& c : b.calls) {
        auto add = [&](const std::string& name, bool isOut, unsigned width,
                       const std::string& group) {
            list.push_back({c.name + "_" + name + (isOut ? "_o" : "_i"), isOut, width, group, &c});
        };
        if (c.isEvent)
            add("event", false, 1, "event " + c.operation->name);
        else
            add("start", true, 1, c.operation->name);
        for (const Word& w : c.words)
            for (const Piece& p : w.pieces)
                if (p.portLsb == 0) {
                    if (p.isCount)
                        add(baseName(p), true, 32, "");
                    add(p.name, !w.isOut, p.portWidth, "");
                }
        if (c.isEvent)
            add("taken", true, 1, "");
        if (c.isLong) {
            add("done", false, 1, "");
            add("refused", false, 1, "");
        }
    }
    return list;
}

// Warns about each exception of the file that no operation throws. Such an exception gets no
// register.
void warnOfUnthrown(const Unit& unit, Diagnostics& diagnostics) {
    std::set<const Declaration*> thrown;
    for (const auto& d : unit.declarations)
        for (const Operation& o : d->operations)
            for (const Declaration* e : o.throws)
                for (; e; e = e->base())
                    thrown.insert(e);
    for (const auto& d : unit.declarations)
        if (d->kind == Declaration::Kind::Exception && !d->fromInclude && !thrown.count(d.get()))
            diagnostics.warning(d->at, "no operation throws exception '" + d->name + "'");
}

std::vector<Block> mapHardware(const Unit& unit, Diagnostics& diagnostics) {
    std::vector<Block> blocks;
    std::map<std::string, const Declaration*> names;
    for (const auto& d : unit.declarations) {
        if (d->kind != Declaration::Kind::Interface || !hasMetadata(d->metadata, ":hw") ||
            d->fromInclude || d->isForward)
            continue;
        if (d->isLocal) {
            diagnostics.error(
                d->at, "interface '" + d->name +
                           "' is local; a core needs an interface that can be called remotely");
            continue;
        }
        blocks.push_back(Mapper(*d, unit, diagnostics).run());
        blocks.back().source = std::filesystem::path(unit.file).stem().string();
        auto [it, isNew] = names.emplace(blocks.back().name, d.get());
        if (!isNew)
            diagnostics.error(d->at, "'" + d->id() + "' and '" + it->second->id() +
                                         "' would both be named '" + it->first + "' in hardware");
    }
    if (blocks.empty() && diagnostics.errors() == 0)
        diagnostics.error({diagnostics.intern(unit.file), 1, 1},
                          "expected an interface with [\":hw\"], found none in this file");
    if (!blocks.empty())
        warnOfUnthrown(unit, diagnostics);
    return blocks;
}

} // namespace hw
