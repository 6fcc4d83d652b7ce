// SPDX-License-Identifier: MIT
//
// hw_registers: the register description that regmap turns into headers and pages.

#include "doc_comment.h"
#include "hw_generator.h"
#include "writer.h"
#include <cstdio>

namespace hw {
namespace {

// A string of JSON whose text may also stand in a comment of C.
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
        act.fields.push_back(
            {name, firstLine(c.operation->doc, "begins " + c.operation->name), c.bit, 1});
        if (c.isLong)
            state.fields.push_back({name + "_BUSY", "has begun, and is not done", c.bit, 1});
    }
    for (const Call& c : b.calls)
        if (c.isLong)
            state.fields.push_back({upperCase(c.name) + "_REFUSED",
                                    "the core refused the last call", refusedLsb + c.bit, 1});
    act.fields.push_back({"RESET", "the core, and what is under way", resetBit, 1});
    list.push_back(act);
    if (b.hasLong())
        list.push_back(state);
    for (const Word* w : b.words()) {
        Register r{
            w->number, w->name, w->isOut ? "ro" : "rw", w->isOut ? "results" : "parameters", {}};
        for (const Piece& p : w->pieces) {
            std::string half = p.portWidth <= 32 ? "" : p.portLsb ? "_HIGH" : "_LOW";
            r.fields.push_back({upperCase(p.name) + half, p.name, p.lsb, p.width});
        }
        list.push_back(r);
    }
    return list;
}

} // namespace

GeneratedFile registersFile(const Block& b, const CFileNames&) {
    Writer w;
    w.line("{");
    w.line("  \"block\": \"" + b.name + "\",");
    w.line("  \"doc\": " +
           quoted(firstLine(b.interface->doc, "Registers of " + b.interface->id() + ".")) + ",");
    w.line("  \"type\": \"" + hex(b.type) + "\",");
    w.line("  \"version\": \"" + hex(b.version) + "\",");
    w.line("  \"servant\": {\"type\": \"" + b.interface->cName() + "_Core\", \"header\": \"" +
           b.name + "_servant.h\"},");
    w.line("  \"registers\": [");
    auto list = registers(b);
    for (const Register& r : list) {
        w.line("    {\"word\": " + std::to_string(r.number) + ", \"name\": \"" + r.name +
               "\", \"access\": \"" + r.access + "\", \"doc\": " + quoted(r.doc) +
               ", \"fields\": [");
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
        if (c.isLong)
            events.push_back("    {\"name\": \"" + upperCase(c.name) +
                             "_DONE\", \"bit\": " + std::to_string(c.bit) + ", \"doc\": " +
                             quoted(c.operation->name + " is done, or refused") + "}");
    for (const std::string& e : events)
        w.line(e + (&e == &events.back() ? "" : ","));
    w.line("  ]");
    w.line("}");
    return {b.name + ".regs.json", w.text()};
}

} // namespace hw
