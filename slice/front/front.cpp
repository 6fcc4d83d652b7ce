// SPDX-License-Identifier: MIT
//
// front: the steps from text to unit, one after the other.

#include "front/front.h"
#include "front/lexer.h"
#include "front/parser.h"

Unit compileUnit(const std::string& text, const std::string& file, NameRules rules,
                 Diagnostics& diagnostics) {
    Unit unit = parse(tokenize(text, file, diagnostics), file, rules, diagnostics);
    if (diagnostics.errors() == 0)
        addClassInterfaces(unit);
    return unit;
}
