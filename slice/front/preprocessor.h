// SPDX-License-Identifier: MIT
//
// preprocessor: #include, #define and #if by libmcpp.

#pragma once

#include <string>
#include <vector>

struct Preprocessed {
    bool ok = false;
    std::string text;                  // with #line markers and comments
    std::string messages;              // the preprocessor's own
    std::vector<std::string> files;    // the file and all that it includes, at any depth
    std::vector<std::string> includes; // those that it includes directly
};

// `options`: -I, -D, -U as for the C preprocessor.
Preprocessed preprocess(const std::string& file, const std::vector<std::string>& options);
