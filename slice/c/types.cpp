// SPDX-License-Identifier: MIT
//
// types: maps each type to C.

#include "c/context.h"
#include <algorithm>

namespace {

using Kind = Type::Kind;
using DKind = Declaration::Kind;

bool isNamed(const Type& t, DKind kind) {
    return t.kind == Kind::Named && t.declaration->kind == kind;
}

// Returns the suffix that names a type in Ice_OutputStream_write<suffix> and
// Ice_InputStream_read<suffix>.
std::string streamWord(const Type& t) {
    return cType(t).substr(4);
}

std::string largestEnumerator(const Declaration& d) {
    int64_t largest = 0;
    for (const Enumerator& e : d.enumerators)
        largest = std::max(largest, e.value);
    return std::to_string(largest);
}

// ICE_OPTIONAL_...
std::string optionalFormat(const Type& t) {
    if (t.kind == Kind::String)
        return "VSIZE";
    if (t.kind == Kind::Proxy)
        return "FSIZE";
    if (t.kind < Kind::String)
        return "F" + std::to_string(factsOf(t).leastWireSize);
    if (t.kind != Kind::Named || t.declaration->kind == DKind::Class)
        return "CLASS";
    const Declaration& d = *t.declaration;
    if (d.kind == DKind::Enum)
        return "SIZE";
    bool varies = d.kind == DKind::Struct ? factsOf(t).isVariable : factsOf(d.element).isVariable;
    return varies || (d.kind == DKind::Dictionary && factsOf(d.key).isVariable) ? "FSIZE" : "VSIZE";
}

// Returns the C expression for the size that precedes an optional value of format VSIZE. Returns an
// empty string if the value itself begins with its size.
std::string sizeBefore(const Slot& s) {
    const Type& t = *s.type;
    if (optionalFormat(t) != "VSIZE" || t.kind == Kind::String)
        return "";
    if (t.declaration->kind == DKind::Struct)
        return std::to_string(factsOf(t).leastWireSize);
    int each = factsOf(t.declaration->element).leastWireSize;
    if (t.declaration->kind == DKind::Dictionary)
        each += factsOf(t.declaration->key).leastWireSize;
    if (each == 1)
        return "";
    std::string count = s.value[0] == '*' ? s.pointer + "->size" : s.value + ".size";
    return std::to_string(each) + " * " + count + " + (" + count + " > 254 ? 5 : 1)";
}

} // namespace

bool isEnum(const Type& t) {
    return isNamed(t, DKind::Enum);
}

bool isClass(const Type& t) {
    return t.kind == Kind::Value || t.kind == Kind::LocalObject || isNamed(t, DKind::Class);
}

bool isByPointer(const Type& t) {
    return t.kind == Kind::Proxy || (t.kind == Kind::Named && !isEnum(t) && !isClass(t));
}

std::string cVariable(const Type& t, const std::string& name) {
    std::string type = cType(t);
    return type.back() == '*' ? type + name : type + " " + name;
}

namespace {

std::string writeStatement(const Type& t, const std::string& value, const std::string& pointer) {
    if (isEnum(t))
        return "Ice_OutputStream_writeEnum(os, (Ice_Int)" + value + ", " +
               largestEnumerator(*t.declaration) + ");";
    if (t.kind == Kind::Proxy)
        return "Ice_OutputStream_writePrx(os, " + pointer + ");";
    if (isClass(t))
        return "Ice_OutputStream_writeValue(os, (const Ice_Value *)" + value + ");";
    if (t.kind == Kind::Named)
        return cType(t) + "_writeToOutputStream(" + pointer + ", os);";
    return "Ice_OutputStream_write" + streamWord(t) + "(os, " + value + ");";
}

std::string readStatement(const Type& t, const std::string& value, const std::string& pointer) {
    if (isEnum(t))
        return value + " = (" + cType(t) + ")Ice_InputStream_readEnum(is, " +
               largestEnumerator(*t.declaration) + ");";
    if (t.kind == Kind::Proxy)
        return "Ice_InputStream_readPrx(is, 0, " + pointer + ");";
    if (isClass(t)) {
        bool any = t.kind != Kind::Named;
        return "Ice_InputStream_readValue(is, " + pointer + ", " +
               (any ? "0" : "&" + cName(*t.declaration) + "_type") + ");";
    }
    if (t.kind == Kind::Named)
        return cType(t) + "_readFromInputStream(" + pointer + ", is);";
    return value + " = Ice_InputStream_read" + streamWord(t) + "(is);";
}

// Returns the slots in the order of the wire: the required slots in their given order, then the
// optional slots by tag.
std::vector<Slot> wireOrder(std::vector<Slot> slots) {
    std::stable_sort(slots.begin(), slots.end(), [](const Slot& a, const Slot& b) {
        if (a.isOptional != b.isOptional)
            return b.isOptional;
        return a.isOptional && a.tag < b.tag;
    });
    return slots;
}

} // namespace

void writeSlots(Writer& w, const std::vector<Slot>& slots) {
    for (const Slot& s : wireOrder(slots)) {
        std::string statement = writeStatement(*s.type, s.value, s.pointer);
        if (!s.isOptional) {
            w.line(statement);
            continue;
        }
        std::string format = optionalFormat(*s.type), size = sizeBefore(s);
        std::string condition = "if (" + s.has + " && Ice_OutputStream_writeOptional(os, " +
                                std::to_string(s.tag) + ", ICE_OPTIONAL_" + format + "))";
        if (format == "FSIZE") {
            w.block(condition, {}, [&] {
                w.line("Ice_Int ice_at = Ice_OutputStream_startSize(os);");
                w.line(statement);
                w.line("Ice_OutputStream_endSize(os, ice_at);");
            });
        } else if (!size.empty()) {
            w.block(condition, {}, [&] {
                w.line("Ice_OutputStream_writeSize(os, " + size + ");");
                w.line(statement);
            });
        } else {
            w.line(condition);
            w.nested(statement);
        }
    }
}

void readSlots(Writer& w, const std::vector<Slot>& slots) {
    for (const Slot& s : wireOrder(slots)) {
        std::string statement = readStatement(*s.type, s.value, s.pointer);
        if (!s.isOptional) {
            w.line(statement);
            continue;
        }
        std::string format = optionalFormat(*s.type);
        w.line(s.has + " = Ice_InputStream_readOptional(is, " + std::to_string(s.tag) +
               ", ICE_OPTIONAL_" + format + ");");
        std::string skip = format == "FSIZE" ? "(void)Ice_InputStream_readInt(is); /* the size */"
                           : !sizeBefore(s).empty() ? "(void)Ice_InputStream_readSize(is);"
                                                    : "";
        if (skip.empty()) {
            w.single("if (" + s.has + ")", statement);
        } else {
            w.block("if (" + s.has + ")", {}, [&] {
                w.line(skip);
                w.line(statement);
            });
        }
    }
}
