// SPDX-License-Identifier: MIT
//
// ast: computes names and relations of declarations.

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

bool Declaration::isA(const Declaration& other) const {
    return this == &other || std::any_of(bases.begin(), bases.end(),
                                         [&](const Declaration* b) { return b->isA(other); });
}

bool Declaration::preserves() const {
    return hasMetadata(metadata, "preserve-slice") || (base() && base()->preserves());
}

Declaration::Facts factsOf(const Type& type) {
    using Kind = Type::Kind;
    if (type.kind == Kind::Named)
        return type.declaration->facts;
    // smallest size on the wire, bytes, indexed by kind
    static const int sizes[] = {1, 1, 1, 2, 4, 8, 4, 8, 1, 1, 2, 1, 1};
    bool isProxy = type.kind == Kind::Proxy;
    Declaration::Facts f;
    f.leastWireSize = sizes[static_cast<int>(type.kind)];
    f.hasClass = type.kind == Kind::Value || type.kind == Kind::LocalObject;
    f.isVariable = f.hasClass || isProxy || type.kind == Kind::String;
    f.isNumeric = !f.isVariable;
    f.isKey = !f.hasClass && !isProxy && type.kind != Kind::Float && type.kind != Kind::Double;
    return f;
}

void Declaration::complete() {
    auto join = [&](const Type& type) {
        Facts f = factsOf(type);
        // The limit prevents an overflow; no message reaches this size.
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
    default: // a class
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
