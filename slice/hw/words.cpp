// SPDX-License-Identifier: MIT
//
// words: packs scalars into words, and assigns words to addresses in the slot.

#include "c/context.h"
#include "hw/generator.h"
#include <algorithm>
#include <cctype>

namespace hw {
namespace {

using Kind = Type::Kind;
using DKind = Declaration::Kind;

unsigned bitsFor(unsigned largest) {
    unsigned width = 1;
    while (largest >> width)
        ++width;
    return width;
}

unsigned enumWidth(const Declaration& d) {
    int64_t largest = 0;
    for (const Enumerator& e : d.enumerators)
        largest = std::max(largest, e.value);
    return bitsFor(static_cast<unsigned>(largest));
}

unsigned scalarWidth(const Type& t) {
    if (t.kind == Kind::Named)
        return enumWidth(*t.declaration);
    return t.kind == Kind::Bool ? 1 : 8 * static_cast<unsigned>(factsOf(t).leastWireSize);
}

void addPiece(std::vector<Word>& words, Piece piece, bool isOut) {
    bool fits = !words.empty() && words.back().isOut == isOut && words.back().number == 0 &&
                words.back().width() + piece.width <= 32;
    if (!fits)
        words.push_back({0, "", "", isOut, {}});
    else
        piece.lsb = words.back().width();
    words.back().pieces.push_back(piece);
}

struct Layout {
    unsigned size, alignment;
};

// Returns the layout of a type. Size 0 means that compilers differ in the layout, for example
// because the size of an enum is the compiler's choice.
Layout layoutOf(const Type& t) {
    if (t.kind == Kind::Named && t.declaration->kind == DKind::Struct) {
        Layout whole{0, 1};
        for (const Field& f : t.declaration->fields) {
            Layout l = layoutOf(f.type);
            if (l.size == 0)
                return {0, 1};
            whole.size = (whole.size + l.alignment - 1) / l.alignment * l.alignment + l.size;
            whole.alignment = std::max(whole.alignment, l.alignment);
        }
        whole.size = (whole.size + whole.alignment - 1) / whole.alignment * whole.alignment;
        return whole;
    }
    if (t.kind == Kind::Named)
        return {0, 1};
    unsigned bytes = t.kind == Kind::Bool ? 1 : scalarWidth(t) / 8;
    return {bytes, t.kind == Kind::Long ? 4 : bytes}; // a long consists of two words
}

} // namespace

bool isSequence(const Type& t) {
    return t.kind == Kind::Named && t.declaration->kind == DKind::Sequence;
}

unsigned elementBytes(const Type& t) {
    const Type& element = t.declaration->element;
    return isMappable(element) ? layoutOf(element).size : 0;
}

std::string baseName(const Piece& count) {
    return count.name.substr(0, count.name.size() - 5) + "base";
}

void addCount(std::vector<Word>& words, const Type& t, const std::string& name,
              const std::string& c, bool isOut, unsigned most, unsigned offset) {
    Piece p;
    p.type = t;
    p.name = name + "_count";
    p.c = c;
    p.width = p.portWidth = bitsFor(most);
    p.isCount = true;
    p.most = most;
    p.offset = offset;
    p.elementBytes = elementBytes(t);
    addPiece(words, p, isOut);
}

void addCode(std::vector<Word>& words, size_t count) {
    Piece p;
    p.name = "exception";
    p.width = p.portWidth = bitsFor(static_cast<unsigned>(count));
    p.isCode = true;
    addPiece(words, p, true);
}

std::string snakeCase(const std::string& name) {
    std::string s;
    for (size_t i = 0; i < name.size(); ++i) {
        auto isUpper = [&](size_t k) { return k < name.size() && std::isupper(name[k]) != 0; };
        auto isLower = [&](size_t k) { return k < name.size() && std::islower(name[k]) != 0; };
        bool begins =
            isUpper(i) && i > 0 && name[i - 1] != '_' && (!isUpper(i - 1) || isLower(i + 1));
        if (begins)
            s += '_';
        s += static_cast<char>(std::tolower(name[i]));
    }
    return s;
}

std::string upperCase(std::string text) {
    for (char& c : text)
        c = static_cast<char>(std::toupper(c));
    return text;
}

std::string hexDigits(unsigned value, unsigned digits) {
    std::string text;
    while (digits-- > 0)
        text += "0123456789ABCDEF"[value >> 4 * digits & 15];
    return text;
}

bool isMappable(const Type& t) {
    if (t.kind == Kind::Named && t.declaration->kind == DKind::Struct)
        return std::all_of(t.declaration->fields.begin(), t.declaration->fields.end(),
                           [](const Field& f) { return isMappable(f.type); });
    return t.kind == Kind::Named ? t.declaration->kind == DKind::Enum
                                 : factsOf(t).isNumeric && t.kind != Kind::Void;
}

void addValue(std::vector<Word>& words, const Type& t, const std::string& name,
              const std::string& c, bool isOut, unsigned exception) {
    if (t.kind == Kind::Named && t.declaration->kind == DKind::Struct) {
        std::string object = c[0] == '*' ? c.substr(1) + "->" : c + ".";
        for (const Field& f : t.declaration->fields)
            addValue(words, f.type, name + "_" + snakeCase(f.name),
                     object + cMember(*t.declaration, f), isOut, exception);
        return;
    }
    unsigned width = scalarWidth(t);
    for (unsigned lsb = 0; lsb < width; lsb += 32)
        addPiece(
            words,
            {t, name, c, 0, std::min(width, 32u), lsb, width, exception, false, false, 0, 0, 0},
            isOut);
}

} // namespace hw
