// SPDX-License-Identifier: MIT
//
// lexer: turns preprocessed Slice text into tokens, with their places in the original files.

#pragma once

#include "front/diagnostics.h"
#include <string_view>
#include <vector>

struct Token {
    enum class Kind { Identifier, Integer, Float, String, Symbol, End };
    Kind kind;
    std::string_view text; // as written; of a string, the text between the quotes
    std::string_view doc;  // the doc comment before it, without /** and */
    std::string comment;   // lines of // that stand directly above it
    Location at;
    bool escaped; // identifier written with a backslash
};

// Tokens point into `text`. The last one is End.
std::vector<Token> tokenize(std::string_view text, std::string_view file, Diagnostics& diagnostics);
