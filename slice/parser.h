// SPDX-License-Identifier: MIT
//
// parser: tokens into declarations. After an error it goes on at the next declaration.

#ifndef PARSER_H
#define PARSER_H

#include "ast.h"
#include "lexer.h"

// `mainFile`: declarations of other files are marked as coming from an include.
Unit parse(const std::vector<Token>& tokens, const std::string& mainFile, Diagnostics& diagnostics);

#endif
