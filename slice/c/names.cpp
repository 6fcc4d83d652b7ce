// SPDX-License-Identifier: MIT
//
// names: converts Slice names to C names.

#include "c/context.h"
#include <cstdio>
#include <cstdlib>
#include <unordered_set>

bool isRuntimeName(const std::string& c) {
    static const std::unordered_set<std::string> names = {
#include "runtime_names.inc"
    };
    return (c[0] | ' ') == 'i' && names.count(c);
}

std::string cName(const Declaration& d) {
    std::string s;
    for (const std::string& module : d.scope)
        s += module + "_";
    s += d.name;
    return isRuntimeName(s) && !isRuntimeType(d) ? s + "_" : s;
}

std::string cProxy(const Declaration& d) {
    return cName(d.ofClass ? *d.ofClass : d) + "Prx";
}

std::string cIdentifier(const std::string& name) {
    static const std::unordered_set<std::string> reserved = {
        // C90, C99
        "auto", "break", "case", "char", "const", "continue", "default", "do", "double", "else",
        "enum", "extern", "float", "for", "goto", "if", "inline", "int", "long", "register",
        "restrict", "return", "short", "signed", "sizeof", "static", "struct", "switch", "typedef",
        "union", "unsigned", "void", "volatile", "while",
        // keywords of C++, because C++ programs may include the header
        "alignas", "alignof", "and", "and_eq", "asm", "bitand", "bitor", "bool", "catch",
        "char16_t", "char32_t", "char8_t", "class", "co_await", "co_return", "co_yield", "compl",
        "concept", "const_cast", "consteval", "constexpr", "constinit", "decltype", "delete",
        "dynamic_cast", "explicit", "export", "false", "friend", "mutable", "namespace", "new",
        "noexcept", "not", "not_eq", "nullptr", "operator", "or", "or_eq", "private", "protected",
        "public", "reinterpret_cast", "requires", "static_assert", "static_cast", "template",
        "this", "thread_local", "throw", "true", "try", "typeid", "typename", "using", "virtual",
        "wchar_t", "xor", "xor_eq",
        // macros of the C library and of compilers
        "assert", "errno", "offsetof", "stderr", "stdin", "stdout", "va_arg", "va_end", "va_start",
        "EOF", "NULL", "linux", "unix",
        // functions that generated functions call
        "hwStatus", "memcpy", "memset",
        // parameters and variables of generated functions
        "call", "current", "ex", "is", "os", "reply", "result", "self", "status"};
    bool isOurs = false;
    for (const char* prefix : {"ice_", "Ice_", "ICE_", "hw_", "Hw_", "HW_"})
        isOurs = isOurs || name.rfind(prefix, 0) == 0;
    return isOurs || reserved.count(name) ? name + "_" : name;
}

std::string cMember(const Declaration& d, const Field& member) {
    bool isTaken = d.base() && member.name == "base";
    for (const Field& f : d.fields)
        isTaken = isTaken || (f.isOptional && member.name == "has_" + f.name);
    return isTaken ? member.name + "_" : cIdentifier(member.name);
}

std::string cParameter(const Operation& o, const Field& parameter) {
    static const std::unordered_set<std::string> ofAsync = {"completed", "context", "done"};
    const std::string& name = parameter.name;
    bool isTaken = o.isResultOptional && name == "has_result";
    if (parameter.isOut)
        isTaken = isTaken || ofAsync.count(name) || (!o.throws.empty() && name == "exception");
    for (const Field& p : o.parameters)
        isTaken = isTaken || (p.isOptional && name == "has_" + cIdentifier(p.name));
    return isTaken ? name + "_" : cIdentifier(name);
}

std::string cOperation(const std::string& name) {
    static const std::unordered_set<std::string> reserved = {
        "Operations", "checkedCast", "declared", "init", "initWith", "uncheckedCast"};
    return reserved.count(name) || name.rfind("ice_", 0) == 0 ? name + "_" : name;
}

std::string cType(const Type& t) {
    static const char* const basic[] = {"void",      "Ice_Bool",   "Ice_Byte",
                                        "Ice_Short", "Ice_Int",    "Ice_Long",
                                        "Ice_Float", "Ice_Double", "Ice_String"};
    using Kind = Type::Kind;
    if (t.kind <= Kind::String)
        return basic[static_cast<int>(t.kind)];
    if (t.kind == Kind::Proxy)
        return t.declaration ? cProxy(*t.declaration) : "Ice_ObjectPrx";
    if (t.kind != Kind::Named)
        return "Ice_Value *";
    return cName(*t.declaration) + (t.declaration->kind == Declaration::Kind::Class ? " *" : "");
}

std::string cEnumerator(const Declaration& owner, const std::string& name) {
    std::string prefix = cName(owner);
    if (!hasMetadata(owner.metadata, "c:scoped"))
        prefix.resize(prefix.rfind(owner.name));
    else
        prefix += "_";
    return prefix + name;
}

std::string cFileName(const CFileNames& names, const std::string& what) {
    auto isDigit = [](char ch) { return ch >= '0' && ch <= '9'; };
    auto isLetter = [](char ch) { return (ch >= 'A' && ch <= 'Z') || (ch >= 'a' && ch <= 'z'); };
    std::string s = isDigit(names.path[0]) ? "Slice_" : "";
    for (char ch : names.path.substr(0, names.path.rfind('.')))
        s += isDigit(ch) || isLetter(ch) ? ch : '_';
    return s + what;
}

// Returns the bytes as a C string literal, with escape sequences where necessary.
static std::string cString(const std::string& bytes) {
    std::string s = "\"";
    for (char c : bytes) {
        auto u = static_cast<unsigned char>(c);
        char octal[8];
        std::snprintf(octal, sizeof octal, "\\%03o", u);
        if (c == '"' || c == '\\')
            s += '\\', s += c;
        else if (u < 32 || u > 126 || c == '?') // no trigraphs
            s += octal;
        else
            s += c;
    }
    return s + '"';
}

std::string cValue(const Literal& v, const Type& type) {
    char text[80];
    switch (v.kind) {
    case Literal::Kind::None:
        break;
    case Literal::Kind::Bool:
        return v.integer ? "1" : "0";
    case Literal::Kind::Enumerator:
        return cEnumerator(*v.owner, v.text);
    case Literal::Kind::String:
        return cString(v.text);
    case Literal::Kind::Floating:
        std::snprintf(text, sizeof text, "%.17g", v.floating);
        return std::string(text) +
               (std::string(text).find_first_of(".en") == std::string::npos ? ".0" : "");
    case Literal::Kind::Integer:
        if (type.kind == Type::Kind::Long) {
            auto bits = static_cast<uint64_t>(v.integer);
            int64_t high = v.integer >> 32;
            std::snprintf(text, sizeof text, "{0x%lXU, %s}",
                          static_cast<unsigned long>(bits & 0xFFFFFFFFU),
                          high == INT32_MIN ? "-2147483647 - 1" : std::to_string(high).c_str());
            return text;
        }
        return v.integer == INT32_MIN ? "-2147483647 - 1" : std::to_string(v.integer);
    }
    return "0";
}

bool isRuntimeType(const Declaration& d) {
    return d.id() == "::Ice::Identity";
}

int statedMaximum(const Declaration& d) {
    return std::atoi(metadataValue(d.metadata, "c:max").c_str());
}
