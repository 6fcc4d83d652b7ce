// SPDX-License-Identifier: MIT
//
// registers: writes the register description, which icesoc.regs.generate converts to headers and
// pages.

#include "c/context.h"
#include "hw/generator.h"
#include "text/doc_comment.h"
#include <algorithm>
#include <nlohmann/json.hpp>

namespace hw {
namespace {

using json = nlohmann::ordered_json;

// Returns the first line of a doc comment, with any end of a C comment removed; returns `otherwise`
// if the doc comment is missing.
std::string firstLine(const std::string& doc, const std::string& otherwise) {
    auto lines = docLines(doc);
    return lines.empty() ? otherwise : lines.front();
}

json field(const std::string& name, unsigned lsb, unsigned width, const std::string& doc) {
    return {{"name", name}, {"lsb", lsb}, {"width", width}, {"doc", doc}};
}

json registerOf(const Block& b, unsigned number, const std::string& name, const char* access,
                const char* doc, const json& fields) {
    json r = {{"word", number % slotWords}};
    if (b.isPaged(number))
        r["page"] = number / slotWords * 32;
    r.update({{"name", name}, {"access", access}, {"doc", doc}, {"fields", fields}});
    return r;
}

json fieldsOf(const Word& word) {
    json fields = json::array();
    for (const Piece& p : word.pieces) {
        std::string half = p.portWidth <= 32 ? "" : p.portLsb ? "_HIGH" : "_LOW", doc = p.name;
        if (p.isCode)
            doc = "number of the thrown exception; 0 means none";
        if (p.isCount)
            doc = "number of elements, at most " + std::to_string(p.most) +
                  ", in the buffer at byte " + std::to_string(p.offset);
        fields.push_back(field(upperCase(p.name) + half, p.lsb, p.width, doc));
    }
    return fields;
}

json registers(const Block& b) {
    json act = json::array(), busy = json::array(), refused = json::array(), list = json::array();
    std::string reset = "RESET"; // the name is changed below if an operation is called reset
    for (const Call& c : b.calls) {
        std::string name = upperCase(c.name);
        std::string what = (c.isEvent ? "acknowledges the event " : "starts ") + c.operation->name;
        act.push_back(field(name, c.bit, 1, c.isEvent ? what : firstLine(c.operation->doc, what)));
        if (c.isLong)
            busy.push_back(field(name + "_BUSY", c.bit, 1, "in progress"));
        if (c.isLong)
            refused.push_back(
                field(name + "_REFUSED", refusedLsb + c.bit, 1, "the core refused the last call"));
    }
    while (std::any_of(act.begin(), act.end(), [&](const json& f) { return f["name"] == reset; }))
        reset = "CORE_" + reset;
    act.push_back(field(reset, resetBit, 1, "resets the core and ends all operations"));
    busy.insert(busy.end(), refused.begin(), refused.end());
    auto add = [&](unsigned number, const std::string& name, const char* access, const char* doc,
                   const json& fields) {
        list.push_back(registerOf(b, number, name, access, doc, fields));
    };
    add(control, "CONTROL", "ws", "writing 1 to a bit starts the operation", act);
    if (b.hasLong())
        add(status, "STATUS", "ro", "state of operations that take time", busy);
    if (b.pageBits)
        add(page, "PAGE", "rw", "selects the page that words 8 to 15 show",
            json::array({field("ADDRESS", 0, pageLsb + b.pageBits,
                               "byte address in the core, a multiple of 32")}));
    unsigned lsb = b.memoryLsb();
    if (b.memoryWord)
        add(b.memoryWord, "MEMORY", "rw", "place of the buffers in DDR3",
            json::array({field("ADDRESS", 0, 32 - lsb,
                               "byte address, bits " + std::to_string(lsb) + " and up")}));
    for (const Word* w : b.words())
        add(w->number, w->name, w->isOut ? "ro" : "rw", w->isOut ? "results" : "parameters",
            fieldsOf(*w));
    return list;
}

json eventsOf(const Block& b) {
    json events = json::array();
    for (const Call& c : b.calls)
        if (c.isEvent || c.isLong)
            events.push_back(
                {{"name", upperCase(c.name) + (c.isEvent ? "" : "_DONE")},
                 {"bit", c.bit},
                 {"doc", c.isEvent ? firstLine(c.operation->doc, "event " + c.operation->name)
                                   : c.operation->name + " has ended or was refused"}});
    return events;
}

} // namespace

GeneratedFile registersFile(const Block& b) {
    json file = {{"block", b.name},
                 {"doc", firstLine(b.interface->doc, "Registers of " + b.interface->id() + ".")},
                 {"type", "0x" + hexDigits(b.type, 4)},
                 {"version", "0x" + hexDigits(b.version, 4)}};
    if (b.memoryBytes)
        file.update({{"memory_port", true}, {"memory_bytes", b.memoryBytes}});
    for (const Pin& p : b.pins)
        file["pins"].push_back({{"name", p.name}, {"width", p.width}});
    file["servant"] = {{"type", coreType(b)}, {"header", b.name + "_servant.h"}};
    file["registers"] = registers(b);
    file["events"] = eventsOf(b);
    return {b.name + ".regs.json", file.dump(1, ' ', false, json::error_handler_t::replace) + "\n"};
}

} // namespace hw
