// SPDX-License-Identifier: MIT
//
// names: the rules of Ice 3.7's scanner.

#include "front/names.h"
#include <string>

namespace {

constexpr std::string_view keywords[] = {
    "module", "class",   "interface",  "exception",  "struct",   "sequence", "dictionary",  "enum",
    "out",    "extends", "implements", "throws",     "void",     "byte",     "bool",        "short",
    "int",    "long",    "float",      "double",     "string",   "Object",   "LocalObject", "local",
    "const",  "false",   "true",       "idempotent", "optional", "Value"};

} // namespace

std::string lowerCase(std::string_view text) {
    std::string s(text);
    for (char& c : s)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    return s;
}

bool isKeyword(std::string_view word) {
    for (std::string_view k : keywords)
        if (k == word)
            return true;
    return false;
}

void checkName(std::string_view name, const NameRules& rules, const Location& at,
               Diagnostics& diagnostics) {
    std::string quoted = "'" + std::string(name) + "'";
    for (std::string_view suffix : {"Helper", "Holder", "Prx", "Ptr"})
        if (name.size() >= suffix.size() && name.substr(name.size() - suffix.size()) == suffix)
            diagnostics.error(at, "identifier " + quoted + ": the suffix '" + std::string(suffix) +
                                      "' is reserved");
    if (name.front() == '_')
        diagnostics.error(at, "identifier " + quoted + " begins with an underscore");
    else if (name.back() == '_')
        diagnostics.error(at, "identifier " + quoted + " ends with an underscore");
    else if (name.find("__") != std::string_view::npos)
        diagnostics.error(at, "identifier " + quoted + " has two underscores in a row");
    else if (name.find('_') != std::string_view::npos && !rules.underscore)
        diagnostics.error(
            at, "identifier " + quoted +
                    " has an underscore; allow them with [[\"underscore\"]] or --underscore");
    if (lowerCase(name.substr(0, 3)) == "ice" && !rules.icePrefix)
        diagnostics.error(at, "identifier " + quoted + ": the prefix '" +
                                  std::string(name.substr(0, 3)) +
                                  "' is reserved; allow it with [[\"ice-prefix\"]] or --ice");
}
