// SPDX-License-Identifier: MIT
//
// registers: writes the register description, which icesoc.regs.generate converts to headers and
// pages.

#include "c/context.h"
#include "hw/generator.h"
#include "text/doc_comment.h"
#include "text/json.h"
#include <algorithm>

namespace hw {
namespace {

// Returns the first line of a doc comment, with any end of a C comment removed; returns `otherwise`
// if the doc comment is missing.
std::string firstLine(const std::string& doc, const std::string& otherwise) {
    auto lines = docLines(doc);
    return lines.empty() ? otherwise : lines.front();
}

Json field(const std::string& name, unsigned lsb, unsigned width, const std::string& doc) {
    return Json::object({{"name", name}, {"lsb", lsb}, {"width", width}, {"doc", doc}});
}

Json registerOf(const Block& b, unsigned number, const std::string& name, const char* access,
                const char* doc, const Json& fields) {
    Json r = Json::object({{"word", number % slotWords}});
    if (b.isPaged(number))
        r.set("page", number / slotWords * 32);
    r.set({{"name", name}, {"access", access}, {"doc", doc}, {"fields", fields}});
    return r;
}

Json fieldsOf(const Word& word) {
    Json fields = Json::array();
    for (const Piece& p : word.pieces) {
        std::string half = p.portWidth <= 32 ? "" : p.portLsb ? "_HIGH" : "_LOW", doc = p.name;
        if (p.isCode)
            doc = "number of the thrown exception; 0 means none";
        if (p.isCount)
            doc = "number of elements, at most " + std::to_string(p.most) +
                  ", in the buffer at byte " + std::to_string(p.offset);
        fields.add(field(upperCase(p.name) + half, p.lsb, p.width, doc));
    }
    return fields;
}

Json registers(const Block& b) {
    Json act = Json::array(), states = Json::array(), list = Json::array();
    std::string reset = "RESET"; // the name is changed below if an operation is called reset
    for (const Call& c : b.calls) {
        std::string name = upperCase(c.name);
        std::string what = (c.isEvent ? "acknowledges the event " : "starts ") + c.operation->name;
        act.add(field(name, c.bit, 1, c.isEvent ? what : firstLine(c.operation->doc, what)));
        if (c.isLong)
            states.add(field(name + "_BUSY", c.bit, 1, "in progress"));
    }
    for (const Call& c : b.calls)
        if (c.isLong)
            states.add(field(upperCase(c.name) + "_REFUSED", refusedLsb + c.bit, 1,
                             "the core refused the last call"));
    while (std::any_of(b.calls.begin(), b.calls.end(),
                       [&](const Call& c) { return upperCase(c.name) == reset; }))
        reset = "CORE_" + reset;
    act.add(field(reset, resetBit, 1, "resets the core and ends all operations"));
    auto add = [&](unsigned number, const std::string& name, const char* access, const char* doc,
                   const Json& fields) {
        list.add(registerOf(b, number, name, access, doc, fields));
    };
    add(control, "CONTROL", "ws", "writing 1 to a bit starts the operation", act);
    if (b.hasLong())
        add(status, "STATUS", "ro", "state of operations that take time", states);
    if (b.pageBits)
        add(page, "PAGE", "rw", "selects the page that words 8 to 15 show",
            Json::array({field("ADDRESS", 0, pageLsb + b.pageBits,
                               "byte address in the core, a multiple of 32")}));
    unsigned lsb = b.memoryLsb();
    if (b.memoryWord)
        add(b.memoryWord, "MEMORY", "rw", "place of the buffers in DDR3",
            Json::array({field("ADDRESS", 0, 32 - lsb,
                               "byte address, bits " + std::to_string(lsb) + " and up")}));
    for (const Word* w : b.words())
        add(w->number, w->name, w->isOut ? "ro" : "rw", w->isOut ? "results" : "parameters",
            fieldsOf(*w));
    return list;
}

Json eventsOf(const Block& b) {
    Json events = Json::array();
    for (const Call& c : b.calls)
        if (c.isEvent || c.isLong)
            events.add(Json::object(
                {{"name", upperCase(c.name) + (c.isEvent ? "" : "_DONE")},
                 {"bit", c.bit},
                 {"doc", c.isEvent ? firstLine(c.operation->doc, "event " + c.operation->name)
                                   : c.operation->name + " has ended or was refused"}}));
    return events;
}

} // namespace

GeneratedFile registersFile(const Block& b) {
    Json file = Json::object(
        {{"block", b.name},
         {"doc", firstLine(b.interface->doc, "Registers of " + b.interface->id() + ".")},
         {"type", "0x" + hexDigits(b.type, 4)},
         {"version", "0x" + hexDigits(b.version, 4)}});
    if (b.memoryBytes)
        file.set({{"memory_port", true}, {"memory_bytes", b.memoryBytes}});
    Json pins = Json::array();
    for (const Pin& p : b.pins)
        pins.add(Json::object({{"name", p.name}, {"width", p.width}}));
    if (!b.pins.empty())
        file.set("pins", pins);
    file.set("servant", Json::object({{"type", coreType(b)}, {"header", b.name + "_servant.h"}}));
    file.set("registers", registers(b));
    file.set("events", eventsOf(b));
    return {b.name + ".regs.json", file.print() + "\n"};
}

} // namespace hw
