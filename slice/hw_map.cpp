// SPDX-License-Identifier: MIT
//
// hw_map: interfaces into slots: what is allowed, who gets which word.

#include "hw_map.h"
#include "c_names.h"
#include "c_operations.h"
#include "hw_words.h"
#include <algorithm>
#include <map>
#include <set>

namespace hw {
namespace {

constexpr unsigned defaultTimeout = 1000, longestTimeout = 60000;

// A whole number, decimal or 0x..., within [low, high].
bool number(const std::string& text, unsigned low, unsigned high, unsigned& value) {
    bool hex = text.compare(0, 2, "0x") == 0;
    std::string digits = hex ? text.substr(2) : text;
    if (digits.empty() || digits.size() > 8 ||
        digits.find_first_not_of(hex ? "0123456789abcdefABCDEF" : "0123456789") !=
            std::string::npos)
        return false;
    unsigned long n = std::stoul(digits, nullptr, hex ? 16 : 10);
    value = static_cast<unsigned>(n);
    return n >= low && n <= high;
}

class Mapper {
public:
    Mapper(const Declaration& d, Diagnostics& diagnostics) : d_(d), diagnostics_(diagnostics) {
        block_.interface = &d;
        block_.name = snakeCase(d.name);
    }

    Block run() {
        identity();
        if (!d_.bases.empty())
            error(d_.at, "has a base; each slot is one interface by itself");
        if (d_.operations.size() > mostOperations)
            error(d_.at, "has " + std::to_string(d_.operations.size()) +
                             " operations; CONTROL has bits for " + std::to_string(mostOperations));
        for (const Operation& o : d_.operations)
            addCall(o);
        if (errors_ == 0)
            place();
        if (errors_ == 0)
            checkPorts();
        return block_;
    }

private:
    void error(const Location& at, const std::string& text) {
        ++errors_;
        diagnostics_.error(at, "interface '" + d_.name + "' in hardware: " + text);
    }

    // [":hw", "hw:type:0x4144", "hw:version:0x0100"]; by default the name's first letters, and 1.0.
    void identity() {
        std::string letters = upperCase(d_.name + "_");
        block_.type = static_cast<unsigned>(letters[0]) << 8 | static_cast<unsigned>(letters[1]);
        block_.version = 0x0100;
        checkWords(d_.metadata, {"hw:type", "hw:version"}, d_.at);
        for (auto [key, value] :
             {std::pair{"hw:type", &block_.type}, std::pair{"hw:version", &block_.version}}) {
            std::string text = d_.metadataValue(key);
            if (!text.empty() && !number(text, 0, 0xFFFF, *value))
                error(d_.at, "[\"" + std::string(key) + ":" + text + "\"] is not 0..0xFFFF");
        }
    }

    void checkWords(const std::vector<std::string>& metadata, const std::set<std::string>& known,
                    const Location& at) {
        for (const std::string& m : metadata)
            if (m.compare(0, 3, "hw:") == 0 && !known.count(m.substr(0, m.find(':', 3))))
                error(at, "[\"" + m + "\"] means nothing here");
    }

    void addCall(const Operation& o) {
        Call call;
        call.operation = &o;
        call.name = snakeCase(o.name);
        call.bit = static_cast<unsigned>(block_.calls.size());
        checkWords(o.metadata, {"hw:long", "hw:word"}, o.at);
        std::string limit = metadataValue(o.metadata, "hw:long");
        call.isLong = !limit.empty() || hasMetadata(o.metadata, "hw:long");
        call.timeout = defaultTimeout;
        if (!limit.empty() && !number(limit, 1, longestTimeout, call.timeout))
            error(o.at, "[\"hw:long:" + limit + "\"]: the time is in ms, 1.." +
                            std::to_string(longestTimeout));
        if (isAmd(d_, o))
            error(o.at, "'" + o.name + "' is [\"amd\"]; the generated servant answers itself");
        for (const Field& p : o.parameters) {
            checkWords(p.metadata, {"hw:word"}, p.at);
            std::string c = cIdentifier(p.name);
            if (p.isOut || isByPointer(p.type))
                c = "*" + c;
            add(call, p.type, p.isOptional, snakeCase(p.name), c, p.isOut,
                metadataValue(p.metadata, "hw:word"), p.at);
        }
        std::string word = metadataValue(o.metadata, "hw:word");
        if (o.result.kind != Type::Kind::Void)
            add(call, o.result, o.isResultOptional, "result", "*result", true, word, o.at);
        else if (!word.empty())
            error(o.at, "[\"hw:word:" + word + "\"]: '" + o.name + "' has no result");
        block_.calls.push_back(call);
    }

