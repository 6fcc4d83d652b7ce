// SPDX-License-Identifier: MIT
//
// registers: the register description that regmap turns into headers and pages.

#include "c/context.h"
#include "hw/generator.h"
#include "text/doc_comment.h"
#include <algorithm>
#include <cstdio>

namespace hw {
namespace {

// Quotes a string for JSON; its text may also stand in a comment of C.
std::string quoted(const std::string& text) {
    std::string s = "\"";
    for (size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (c == '"' || c == '\\')
            s += '\\';
        s += static_cast<unsigned char>(c) < 32 ? ' ' : c;
        if (c == '*' && i + 1 < text.size() && text[i + 1] == '/')
            s += ' ';
    }
    return s + '"';
}

std::string hex(unsigned value) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%04X", value);
    return text;
}

std::string firstLine(const std::string& doc, const std::string& otherwise) {
    auto lines = docLines(doc);
    return lines.empty() ? otherwise : lines.front();
}

struct Bits {
    std::string name, doc;
    unsigned lsb, width;
};

struct Register {
    unsigned number;
    std::string name, access, doc;
    std::vector<Bits> fields;
};

std::vector<Register> registers(const Block& b) {
    std::vector<Register> list;
    Register act{control, "CONTROL", "ws", "1 in an operation's bit: it begins", {}};
    Register state{status, "STATUS", "ro", "of operations that take time", {}};
    for (const Call& c : b.calls) {
        std::string name = upperCase(c.name);
        std::string what = (c.isEvent ? "the event was taken: " : "begins ") + c.operation->name;
        act.fields.push_back(
            {name, c.isEvent ? what : firstLine(c.operation->doc, what), c.bit, 1});
        if (c.isLong)
            state.fields.push_back({name + "_BUSY", "has begun, and is not done", c.bit, 1});
    }
    for (const Call& c : b.calls)
        if (c.isLong)
            state.fields.push_back({upperCase(c.name) + "_REFUSED",
                                    "the core refused the last call", refusedLsb + c.bit, 1});
    std::string reset = "RESET"; // unless an operation has that name
    while (std::any_of(act.fields.begin(), act.fields.end(),
                       [&](const Bits& f) { return f.name == reset; }))
        reset = "CORE_" + reset;
    act.fields.push_back({reset, "the core, and what is under way", resetBit, 1});
    list.push_back(act);
    if (b.hasLong())
        list.push_back(state);
    if (b.pageBits)
        list.push_back({page,
                        "PAGE",
                        "rw",
                        "which words 8..15 are",
                        {{"ADDRESS", "a multiple of 32", 0, pageLsb + b.pageBits}}});
    if (b.memoryWord)
        list.push_back(
            {b.memoryWord,
             "MEMORY",
             "rw",
             "where the buffers are in DDR3",
             {{"ADDRESS", "byte address from bit " + std::to_string(b.memoryLsb()) + " on", 0,
               32 - b.memoryLsb()}}});
    for (const Word* w : b.words()) {
        Register r{
            w->number, w->name, w->isOut ? "ro" : "rw", w->isOut ? "results" : "parameters", {}};
        for (const Piece& p : w->pieces) {
            if (p.isCount || p.isCode) {
                r.fields.push_back({upperCase(p.name),
                                    p.isCode
                                        ? "0: none; else which exception"
                                        : "elements, at most " + std::to_string(p.most) +
                                              ", in the buffer at byte " + std::to_string(p.offset),
                                    p.lsb, p.width});
                continue;
            }
            std::string half = p.portWidth <= 32 ? "" : p.portLsb ? "_HIGH" : "_LOW";
            r.fields.push_back({upperCase(p.name) + half, p.name, p.lsb, p.width});
        }
        list.push_back(r);
    }
    return list;
}

} // namespace

GeneratedFile registersFile(const Block& b) {
    Writer w;
    w.line("{");
    w.line("  \"block\": \"" + b.name + "\",");
    w.line("  \"doc\": " +
           quoted(firstLine(b.interface->doc, "Registers of " + b.interface->id() + ".")) + ",");
    w.line("  \"type\": \"" + hex(b.type) + "\",");
    w.line("  \"version\": \"" + hex(b.version) + "\",");
    if (b.memoryBytes) {
        w.line("  \"memory_port\": true,");
        w.line("  \"memory_bytes\": " + std::to_string(b.memoryBytes) + ",");
    }
    std::string pins;
    for (const Pin& p : b.pins)
        pins += (pins.empty() ? "" : ", ") +
                ("{\"name\": \"" + p.name + "\", \"width\": " + std::to_string(p.width) + "}");
    if (!pins.empty())
        w.line("  \"pins\": [" + pins + "],");
    w.line("  \"servant\": {\"type\": \"" + cName(*b.interface) + "_Core\", \"header\": \"" +
           b.name + "_servant.h\"},");
    w.line("  \"registers\": [");
    auto list = registers(b);
    for (const Register& r : list) {
        std::string behind = b.isPaged(r.number)
                                 ? "\"page\": " + std::to_string(r.number / slotWords * 32) + ", "
                                 : "";
        w.line("    {\"word\": " + std::to_string(r.number % slotWords) + ", " + behind +
               "\"name\": \"" + r.name + "\", \"access\": \"" + r.access +
               "\", \"doc\": " + quoted(r.doc) + ", \"fields\": [");
        for (const Bits& f : r.fields)
            w.line("      {\"name\": \"" + f.name + "\", \"lsb\": " + std::to_string(f.lsb) +
                   ", \"width\": " + std::to_string(f.width) + ", \"doc\": " + quoted(f.doc) + "}" +
                   (&f == &r.fields.back() ? "]}" : ",") +
                   (&f == &r.fields.back() && &r != &list.back() ? "," : ""));
    }
    w.line("  ],");
    w.line("  \"events\": [");
    std::vector<std::string> events;
    for (const Call& c : b.calls)
        if (c.isEvent || c.isLong) {
            std::string name = upperCase(c.name) + (c.isEvent ? "" : "_DONE"),
                        doc = c.isEvent ? firstLine(c.operation->doc, "event " + c.operation->name)
                                        : c.operation->name + " is done, or refused";
            events.push_back("    {\"name\": \"" + name + "\", \"bit\": " + std::to_string(c.bit) +
                             ", \"doc\": " + quoted(doc) + "}");
        }
    for (const std::string& e : events)
        w.line(e + (&e == &events.back() ? "" : ","));
    w.line("  ]");
    w.line("}");
    return {b.name + ".regs.json", w.text()};
}

} // namespace hw
