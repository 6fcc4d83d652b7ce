// SPDX-License-Identifier: MIT
//
// parser: turns tokens into the declarations of a unit, every name resolved. It reports errors and
// goes on.

#pragma once

#include "front/ast.h"
#include "front/lexer.h"
#include "front/names.h"

// "struct"; "int", "::M::I*"
const char* kindName(Declaration::Kind kind);
std::string typeName(const Type& type);

// `mainFile` is the file on the command line; declarations of others are marked fromInclude.
Unit parse(const std::vector<Token>& tokens, const std::string& mainFile, NameRules rules,
           Diagnostics& diagnostics);
