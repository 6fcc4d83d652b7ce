// SPDX-License-Identifier: MIT
//
// diagnostics: errors and warnings with file, line, column, the source line and a caret.

#ifndef DIAGNOSTICS_H
#define DIAGNOSTICS_H

#include <map>
#include <ostream>
#include <string>
#include <vector>

struct Location {
    std::string file;
    int line = 0, column = 0; // both from 1
};

class Diagnostics {
public:
    explicit Diagnostics(std::ostream& out) : out_(out) {}
    void error(const Location& at, const std::string& text) {
        ++errors_;
        print(at, "error", text);
    }
    void warning(const Location& at, const std::string& text) { print(at, "warning", text); }
    int errors() const { return errors_; }

private:
    void print(const Location& at, const char* kind, const std::string& text);
    const std::vector<std::string>& lines(const std::string& file);

    std::ostream& out_;
    int errors_ = 0;
    std::map<std::string, std::vector<std::string>> files_;
};

#endif
