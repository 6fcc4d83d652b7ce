// SPDX-License-Identifier: MIT
//
// writer: filling in, indenting, breaking lines.

#include "writer.h"
#include <algorithm>

std::string Writer::fill(std::string_view text, const Values& values) {
    std::string result;
    result.reserve(text.size() + 40);
    for (size_t i = 0; i < text.size(); ++i) {
        size_t close = text[i] == '{' ? text.find('}', i) : std::string_view::npos;
        bool known = false;
        if (close != std::string_view::npos) {
            std::string_view name = text.substr(i + 1, close - i - 1);
            for (const auto& [key, value] : values)
                if (key == name) {
                    result += value;
                    i = close;
                    known = true;
                    break;
                }
        }
        if (!known)
            result += text[i];
    }
    return result;
}

void Writer::line(std::string_view text, const Values& values) {
    std::string filled = fill(text, values);
    if (filled.empty())
        return blank();
    size_t indent = filled[0] == '#' ? 0 : indent_ * 4;
    constexpr size_t columns = 100;
    bool breakable = filled[0] != '#' && filled[0] != '/' && filled[0] != ' ';
    while (breakable && indent + filled.size() > columns) {
        size_t at = std::string::npos;
        for (std::string_view behind : {", ", " = ", " && "}) {
            at = filled.rfind(behind, columns - indent - behind.size());
            if (at != std::string::npos && at > 8) {
                at += behind.size();
                break;
            }
        }
        // Not within a string.
        if (at == std::string::npos || at >= filled.size() || filled.find('"') < at)
            break;
        out_.append(indent, ' ').append(filled, 0, at - 1) += '\n';
        filled.erase(0, at);
        indent = indent_ * 4 + 8;
    }
    out_.append(indent, ' ').append(filled) += '\n';
}

void Writer::raw(std::string_view text) {
    while (!text.empty()) {
        size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        out_.append(end > 1 ? indent_ * 4 : 0, ' ').append(text.substr(0, end));
        text.remove_prefix(end);
    }
}
