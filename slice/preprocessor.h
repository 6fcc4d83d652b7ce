// SPDX-License-Identifier: MIT
//
// preprocessor: libmcpp, as ZeroC's own compilers use it.

#ifndef PREPROCESSOR_H
#define PREPROCESSOR_H

#include <string>
#include <vector>

struct Preprocessed {
    bool ok = false;
    std::string text, messages;
    std::vector<std::string> dependencies; // files that were read
};

// `options`: -I, -D and -U as on the command line.
Preprocessed preprocess(const std::string& file, const std::vector<std::string>& options);

#endif
