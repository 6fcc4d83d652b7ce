// SPDX-License-Identifier: MIT
//
// diagnostics: prints errors and warnings.

#include "front/ast.h"
#include <fstream>

void Diagnostics::error(const Location& at, const std::string& text) {
    // limit of the errors that are printed for one file
    if (++errors_ <= 100)
        print(at, "error", text);
}

void Diagnostics::warning(const Location& at, const std::string& text, Category category) {
    if (!suppressed_.count({at.file, General}) && !suppressed_.count({at.file, category}))
        print(at, "warning", text);
}

std::string_view Diagnostics::intern(std::string_view text) {
    auto it = names_.find(text);
    return it != names_.end() ? *it : *names_.insert(std::string(text)).first;
}

const std::vector<std::string>& Diagnostics::lines(std::string_view file) {
    auto [it, isNew] = files_.try_emplace(file);
    if (isNew) {
        std::ifstream in{std::string(file)};
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
