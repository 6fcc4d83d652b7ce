// SPDX-License-Identifier: MIT
//
// ast: names and relations of declarations.

#include "front/ast.h"
#include <algorithm>

std::string Declaration::id() const {
    if (ofClass)
        return ofClass->id();
    std::string s;
    for (const std::string& module : scope)
        s += "::" + module;
    return s + "::" + name;
}

bool Declaration::hasMetadata(const std::string& directive) const {
    return ::hasMetadata(metadata, directive);
}

std::string Declaration::metadataValue(const std::string& prefix) const {
    return ::metadataValue(metadata, prefix);
}

bool Declaration::isA(const Declaration& other) const {
    return this == &other || std::any_of(bases.begin(), bases.end(),
                                         [&](const Declaration* b) { return b->isA(other); });
}

Declaration::Facts factsOf(const Type& type) {
    using Kind = Type::Kind;
    Declaration::Facts f;
    f.isVariable = false;
    f.isKey = type.kind != Kind::Float && type.kind != Kind::Double;
    switch (type.kind) {
    case Kind::Void:
    case Kind::Bool:
    case Kind::Byte:
        break;
    case Kind::Short:
        f.leastWireSize = 2;
        break;
    case Kind::Int:
    case Kind::Float:
        f.leastWireSize = 4;
        break;
    case Kind::Long:
    case Kind::Double:
        f.leastWireSize = 8;
        break;
    case Kind::String:
        f.isVariable = true;
        f.isNumeric = false;
        break;
    case Kind::Proxy:
        f.leastWireSize = 2;
        f.isVariable = true;
        f.isNumeric = f.isKey = false;
        break;
    case Kind::Value:
    case Kind::LocalObject:
        f.isVariable = f.hasClass = true;
        f.isNumeric = f.isKey = false;
        break;
    case Kind::Named:
        return type.declaration->facts;
    }
    return f;
}

void Declaration::complete() {
    auto join = [&](const Type& type) {
        Facts f = factsOf(type);
        // The bound keeps sums small; no message reaches this size.
        facts.leastWireSize = std::min(facts.leastWireSize + f.leastWireSize, 1000000);
        facts.isVariable |= f.isVariable;
        facts.hasClass |= f.hasClass;
        facts.hasSequence |= f.hasSequence;
        facts.isKey &= f.isKey;
        facts.isNumeric &= f.isNumeric;
    };
    facts = Facts();
    switch (kind) {
    case Kind::Enum:
        facts.isKey = true;
        break;
    case Kind::Struct:
        facts.leastWireSize = 0;
        facts.isVariable = false;
        facts.isKey = true;
        for (const Field& f : fields)
            join(f.type);
        break;
    case Kind::Sequence:
        facts.isKey = facts.hasSequence = true;
        join(element);
        facts.leastWireSize = 1;
        break;
    case Kind::Dictionary:
        join(key);
        join(element);
        facts.leastWireSize = 1;
        facts.isNumeric = facts.isKey = false;
        break;
    default: // a class, as a type
        facts.hasClass = true;
        facts.isNumeric = false;
    }
}

bool hasMetadata(const std::vector<std::string>& metadata, const std::string& directive) {
    return std::find(metadata.begin(), metadata.end(), directive) != metadata.end();
}

std::string metadataValue(const std::vector<std::string>& metadata, const std::string& prefix) {
    for (const std::string& m : metadata)
        if (m.size() > prefix.size() && m.compare(0, prefix.size(), prefix) == 0 &&
            m[prefix.size()] == ':')
            return m.substr(prefix.size() + 1);
    return "";
}
