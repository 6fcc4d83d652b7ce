// SPDX-License-Identifier: MIT
//
// calls: maps operations and events of a hardware interface to words and buffers, and checks that
// their types are allowed.

#include "c/context.h"
#include "hw/generator.h"
#include <algorithm>

namespace hw {
namespace {

constexpr unsigned defaultTimeout = 1000, longestTimeout = 60000; // ms
constexpr unsigned mostElements = 65535;
const std::string unfit =
    "' does not fit into registers: expected numbers, bools, enums, or structs of these";

class CallMapper {
public:
    CallMapper(const Declaration& d, const Unit& unit, Block& block, Diagnostics& diagnostics)
        : d_(d), unit_(unit), block_(block), diagnostics_(diagnostics) {}

    void run() {
        for (const Operation& o : d_.operations)
            if (isListener(o))
                addListener(o);
            else
                addOperation(o);
        if (offset_) {
            block_.memoryBytes = bufferAlignment;
            while (block_.memoryBytes < offset_)
                block_.memoryBytes *= 2;
        }
    }

private:
    void error(const Location& at, const std::string& text) {
        diagnostics_.error(at, "interface '" + d_.name + "' in hardware: " + text);
    }
    void keys(const std::vector<std::string>& metadata, const std::vector<std::string>& known,
              const Location& at) {
        checkKeys(metadata, known, "interface '" + d_.name + "'", at, diagnostics_);
    }

    static bool isListener(const Operation& o) {
        return std::any_of(o.parameters.begin(), o.parameters.end(),
                           [](const Field& p) { return p.type.kind == Type::Kind::Proxy; });
    }

    Call begin(const Operation& o, const Declaration& owner) {
        Call call;
        call.owner = &owner;
        call.operation = &o;
        call.name = snakeCase(o.name);
        call.bit = static_cast<unsigned>(block_.calls.size());
        call.timeout = defaultTimeout;
        return call;
    }

    void addOperation(const Operation& o) {
        Call call = begin(o, d_);
        keys(o.metadata, {"hw:long", "hw:word", "hw:max"}, o.at);
        std::string limit = metadataValue(o.metadata, "hw:long");
        call.isLong = !limit.empty() || hasMetadata(o.metadata, "hw:long");
        call.isAmd = isAmd(d_, o);
        if (!limit.empty() && !number(limit, 1, longestTimeout, call.timeout))
            error(o.at, "[\"hw:long:" + limit + "\"]: expected a time in ms, 1 to " +
                            std::to_string(longestTimeout));
        if (call.isAmd && !call.isLong)
            error(o.at, "'" + o.name + "' has [\"amd\"] but not [\"hw:long\"], so it ends at once");
        call.thrown = o.throws;
        for (const Declaration* e : o.throws)
            call.labels.push_back(operationName(d_, o) + "_" +
                                  exceptionLabel(o, mayThrow(unit_, o), *e));
        for (const Field& p : o.parameters)
            if (!p.isOut)
                addParameter(call, p);
        if (!call.thrown.empty())
            addCode(call.words, call.thrown.size());
        for (const Field& p : o.parameters)
            if (p.isOut)
                addParameter(call, p);
        addResult(call);
        for (size_t i = 0; i < call.thrown.size(); ++i)
            addException(call, static_cast<unsigned>(i + 1));
        block_.calls.push_back(call);
    }

    void addParameter(Call& call, const Field& p) {
        keys(p.metadata, {"hw:word", "hw:max"}, p.at);
        std::string c = cParameter(*call.operation, p);
        if (p.isOut || isByPointer(p.type))
            c = "*" + c;
        add(call, p.type, p.isOptional, snakeCase(p.name), c, p.isOut, p.metadata, p.at);
    }

    void addResult(Call& call) {
        const Operation& o = *call.operation;
        std::string word = metadataValue(o.metadata, "hw:word");
        if (o.result.kind != Type::Kind::Void)
            add(call, o.result, o.isResultOptional, "result", "*result", true, o.metadata, o.at);
        else if (!word.empty())
            error(o.at, "[\"hw:word:" + word + "\"]: '" + o.name + "' has no result");
    }

    void addException(Call& call, unsigned index) {
        const Declaration& e = *call.thrown[index - 1];
        std::string object =
            "ex->u." + exceptionMember(*call.operation, mayThrow(unit_, *call.operation), e) + ".";
        for (const Declaration* d = &e; d; d = d->base(), object += "base.")
            for (const Field& f : d->fields) {
                std::string name = snakeCase(e.name) + "_" + snakeCase(f.name);
                if (f.isOptional || !isMappable(f.type))
                    error(call.operation->at, "'" + f.name + "' of '" + e.name + unfit);
                else
                    addValue(call.words, f.type, name, object + cMember(*d, f), true, index);
            }
    }

