// SPDX-License-Identifier: MIT
//
// preprocessor: runs libmcpp over one file and keeps the output in memory.

#include "front/front.h"
extern "C" {
#include <mcpp_lib.h>
}
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace {

void addOnce(std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end())
        list.push_back(name);
}

// Returns the path of `name`, a file included by `includer`. libmcpp reports the name in one of
// three forms: as written, relative to the includer's folder, or appended to the -I folder of the
// includer.
std::string placeOf(const std::string& name, const std::string& includer) {
    std::error_code error;
    std::filesystem::path path = name, folder = std::filesystem::path(includer).parent_path();
    if (path.is_absolute() && std::filesystem::exists(path, error))
        return name;
    for (auto first = path.begin(); first != path.end(); ++first) {
        std::filesystem::path rest;
        for (auto part = first; part != path.end(); ++part)
            rest /= *part;
        auto sibling = (folder / rest).lexically_normal();
        if (rest.is_relative() && std::filesystem::exists(sibling, error))
            return sibling.string();
    }
    return name;
}

// Finds the path of each file in the preprocessor's markers. #line 1 "file" begins an included
// file; a marker with another line number returns to an enclosing file.
void findFiles(Preprocessed& p) {
    std::vector<std::string> open, places;
    for (size_t at = 0; (at = p.text.find("#line ", at)) != std::string::npos;) {
        size_t begin = at, end = std::min(p.text.find('\n', at), p.text.size());
        at = begin + 1;
        if (begin > 0 && p.text[begin - 1] != '\n')
            continue;
        size_t quote = p.text.find('"', begin), close = p.text.rfind('"', end);
        if (quote >= end || close <= quote)
            continue;
        std::string name = p.text.substr(quote + 1, close - quote - 1);
        auto around = std::find(open.begin(), open.end(), name);
        if (around != open.end()) {
            open.erase(around + 1, open.end());
            places.resize(open.size());
        } else {
            places.push_back(open.empty() ? name : placeOf(name, places.back()));
            if (open.size() == 1)
                addOnce(p.includes, places.back());
            open.push_back(name);
            addOnce(p.files, places.back());
        }
        p.text.replace(quote + 1, name.size(), places.back());
    }
}

// Appends a marker with the number of the last line. libmcpp counts comments at the end of a file
// twice, so its own line number is wrong there.
void markEnd(Preprocessed& p, const std::string& file) {
    size_t end = p.text.find('\n');
    if (p.text.compare(0, 8, "#line 1 ") != 0)
        return;
    std::ifstream in(file, std::ios::binary);
    size_t lines = 1;
    for (std::string line; std::getline(in, line);)
        ++lines;
    p.text += "#line " + std::to_string(lines) + p.text.substr(7, end - 6);
}

// longest line that libmcpp accepts, bytes; lines that are joined by backslashes count as one line
constexpr size_t longestLine = 65500;

// Returns an error message that names the line that exceeds libmcpp's limit, in `file` or in an
// included file.
std::string tooLongLine(const std::filesystem::path& file, const std::vector<std::string>& options,
                        std::set<std::filesystem::path>& seen) {
    std::ifstream in(file, std::ios::binary);
    if (!in || !seen.insert(file.lexically_normal()).second)
        return "";
    size_t length = 0, number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        length += line.size();
        if (length > longestLine)
            return file.string() + ":" + std::to_string(number) +
                   ": error: the line is too long: a line, with the lines that '\\' joins to it, "
                   "may have at most " +
                   std::to_string(longestLine) + " bytes\n";
        if (!line.empty() && line.back() == '\\')
            continue;
        length = 0;
        size_t hash = line.find_first_not_of(" \t");
        if (hash == std::string::npos || line[hash] != '#')
            continue;
        size_t open = line.find_first_of("\"<", hash), close = line.find_last_of("\">");
        if (open == std::string::npos || close <= open || line.find("include") > open)
            continue;
        std::string name = line.substr(open + 1, close - open - 1);
        std::vector<std::filesystem::path> folders = {file.parent_path()};
        for (const std::string& o : options)
            if (o.compare(0, 2, "-I") == 0)
                folders.emplace_back(o.substr(2));
        for (const auto& folder : folders)
            if (std::string message = tooLongLine(folder / name, options, seen); !message.empty())
                return message;
    }
    return "";
}

// Removes two messages that Ice's compilers do not print: the message about line ends of other
// systems and the message about a missing line end.
std::string withoutLineEnds(const std::string& messages) {
    std::istringstream in(messages);
    std::string kept;
    bool isSkipped = false;
    for (std::string line; std::getline(in, line);) {
        // true if this line belongs to the previous message: source text, or the name of the
        // including file
        bool continues = !line.empty() && line[0] == ' ';
        isSkipped = (isSkipped && continues) ||
                    line.find(": warning: Converted [CR+LF] to [LF]") != std::string::npos ||
                    line.find(" with no newline, supplemented newline") != std::string::npos;
        if (!isSkipped)
            kept += line + '\n';
    }
    return kept;
}

} // namespace

Preprocessed preprocess(const std::string& file, const std::vector<std::string>& options) {
    // -C keeps comments, because doc comments are needed; -k keeps columns, for messages. Ice 3.7's
    // compilers also define these version macros.
    std::vector<std::string> arguments = {"mcpp",
                                          "-C",
                                          "-k",
                                          "-e",
                                          "en_us.utf8",
                                          "-D__SLICE2C__",
                                          "-DICE_VERSION=30708",
                                          "-D__ICE_VERSION__=30708"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.push_back(file);
    std::vector<char*> argv;
    for (std::string& a : arguments)
        argv.push_back(a.data());

    Preprocessed result;
    std::set<std::filesystem::path> seen;
    result.messages = tooLongLine(file, options, seen);
    if (!result.messages.empty())
        return result;
    mcpp_use_mem_buffers(1);
    result.ok = mcpp_lib_main(static_cast<int>(argv.size()), argv.data()) == 0;
    if (const char* text = mcpp_get_mem_buffer(OUT))
        result.text = text;
    if (const char* messages = mcpp_get_mem_buffer(ERR))
        result.messages = withoutLineEnds(messages);
    mcpp_use_mem_buffers(1); // frees them
    findFiles(result);
    markEnd(result, file);
    return result;
}
