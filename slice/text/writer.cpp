// SPDX-License-Identifier: MIT
//
// writer: fills in templates, indents lines, and breaks long lines.

#include "text/writer.h"
#include <algorithm>

std::string Writer::fill(std::string_view text, const Values& values) {
    std::string result;
    result.reserve(text.size() + 40);
    while (!text.empty()) {
        size_t open = values.empty() ? text.size() : std::min(text.find('{'), text.size());
        result += text.substr(0, open);
        text.remove_prefix(open);
        size_t close = text.find('}');
        auto known = std::find_if(values.begin(), values.end(), [&](const auto& v) {
            return close != std::string_view::npos && v.first == text.substr(1, close - 1);
        });
        if (known != values.end()) {
            result += known->second;
            text.remove_prefix(close + 1);
        } else if (!text.empty()) { // this brace is plain text, not the start of a {name}
            result += '{';
            text.remove_prefix(1);
        }
    }
    return result;
}

void Writer::line(std::string_view text, const Values& values) {
    std::string filled = fill(text, values);
    if (filled.empty())
        return blank();
    size_t indent = filled[0] == '#' ? 0 : indent_ * 4;
    constexpr size_t columns = 100;
    bool breakable = std::string_view("#/- ").find(filled[0]) == std::string::npos;
    while (breakable && indent + filled.size() > columns) {
        size_t at = std::string::npos;
        for (std::string_view behind : {", ", " = ", " && "}) {
            at = filled.rfind(behind, columns - indent - behind.size());
            if (at != std::string::npos && at > 8) {
                at += behind.size();
                break;
            }
        }
        // Never breaks a line within a string.
        if (at == std::string::npos || at >= filled.size() || filled.find('"') < at)
            break;
        out_.append(indent, ' ').append(filled, 0, at - 1) += '\n';
        filled.erase(0, at);
        indent = indent_ * 4 + 8;
    }
    out_.append(indent, ' ').append(filled) += '\n';
}
