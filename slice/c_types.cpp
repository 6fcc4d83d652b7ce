// SPDX-License-Identifier: MIT
//
// c_types: the mapping, type by type.

#include "c_types.h"
#include <algorithm>
#include <set>

namespace {

using Kind = Type::Kind;

bool isEnum(const Type& t) {
    return t.kind == Kind::Named && t.declaration->kind == Declaration::Kind::Enum;
}

// Names of the run time's functions: Ice_OutputStream_write<word>.
std::string streamWord(Kind kind) {
    switch (kind) {
    case Kind::Bool: return "Bool";
    case Kind::Byte: return "Byte";
    case Kind::Short: return "Short";
    case Kind::Int: return "Int";
    case Kind::Long: return "Long";
    case Kind::Float: return "Float";
    case Kind::Double: return "Double";
    case Kind::String: return "String";
    default: return "";
    }
}

} // namespace

std::string cIdentifier(const std::string& name) {
    static const std::set<std::string> reserved = {
        "auto",   "break",    "case",     "char",   "const",    "continue", "default", "do",
        "double", "else",     "enum",     "extern", "float",    "for",      "goto",    "if",
        "int",    "long",     "register", "return", "short",    "signed",   "sizeof",  "static",
        "struct", "switch",   "typedef",  "union",  "unsigned", "void",     "volatile", "while",
        // of the generated functions themselves
        "self", "current", "is", "os", "status"};
    return reserved.count(name) ? name + "_" : name;
}

bool isByPointer(const Type& t) {
    return t.kind == Kind::Proxy || (t.kind == Kind::Named && !isEnum(t));
}

std::string cType(const Type& t) {
    if (t.kind == Kind::Named)
        return t.declaration->cName();
    if (t.kind == Kind::Proxy)
        return t.declaration ? t.declaration->cName() + "Prx" : "Ice_ObjectPrx";
    return "Ice_" + streamWord(t.kind);
}

std::string cInParameter(const Type& t, const std::string& name) {
    if (isByPointer(t))
        return "const " + cType(t) + " *" + name;
    return cType(t) + " " + name;
}

std::string cOutParameter(const Type& t, const std::string& name) { return cType(t) + " *" + name; }

std::string asInArgument(const Type& t, const std::string& variable) {
    return isByPointer(t) ? "&" + variable : variable;
}

int64_t largestEnumerator(const Declaration& d) {
    int64_t largest = 0;
    for (const Enumerator& e : d.enumerators)
        largest = std::max(largest, e.value);
    return largest;
}

std::string writeStatement(const Type& t, const std::string& expression) {
    if (isEnum(t))
        return "Ice_OutputStream_writeEnum(os, (Ice_Int)" + expression + ", " +
               std::to_string(largestEnumerator(*t.declaration)) + ");";
    if (t.kind == Kind::Proxy)
        return "Ice_OutputStream_writePrx(os, " + expression + ");";
    if (t.kind == Kind::Named)
        return cType(t) + "_writeToOutputStream(" + expression + ", os);";
    return "Ice_OutputStream_write" + streamWord(t.kind) + "(os, " + expression + ");";
}

std::string readStatement(const Type& t, const std::string& object, const std::string& communicator) {
    if (isEnum(t))
        return object + " = (" + cType(t) + ")Ice_InputStream_readEnum(is, " +
               std::to_string(largestEnumerator(*t.declaration)) + ");";
    if (t.kind == Kind::Proxy)
        return "Ice_InputStream_readPrx(is, " + communicator + ", &" + object + ");";
    if (t.kind == Kind::Named)
        return cType(t) + "_readFromInputStream(&" + object + ", is);";
    return object + " = Ice_InputStream_read" + streamWord(t.kind) + "(is);";
}

int leastWireSize(const Type& t) {
    switch (t.kind) {
    case Kind::Short: return 2;
    case Kind::Int:
    case Kind::Float: return 4;
    case Kind::Long:
    case Kind::Double: return 8;
    case Kind::Proxy: return 2;
    case Kind::Named:
        if (t.declaration->kind == Declaration::Kind::Struct) {
            int sum = 0;
            for (const Field& f : t.declaration->fields)
                sum += leastWireSize(f.type);
            return sum;
        }
        return 1;
    default: return 1;
    }
}

bool containsProxy(const Type& t) {
    if (t.kind == Kind::Proxy)
        return true;
    if (t.kind != Kind::Named)
        return false;
    if (t.declaration->kind == Declaration::Kind::Sequence)
        return containsProxy(t.declaration->element);
    return std::any_of(t.declaration->fields.begin(), t.declaration->fields.end(),
                       [](const Field& f) { return containsProxy(f.type); });
}
