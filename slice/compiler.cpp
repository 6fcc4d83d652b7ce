// SPDX-License-Identifier: MIT
//
// compiler: lexer and parser, then what the checks and the generators expect to be there.

#include "compiler.h"
#include "lexer.h"
#include "parser.h"

Unit compileUnit(const std::string& text, const std::string& file, NameRules rules,
                 Diagnostics& diagnostics) {
    Unit unit = parse(tokenize(text, file, diagnostics), file, rules, diagnostics);
    if (diagnostics.errors() == 0)
        addClassInterfaces(unit);
    return unit;
}