    void add(Call& call, const Type& type, bool isOptional, const std::string& name,
             const std::string& c, bool isOut, const std::string& wanted, const Location& at) {
        std::string what = "'" + name + "' of '" + call.operation->name + "'";
        if (isOptional)
            return error(at, what + " is optional; a register is always there");
        if (!isMappable(type))
            return error(at, what + " does not fit into registers: numbers, bools, enums and "
                                    "structs of them do");
        // Pieces share words with what precedes them, unless they have a word of their own.
        std::vector<Word> words;
        bool shares = wanted.empty() && !call.words.empty() && call.words.back().isOut == isOut &&
                      call.words.back().number == 0;
        if (shares) {
            words.push_back(call.words.back());
            call.words.pop_back();
        }
        addValue(words, type, name, c, isOut);
        unsigned first = 0;
        if (!wanted.empty() && !number(wanted, firstWord + 1, slotWords - 1, first))
            error(at, "[\"hw:word:" + wanted + "\"]: words " + std::to_string(firstWord + 1) +
                          ".." + std::to_string(slotWords - 1) + " can be chosen");
        for (Word& w : words) {
            if (first)
                w.number = first++;
            call.words.push_back(w);
        }
    }

    // Chosen words first, then the others in order into what is left.
    void place() {
        std::map<unsigned, std::string> taken = {{control, "CONTROL"}};
        if (block_.hasLong())
            taken[status] = "STATUS";
        unsigned needed = static_cast<unsigned>(taken.size());
        std::string list = block_.hasLong() ? "CONTROL 1, STATUS 1" : "CONTROL 1";
        for (Call& call : block_.calls) {
            unsigned counts[2] = {0, 0};
            for (Word& w : call.words) {
                w.name = upperCase(call.name) + (w.isOut ? "_OUT" : "_IN") +
                         std::to_string(counts[w.isOut]++);
                if (w.number >= slotWords)
                    error(call.operation->at, w.name + " would be word " +
                                                  std::to_string(w.number) +
                                                  "; 15 is the slot's last");
                else if (w.number && !taken.emplace(w.number, w.name).second)
                    error(call.operation->at, w.name + " wants word " + std::to_string(w.number) +
                                                  ", which is " + taken[w.number] + "'s");
            }
            needed += counts[0] + counts[1];
            if (counts[0] + counts[1])
                list += ", '" + call.operation->name + "' " + std::to_string(counts[0]) + " in " +
                        std::to_string(counts[1]) + " out";
        }
        constexpr unsigned room = slotWords - firstWord;
        if (needed > room)
            error(d_.at, "needs " + std::to_string(needed) + " words, a slot has " +
                             std::to_string(room) + ": " + list);
        if (errors_)
            return;
        unsigned next = firstWord;
        for (Call& call : block_.calls)
            for (Word& w : call.words)
                if (w.number == 0) {
                    while (taken.count(next))
                        ++next;
                    w.number = next;
                    taken[next] = w.name;
                }
    }

    // Two names of Slice may give one name of a port: aB and a_b, a member x of p and p_x.
    void checkPorts() {
        std::map<std::string, std::string> ports;
        for (const char* own : {"clk", "rst", "bus_valid", "bus_write", "bus_addr", "bus_wdata",
                                "bus_ready", "bus_rdata", "bus_error", "irq", "core_rst"})
            ports[own] = "the wrapper";
        for (const Call& call : block_.calls) {
            auto take = [&](const std::string& port) {
                auto [it, isNew] = ports.emplace(call.name + "_" + port, call.operation->name);
                if (!isNew)
                    error(call.operation->at, "'" + call.operation->name + "' needs the port '" +
                                                  it->first + "', as '" + it->second + "' does");
            };
            take("start");
            if (call.isLong) {
                take("done");
                take("refused");
            }
            for (const Word& w : call.words)
                for (const Piece& p : w.pieces)
                    if (p.portLsb == 0)
                        take(p.name);
        }
    }

    const Declaration& d_;
    Diagnostics& diagnostics_;
    Block block_;
    int errors_ = 0;
};

} // namespace

unsigned Block::events() const {
    unsigned count = 0;
    for (const Call& c : calls)
        if (c.isLong)
            count = c.bit + 1;
    return count;
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

std::vector<Block> mapHardware(const Unit& unit, Diagnostics& diagnostics) {
    std::vector<Block> blocks;
    std::map<std::string, const Declaration*> names;
    for (const auto& d : unit.declarations) {
        if (d->kind != Declaration::Kind::Interface || !d->isHardware() || d->fromInclude ||
            d->isForward || d->isLocal)
            continue;
        blocks.push_back(Mapper(*d, diagnostics).run());
        auto [it, isNew] = names.emplace(blocks.back().name, d.get());
        if (!isNew)
            diagnostics.error(d->at, "'" + d->id() + "' becomes '" + it->first +
                                         "' in hardware, as '" + it->second->id() + "' does");
    }
    if (blocks.empty() && diagnostics.errors() == 0)
        diagnostics.error({diagnostics.intern(unit.file), 1, 1},
                          "there is no interface with [\":hw\"] in this file");
    return blocks;
}

} // namespace hw
