// SPDX-License-Identifier: MIT
//
// compiler: one Slice file from text to its unit, without a command line and without a file system.

#ifndef COMPILER_H
#define COMPILER_H

#include "ast.h"
#include "names.h"

// The unit of a preprocessed file; errors are in `diagnostics`.
Unit compileUnit(const std::string& text, const std::string& file, NameRules rules,
                 Diagnostics& diagnostics);
// Behind each class that can be called, an interface that holds its operations; a part of
// compileUnit.
void addClassInterfaces(Unit& unit);

#endif
