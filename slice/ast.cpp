// SPDX-License-Identifier: MIT
//
// ast: names and relations of declarations.

#include "ast.h"
#include <algorithm>

std::string Declaration::cName() const {
    std::string s;
    for (const std::string& module : scope)
        s += module + "_";
    return s + name;
}

std::string Declaration::id() const {
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
    return this == &other || std::any_of(bases.begin(), bases.end(), [&](const Declaration* b) {
               return b->isA(other);
           });
}

bool hasMetadata(const std::vector<std::string>& metadata, const std::string& directive) {
    return std::find(metadata.begin(), metadata.end(), directive) != metadata.end();
}

std::string metadataValue(const std::vector<std::string>& metadata, const std::string& prefix) {
    for (const std::string& m : metadata)
        if (m.size() > prefix.size() && m.compare(0, prefix.size(), prefix) == 0 && m[prefix.size()] == ':')
            return m.substr(prefix.size() + 1);
    return "";
}
