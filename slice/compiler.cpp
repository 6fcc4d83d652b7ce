// SPDX-License-Identifier: MIT
//
// compiler: lexer, parser, checks, generator, one after the other.

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

std::optional<std::vector<GeneratedFile>> compileToC(const std::string& text,
                                                     const std::string& file, NameRules rules,
                                                     const CFileNames& names,
                                                     Diagnostics& diagnostics) {
    Unit unit = compileUnit(text, file, rules, diagnostics);
    if (diagnostics.errors() == 0)
        checkC(unit, diagnostics);
    if (diagnostics.errors())
        return std::nullopt;
    return generateC(unit, names);
}
