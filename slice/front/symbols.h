// SPDX-License-Identifier: MIT
//
// symbols: Slice's keywords, the identifiers that Slice allows, and the table of declared names.
// Slice forbids names that differ in capitals only, so the table ignores capitals and compares them
// itself.

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
    Declaration* declaration = nullptr; // the declaration; an enumerator's enum
    size_t enumerator = 0;
};

class Symbols {
public:
    explicit Symbols(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    // The symbol with this full name, ignoring capitals.
    Symbol* find(const std::string& id);
    // Declares `name` in `scope` ("" or "::A::B"): a new symbol, or the existing one. 0: an error
    // was reported.
    Symbol* declare(const std::string& scope, const std::string& name, const Location& at,
                    bool& isNew);
    // Finds the meaning of `written` in `scope`, from the inside out; returns 0 if none.
    // `user`, a module or a type, must not give the name another meaning later.
    Symbol* resolve(const std::string& scope, const std::string& written, const Location& at,
                    const std::string& user);
    // The same for any capitals, and without a user.
    Symbol* innermost(const std::string& scope, const std::string& written);
    // True if `user` has used the name for something else before; reports an error.
    bool hasChanged(const std::string& user, const std::string& name, const Location& at);
    // Enumerators with this name of any enum in the scope, or around it: Ice still allows them
    // without their enum.
    void declareBare(const std::string& scope, const std::string& name, Symbol* enumerator);
    const std::vector<Symbol*>& bare(const std::string& scope, const std::string& name) const;

private:
    Diagnostics& diagnostics_;
    std::unordered_map<std::string, Symbol> table_; // keyed by the name in lower case
    std::unordered_map<std::string, std::vector<Symbol*>> bare_;
    std::unordered_map<std::string, std::string>
        used_; // first components used in a scope, with their meaning
};
