// SPDX-License-Identifier: MIT
//
// diagnostics: errors and warnings with file, line, column, the source line and a caret.

#pragma once

#include <map>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

struct Location {
    std::string_view file;    // kept by Diagnostics::intern
    int line = 0, column = 0; // both from 1
};

class Diagnostics {
public:
    // Categories of warnings, as `[["suppress-warning:..."]]` names them.
    enum Category { General, Deprecated, Metadata };

    explicit Diagnostics(std::ostream& out) : out_(out) {}
    Diagnostics(const Diagnostics&) = delete;
    Diagnostics& operator=(const Diagnostics&) = delete;

    void error(const Location& at, const std::string& text);
    void warning(const Location& at, const std::string& text, Category category = General);
    // Suppresses this category's warnings (General: all) from this file on.
    void suppress(std::string_view file, Category category) {
        suppressed_.insert({file, category});
    }

    int errors() const { return errors_; }
    // Copies the text; the copy lives as long as this object.
    std::string_view intern(std::string_view text);

private:
    void print(const Location& at, const char* kind, const std::string& text);
    const std::vector<std::string>& lines(std::string_view file);

    std::ostream& out_;
    int errors_ = 0;
    std::set<std::string, std::less<>> names_;
    std::set<std::pair<std::string_view, Category>> suppressed_;
    std::map<std::string_view, std::vector<std::string>> files_;
};
