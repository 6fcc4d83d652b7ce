// SPDX-License-Identifier: MIT
//
// hw_words: scalars into words, words into the slot.

#include "hw_words.h"
#include "c_names.h"
#include <algorithm>
#include <cctype>

namespace hw {
namespace {

using Kind = Type::Kind;
using DKind = Declaration::Kind;

unsigned enumWidth(const Declaration& d) {
    int64_t largest = 0;
    for (const Enumerator& e : d.enumerators)
        largest = std::max(largest, e.value);
    unsigned width = 1;
    while (largest >> width)
        ++width;
    return width;
}

unsigned scalarWidth(const Type& t) {
    switch (t.kind) {
    case Kind::Bool:
        return 1;
    case Kind::Byte:
        return 8;
    case Kind::Short:
        return 16;
    case Kind::Int:
    case Kind::Float:
        return 32;
    case Kind::Long:
    case Kind::Double:
        return 64;
    default:
        return enumWidth(*t.declaration);
    }
}

void addPiece(std::vector<Word>& words, Piece piece, bool isOut) {
    bool fits =
        !words.empty() && words.back().isOut == isOut && words.back().width() + piece.width <= 32;
    if (!fits)
        words.push_back({0, "", isOut, {}});
    else
        piece.lsb = words.back().width();
    words.back().pieces.push_back(piece);
}

} // namespace

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

bool isMappable(const Type& t) {
    if (t.kind == Kind::Named && t.declaration->kind == DKind::Struct)
        return std::all_of(t.declaration->fields.begin(), t.declaration->fields.end(),
                           [](const Field& f) { return isMappable(f.type); });
    return t.kind == Kind::Named ? t.declaration->kind == DKind::Enum
                                 : factsOf(t).isNumeric && t.kind != Kind::Void;
}

void addValue(std::vector<Word>& words, const Type& t, const std::string& name,
              const std::string& c, bool isOut) {
    if (t.kind == Kind::Named && t.declaration->kind == DKind::Struct) {
        std::string object = c[0] == '*' ? c.substr(1) + "->" : c + ".";
        for (const Field& f : t.declaration->fields)
            addValue(words, f.type, name + "_" + snakeCase(f.name), object + cIdentifier(f.name),
                     isOut);
        return;
    }
    unsigned width = scalarWidth(t);
    for (unsigned lsb = 0; lsb < width; lsb += 32)
        addPiece(words, {t, name, c, 0, std::min(width, 32u), lsb, width}, isOut);
}

} // namespace hw
