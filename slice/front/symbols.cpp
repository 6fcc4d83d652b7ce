// SPDX-License-Identifier: MIT
//
// symbols: implements the rules for names of Ice 3.7's scanner, and looks names up by Slice's
// scoping rules.

#include "front/symbols.h"

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

Symbol* Symbols::find(const std::string& id) {
    auto it = table_.find(lowerCase(id));
    return it == table_.end() ? nullptr : &it->second;
}

Symbol* Symbols::declare(const std::string& scope, const std::string& name, const Location& at,
                         bool& isNew) {
    std::string id = scope + "::" + name, key = lowerCase(id);
    if (hasChanged(scope, name, at))
        return nullptr;
    auto [it, inserted] = table_.try_emplace(key);
    isNew = inserted;
    Symbol& symbol = it->second;
    if (isNew) {
        symbol.id = id;
        symbol.at = at;
    } else if (symbol.id != id) {
        diagnostics_.error(at, "'" + name + "' differs in capitals only from '" + symbol.id +
                                   "', line " + std::to_string(symbol.at.line));
        return nullptr;
    }
    return &symbol;
}

bool Symbols::hasChanged(const std::string& user, const std::string& name, const Location& at) {
    std::string key = lowerCase(user + "::" + name);
    auto used = used_.find(key);
    if (used == used_.end() || used->second == key)
        return false;
    diagnostics_.error(at, "'" + name + "' has changed meaning: it was used as '" + used->second +
                               "' in this scope before");
    return true;
}

Symbol* Symbols::resolve(const std::string& scope, const std::string& written, const Location& at,
                         const std::string& user) {
    bool absolute = written.compare(0, 2, "::") == 0;
    std::string inner = absolute ? "" : scope;
    for (;;) {
        std::string id = absolute ? written : inner + "::" + written;
        if (Symbol* s = find(id)) {
            if (s->id != id)
                diagnostics_.error(at, "'" + written + "' is written with other capitals than '" +
                                           s->id + "', line " + std::to_string(s->at.line));
            if (!absolute) {
                std::string first = lowerCase(written.substr(0, written.find("::")));
                used_.emplace(lowerCase(user) + "::" + first, lowerCase(inner) + "::" + first);
            }
            return s;
        }
        if (absolute || inner.empty())
            return nullptr;
        inner.resize(inner.rfind("::"));
    }
}

Symbol* Symbols::innermost(const std::string& scope, const std::string& written) {
    Symbol* s = find(scope + "::" + written);
    return s || scope.empty() ? s : innermost(scope.substr(0, scope.rfind("::")), written);
}

void Symbols::declareBare(const std::string& scope, const std::string& name, Symbol* enumerator) {
    bare_[scope + "::" + name].push_back(enumerator);
}

const std::vector<Symbol*>& Symbols::bare(const std::string& scope, const std::string& name) const {
    static const std::vector<Symbol*> none;
    auto it = bare_.find(scope + "::" + name);
    if (it != bare_.end())
        return it->second;
    return scope.empty() ? none : bare(scope.substr(0, scope.rfind("::")), name);
}
