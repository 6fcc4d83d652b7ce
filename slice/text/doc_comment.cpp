// SPDX-License-Identifier: MIT
//
// doc_comment: cleans doc comments and replaces their tags by words.

#include "text/doc_comment.h"

namespace {

void replaceAll(std::string& s, std::string_view from, std::string_view to) {
    for (size_t at = 0; (at = s.find(from, at)) != std::string::npos; at += to.size())
        s.replace(at, from.size(), to);
}

// Replaces "{@link Name#op}" by "Name.op".
void plainLinks(std::string& s) {
    for (size_t at = 0; (at = s.find("{@link", at)) != std::string::npos;) {
        size_t close = s.find('}', at);
        if (close == std::string::npos)
            return;
        size_t begin = s.find_first_not_of(' ', at + 6);
        std::string name = s.substr(begin, close - begin);
        if (!name.empty() && name[0] == '#')
            name.erase(0, 1);
        replaceAll(name, "#", ".");
        s.replace(at, close - at + 1, name);
    }
}

// Replaces "@param name text" by "name: text".
void plainTag(std::string& s) {
    static const struct {
        std::string_view tag, text;
        bool isNamed; // true if a name follows the tag; a colon is then added after this name
    } tags[] = {{"@param ", "", true},
                {"@return ", "result: ", false},
                {"@throws ", "throws ", true},
                {"@deprecated", "Deprecated:", false},
                {"@see ", "see ", false}};
    if (s[0] != '@')
        return;
    for (const auto& [tag, text, isNamed] : tags) {
        if (s.compare(0, tag.size(), tag) != 0)
            continue;
        s.replace(0, tag.size(), text);
        size_t end = isNamed ? s.find(' ', text.size()) : std::string::npos;
        if (end != std::string::npos)
            s.insert(end, ":");
        return;
    }
}

// Inserts spaces into character sequences that have a meaning in a C comment. In C90, a backslash
// at the end of a line is also such a sequence.
void apart(std::string& s) {
    replaceAll(s, "*/", "* /");
    replaceAll(s, "/*", "/ *");
    replaceAll(s, "?\?/", "?? /");
}

} // namespace

std::vector<std::string> docLines(const std::string& doc) {
    std::vector<std::string> lines;
    for (size_t at = 0; at <= doc.size();) {
        size_t end = std::min(doc.find('\n', at), doc.size());
        std::string line = doc.substr(at, end - at);
        at = end + 1;
        size_t begin = line.find_first_not_of(" \t*/\r");
        line = begin == std::string::npos
                   ? ""
                   : line.substr(begin, line.find_last_not_of(" \t\r") - begin + 1);
        plainLinks(line);
        plainTag(line);
        apart(line);
        if (!line.empty() || (!lines.empty() && !lines.back().empty()))
            lines.push_back(line);
    }
    while (!lines.empty() && lines.back().empty())
        lines.pop_back();
    return lines;
}

void writeDoc(Writer& w, const std::string& doc, const std::vector<std::string>& metadata) {
    std::vector<std::string> lines = docLines(doc);
    for (const std::string& m : metadata)
        if ((m + ":").compare(0, 10, "deprecate:") == 0) {
            lines.push_back("Deprecated" +
                            (m.size() > 10 ? ": " + m.substr(10) : std::string(".")));
            apart(lines.back());
        }
    if (lines.empty())
        return;
    for (size_t i = 0; i < lines.size(); ++i) {
        std::string text = (i == 0 ? "/* " : lines[i].empty() ? " *" : " * ") + lines[i];
        w.line(text + (i + 1 == lines.size() ? " */" : ""));
    }
}
