// SPDX-License-Identifier: MIT
//
// symbols: the table of declared names, with Slice's keywords and rules for identifiers. Slice
// forbids two names that differ only in capitals. The table therefore ignores capitals in a search,
// and then compares the capitals of the name that it found.

#pragma once

#include "front/ast.h"
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

struct NameRules {
    bool underscore = false; // underscores are allowed
    bool icePrefix = false;  // names may begin with "ice"
};

bool isKeyword(std::string_view word);

// Reports errors in the name of a declaration.
void checkName(std::string_view name, const NameRules& rules, const Location& at,
               Diagnostics& diagnostics);

std::string lowerCase(std::string_view text);

struct Symbol {
    enum class Kind { Module, Declaration, Enumerator };
    Kind kind = Kind::Module;
    std::string id; // "::A::B"
    Location at;
    Declaration* declaration = nullptr; // the declared definition; for an enumerator, its enum
    size_t enumerator = 0;
};

class Symbols {
public:
    explicit Symbols(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    // Returns the symbol with this full name. Ignores the case of letters.
    Symbol* find(const std::string& id);
    // Declares `name` in `scope` ("" or "::A::B"). Returns the new or the already existing symbol,
    // or 0 after it has reported an error.
    Symbol* declare(const std::string& scope, const std::string& name, const Location& at,
                    bool& isNew);
    // Searches `scope`, then the enclosing scopes, for the symbol to which `written` refers;
    // returns 0 if no such symbol exists. Records the meaning for `user`, a module or type:
    // later, `user` must not use the same name with another meaning.
    Symbol* resolve(const std::string& scope, const std::string& written, const Location& at,
                    const std::string& user);
    // Searches as resolve does, but ignores the case of letters and records nothing.
    Symbol* innermost(const std::string& scope, const std::string& written);
    // Returns true, and reports an error, if `user` has used the name with another meaning before.
    bool hasChanged(const std::string& user, const std::string& name, const Location& at);
    // Functions for enumerators that are written without the name of their enum, which Ice still
    // allows. declareBare adds an enumerator to `scope` and its enclosing scopes; bare returns the
    // enumerators of this name that are visible in `scope`.
    void declareBare(const std::string& scope, const std::string& name, Symbol* enumerator);
    const std::vector<Symbol*>& bare(const std::string& scope, const std::string& name) const;

private:
    Diagnostics& diagnostics_;
    std::unordered_map<std::string, Symbol> table_; // keyed by the name in lower case
    std::unordered_map<std::string, std::vector<Symbol*>> bare_;
    std::unordered_map<std::string, std::string>
        used_; // meaning of the first component of each name that a scope has used
};
