// SPDX-License-Identifier: MIT
//
// values: generates the part of the servant that writes C values to registers and buffers, and
// reads them back.

#include "c/context.h"
#include "hw/generator.h"
#include <algorithm>
#include <set>

namespace hw {
namespace {

using Kind = Type::Kind;

std::string macro(const Block& b, const Word& w, const Piece& p, const char* what) {
    std::string half = p.portWidth <= 32 ? "" : p.portLsb ? "_HIGH" : "_LOW";
    return upperCase(b.name) + "_" + w.name + "_" + upperCase(p.name) + half + "_" + what;
}

// Returns the C expression for a piece, with parentheses around a dereferenced pointer.
std::string lvalue(const Piece& p) {
    return p.c[0] == '*' ? "(" + p.c + ")" : p.c;
}

// Returns the expression that converts a value to the bits of a U32.
std::string bitsOf(const Piece& p) {
    std::string c = lvalue(p);
    if (p.isCount)
        return "(U32)" + c + ".size";
    switch (p.type.kind) {
    case Kind::Bool:
        return "(U32)(" + c + " != 0)";
    case Kind::Short:
        return "(U32)(U16)" + c;
    case Kind::Long:
        return p.portLsb ? "(U32)" + c + ".high" : c + ".low";
    case Kind::Float:
        return "Hw_floatBits(" + c + ")";
    case Kind::Double:
        return "Hw_doubleBits(" + c + ", " + (p.portLsb ? "1" : "0") + ")";
    default:
        return "(U32)" + c;
    }
}

// Returns the start of the C call that reads or writes a word: the name and first arguments
// of the function. If the word is on a page, the function that is called also selects the page.
std::string access(const Block& b, const Word& word, const std::string& what) {
    std::string name = upperCase(b.name) + "_" + word.name;
    return b.isPaged(word.number)
               ? "Hw_Core_" + what + "(&hw_core->core, " + name + ", " + name + "_PAGE"
               : "FSMC_" + what + "(hw_core->core.slot, " + name;
}

void writeWord(Writer& w, const Block& b, const Word& word) {
    std::string value;
    for (const Piece& p : word.pieces) {
        std::string bits = bitsOf(p);
        if (p.lsb)
            bits = bits + " << " + macro(b, word, p, "LSB");
        value += (value.empty() ? "" : " | ") + bits;
    }
    w.line(access(b, word, "write") + ", " + value + ");");
}

std::string address(const Piece& p) {
    return "hw_core->core.memory + " + std::to_string(p.offset) + "U";
}

std::string roomOf(const Call& c, const Piece& p) {
    return c.name + "_" + p.name.substr(0, p.name.size() - 5) + "data";
}

// Writes code that reads a sequence. The elements have the same layout in DDR3 as in a C array.
void readSequence(Writer& w, const Call& c, const Piece& p, const std::string& count) {
    std::string sequence = lvalue(p), bytes = std::to_string(p.elementBytes) + "U";
    w.line(sequence + ".size = (Ice_Int)" + count + ";");
    w.single("if (" + sequence + ".size > " + std::to_string(p.most) + ")",
             "return ICE_UNKNOWN_EXCEPTION; /* too long for the buffer */");
    if (statedMaximum(*p.type.declaration) <= 0)
        w.line(sequence + ".data = hw_core->" + roomOf(c, p) + ";");
    w.line("FSMC_readMemory(" + address(p) + ", (U8 *)" + sequence + ".data, (U32)" + sequence +
           ".size * " + bytes + ");");
}

void readPiece(Writer& w, const Block& b, const Call& c, const Word& word, const Piece& p) {
    std::string bits = p.width == 32 ? "hw_word"
                                     : "(hw_word & " + macro(b, word, p, "MASK") + ") >> " +
                                           macro(b, word, p, "LSB");
    std::string whole = p.width == 32 ? bits : "(" + bits + ")", to = lvalue(p);
    if (p.isCount)
        return readSequence(w, c, p, whole);
    switch (p.type.kind) {
    case Kind::Long:
        w.line(to + (p.portLsb ? ".high = (S32)" : ".low = ") + bits + ";");
        return;
    case Kind::Float:
        w.line(to + " = Hw_float(" + bits + ");");
        return;
    case Kind::Double:
        if (p.portLsb)
            w.line(to + " = Hw_double(hw_low, " + bits + ");");
        else
            w.line("hw_low = " + bits + ";");
        return;
    case Kind::Named: {
        int64_t largest = 0;
        for (const Enumerator& e : p.type.declaration->enumerators)
            largest = std::max(largest, e.value);
        if (largest + 1 < int64_t(1) << p.width) {
            w.single("if (" + whole + " > " + std::to_string(largest) + "U)",
                     "return ICE_UNKNOWN_EXCEPTION; /* no such enumerator */");
        }
        break;
    }
    default:
        break;
    }
    w.line(to + " = (" + cType(p.type) + ")" + whole + ";");
}

// Writes code that reads the words with the values of an exception; if `exception` is 0, reads the
// words with the results of the call.
void readWords(Writer& w, const Block& b, const Call& c, unsigned exception) {
    for (const Word& word : c.words) {
        bool isRead = false;
        for (const Piece& p : word.pieces) {
            if (!word.isOut || p.isCode || p.exception != exception)
                continue;
            if (!isRead)
                w.line("hw_word = " + access(b, word, "read") + ");");
            isRead = true;
            readPiece(w, b, c, word, p);
        }
    }
}

void readException(Writer& w, const Block& b, const Call& c) {
    for (const Word& word : c.words)
        for (const Piece& p : word.pieces)
            if (p.isCode) {
                w.line("hw_word = " + access(b, word, "read") + ");");
                w.line("switch ((hw_word & " + macro(b, word, p, "MASK") + ") >> " +
                       macro(b, word, p, "LSB") + ") {");
            }
    w.single("case 0:", "break;");
    for (size_t i = 0; i < c.thrown.size(); ++i) {
        w.line("case " + std::to_string(i + 1) + ":");
        w.indented([&] {
            w.line("ex->type = " + c.labels[i] + ";");
            readWords(w, b, c, static_cast<unsigned>(i + 1));
            w.line("return ICE_USER_EXCEPTION;");
        });
    }
    w.single("default:", "return ICE_UNKNOWN_EXCEPTION; /* no such exception */");
    w.line("}");
}

} // namespace

std::string coreType(const Block& b) {
    return cName(*b.interface) + "_Core";
}

void writeParameters(Writer& w, const Block& b, const Call& c) {
    for (const Word& word : c.words)
        for (const Piece& p : word.pieces)
            if (!word.isOut && p.isCount) {
                std::string sequence = lvalue(p);
                w.single("if (" + sequence + ".size > " + std::to_string(p.most) + ")",
                         "return ICE_LIMIT; /* too long for the buffer */");
                w.line("FSMC_writeMemory(" + address(p) + ", (const U8 *)" + sequence +
                       ".data, (U32)" + sequence + ".size * " + std::to_string(p.elementBytes) +
                       "U);");
            }
    for (const Word& word : c.words)
        if (!word.isOut)
            writeWord(w, b, word);
}

void readResults(Writer& w, const Block& b, const Call& c) {
    if (!c.thrown.empty())
        readException(w, b, c);
    readWords(w, b, c, 0);
}

void resultVariables(Writer& w, const Call& c) {
    bool returns = false, hasDouble = false;
    for (const Word& word : c.words)
        for (const Piece& p : word.pieces) {
            returns |= word.isOut;
            hasDouble |= word.isOut && !p.isCount && p.type.kind == Kind::Double;
        }
    if (returns)
        w.line("U32 hw_word;");
    if (hasDouble)
        w.line("U32 hw_low;");
}

void sequenceMembers(Writer& w, const Block& b) {
    for (const Call& c : b.calls)
        for (const Word& word : c.words)
            for (const Piece& p : word.pieces)
                if (word.isOut && p.isCount && statedMaximum(*p.type.declaration) <= 0)
                    w.line("    " + cType(p.type.declaration->element) + " " + roomOf(c, p) + "[" +
                           std::to_string(p.most) + "];");
}

void checkLayouts(Writer& w, const Block& b) {
    std::set<std::string> seen;
    for (const Call& c : b.calls)
        for (const Word& word : c.words)
            for (const Piece& p : word.pieces) {
                if (!p.isCount || p.type.declaration->element.kind != Kind::Named)
                    continue;
                std::string type = cType(p.type.declaration->element);
                if (!seen.insert(type).second)
                    continue;
                if (seen.size() == 1)
                    w.blank();
                w.line("typedef char " + b.name + "_layout_of_" + type + "[sizeof(" + type +
                       ") == " + std::to_string(p.elementBytes) + " ? 1 : -1];");
            }
}

} // namespace hw
