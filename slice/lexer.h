// SPDX-License-Identifier: MIT
//
// lexer: preprocessed Slice into tokens; line markers give each its place in the source.

#ifndef LEXER_H
#define LEXER_H

#include "diagnostics.h"
#include <string>
#include <vector>

struct Token {
    enum class Kind { Identifier, Integer, Float, String, Symbol, End };
    Kind kind = Kind::End;
    std::string text;
    std::string doc; // the doc comment before it
    Location at;
    bool escaped = false; // \identifier: never a keyword
};

std::vector<Token> tokenize(const std::string& text, const std::string& file,
                            Diagnostics& diagnostics);

#endif
