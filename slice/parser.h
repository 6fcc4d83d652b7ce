// SPDX-License-Identifier: MIT
//
// parser: tokens into the declarations of a unit, every name resolved; errors are said, and passed.

#ifndef PARSER_H
#define PARSER_H

#include "ast.h"
#include "lexer.h"
#include "names.h"

// "struct"; "int", "::M::I*"
const char* kindName(Declaration::Kind kind);
std::string typeName(const Type& type);

// `mainFile` is the file on the command line; what comes from others is marked fromInclude.
Unit parse(const std::vector<Token>& tokens, const std::string& mainFile, NameRules rules,
           Diagnostics& diagnostics);

#endif
