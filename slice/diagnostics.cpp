// SPDX-License-Identifier: MIT
//
// diagnostics: printing.

#include "diagnostics.h"
#include <fstream>

const std::vector<std::string>& Diagnostics::lines(const std::string& file) {
    auto [it, isNew] = files_.try_emplace(file);
    if (isNew) {
        std::ifstream in(file);
        for (std::string line; std::getline(in, line);)
            it->second.push_back(line);
    }
    return it->second;
}

void Diagnostics::print(const Location& at, const char* kind, const std::string& text) {
    out_ << at.file << ':' << at.line << ':' << at.column << ": " << kind << ": " << text << '\n';
    const auto& source = lines(at.file);
    if (at.line < 1 || static_cast<size_t>(at.line) > source.size())
        return;
    const std::string& line = source[static_cast<size_t>(at.line) - 1];
    std::string caret;
    for (int i = 1; i < at.column; ++i)
        caret += static_cast<size_t>(i) <= line.size() && line[static_cast<size_t>(i) - 1] == '\t'
                     ? '\t'
                     : ' ';
    out_ << line << '\n' << caret << "^\n";
}