    // Maps an operation such as void listen(Watcher* watcher): the operations of Watcher become
    // events.
    void addListener(const Operation& o) {
        const Type& type = o.parameters.front().type;
        if (o.parameters.size() != 1 || o.parameters.front().isOut || !type.declaration ||
            type.declaration->isForward || o.result.kind != Type::Kind::Void || !o.throws.empty())
            return error(o.at, "'" + o.name +
                                   "' has a proxy: an operation that registers a proxy must have "
                                   "no other parameter and no result");
        keys(o.metadata, {}, o.at);
        Listener l{&o, type.declaration, snakeCase(o.name), block_.calls.size(), 0};
        for (const Declaration* d : lineage(*type.declaration))
            for (const Operation& event : d->operations) {
                if (event.result.kind != Type::Kind::Void || !event.throws.empty() ||
                    std::any_of(event.parameters.begin(), event.parameters.end(),
                                [](const Field& p) { return p.isOut; })) {
                    error(o.at, "'" + event.name + "' of '" + d->name +
                                    "' is an event, which cannot have results or throw exceptions");
                    continue;
                }
                Call call = begin(event, *d);
                call.isEvent = true;
                for (const Field& p : event.parameters)
                    addEventValue(call, p, o.at);
                block_.calls.push_back(call);
            }
        l.count = block_.calls.size() - l.first;
        block_.listeners.push_back(l);
    }

    void addEventValue(Call& call, const Field& p, const Location& at) {
        std::string c = "*" + cParameter(*call.operation, p);
        if (p.isOptional || !isMappable(p.type))
            return error(at, "'" + p.name + "' of the event '" + call.operation->name + unfit);
        addValue(call.words, p.type, snakeCase(p.name), c, true);
    }

    void add(Call& call, const Type& type, bool isOptional, const std::string& name,
             const std::string& c, bool isOut, const std::vector<std::string>& metadata,
             const Location& at) {
        std::string subject = "'" + name + "' of '" + call.operation->name, what = subject + "'";
        std::string wanted = metadataValue(metadata, "hw:word");
        std::string most = metadataValue(metadata, "hw:max");
        if (isOptional)
            return error(
                at,
                what + " is optional: expected a value that is always present, like a register");
        if (!isSequence(type) && !isMappable(type))
            return error(at, subject + unfit);
        if (!isSequence(type) && !most.empty())
            return error(at, "[\"hw:max:" + most + "\"]: " + what + " is not a sequence");
        std::vector<Word> chosen, &words = wanted.empty() ? call.words : chosen;
        if (isSequence(type))
            addSequence(words, type, what, name, c, isOut, most, at);
        else
            addValue(words, type, name, c, isOut);
        unsigned first = 0;
        if (!wanted.empty() && !number(wanted, firstWord + 1, slotWords - 1, first))
            error(at, "[\"hw:word:" + wanted + "\"]: expected a word from " +
                          std::to_string(firstWord + 1) + " to " + std::to_string(slotWords - 1));
        for (Word& w : chosen) {
            if (first)
                w.number = first++;
            call.words.push_back(w);
        }
    }

    void addSequence(std::vector<Word>& words, const Type& type, const std::string& what,
                     const std::string& name, const std::string& c, bool isOut,
                     const std::string& most, const Location& at) {
        unsigned bytes = elementBytes(type);
        if (bytes == 0)
            return error(at, what + " has elements that do not fit into a buffer: expected "
                                    "numbers, bools, or structs of these");
        int stated = statedMaximum(*type.declaration);
        unsigned count = stated > 0 ? static_cast<unsigned>(stated) : 0;
        unsigned limit = count ? count : mostElements;
        if (!most.empty() && !number(most, 1, limit, count))
            return error(at, "[\"hw:max:" + most + "\"]: expected 1 to " + std::to_string(limit) +
                                 " elements");
        if (count == 0)
            return error(at, what + " is a sequence: add [\"hw:max:N\"], the largest number of "
                                    "elements in its DDR3 buffer");
        addCount(words, type, name, c, isOut, count, offset_);
        offset_ += (count * bytes + bufferAlignment - 1) / bufferAlignment * bufferAlignment;
    }

    const Declaration& d_;
    const Unit& unit_;
    Block& block_;
    Diagnostics& diagnostics_;
    unsigned offset_ = 0; // size of all buffers so far, bytes
};

} // namespace

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

void checkKeys(const std::vector<std::string>& metadata, const std::vector<std::string>& known,
               const std::string& who, const Location& at, Diagnostics& diagnostics) {
    for (const std::string& m : metadata)
        if (m.compare(0, 3, "hw:") == 0 &&
            std::find(known.begin(), known.end(), m.substr(0, m.find(':', 3))) == known.end())
            diagnostics.error(at, who + " in hardware: [\"" + m + "\"] is not valid here");
}

void mapCalls(const Declaration& d, const Unit& unit, Block& block, Diagnostics& diagnostics) {
    CallMapper(d, unit, block, diagnostics).run();
}

} // namespace hw
