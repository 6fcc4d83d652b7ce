// SPDX-License-Identifier: MIT
//
// sources: finds the Verilog files of a module, by reading their instances.

#include "sources.h"

#include "files.h"
#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <stdexcept>

namespace fs = std::filesystem;

namespace {

// Identifiers, and the punctuation around instances; no comments, no strings. An include directive
// becomes the token `include and the file's name.
std::vector<std::string> tokens(const std::string& text) {
    std::vector<std::string> result;
    size_t i = 0;
    const auto at = [&](size_t k) { return k < text.size() ? text[k] : '\0'; };
    const auto word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '$';
    };
    while (i < text.size()) {
        const char c = text[i];
        if (c == '/' && at(i + 1) == '/') {
            i = std::min(text.find('\n', i), text.size());
        } else if (c == '/' && at(i + 1) == '*') {
            const size_t end = text.find("*/", i);
            i = end == std::string::npos ? text.size() : end + 2;
        } else if (c == '"') {
            const size_t end = std::min(text.find('"', i + 1), text.size());
            if (!result.empty() && result.back() == "`include")
                result.push_back(text.substr(i + 1, end - i - 1));
            i = end + 1;
        } else if (word(c) || c == '`') {
            const size_t begin = i++;
            while (word(at(i)))
                i++;
            result.push_back(text.substr(begin, i - begin));
        } else {
            if (c == '(' || c == ')' || c == '#' || c == ';')
                result.push_back(std::string(1, c));
            i++;
        }
    }
    return result;
}

bool isName(const std::string& t) {
    return !t.empty() && (std::isalpha(static_cast<unsigned char>(t[0])) || t[0] == '_');
}

// The index after the parenthesis that closes the one at `open`.
size_t closing(const std::vector<std::string>& t, size_t open) {
    int depth = 0;
    for (size_t i = open; i < t.size(); i++) {
        if (t[i] == "(")
            depth++;
        else if (t[i] == ")" && --depth == 0)
            return i + 1;
    }
    return t.size();
}

// Tokens of a file, with those of included files behind each include, where known.
std::vector<std::string> allTokens(const fs::path& file,
                                   const std::vector<fs::path>& includeFolders) {
    std::vector<std::string> result;
    for (const std::string& token : tokens(readFile(file))) {
        const bool isInclude = !result.empty() && result.back() == "`include";
        result.push_back(token);
        if (isInclude)
            for (const fs::path& folder : includeFolders)
                if (fs::exists(folder / token)) {
                    for (const std::string& t : allTokens(folder / token, {}))
                        result.push_back(t);
                    break;
                }
    }
    return result;
}

void scan(const fs::path& file, const std::vector<fs::path>& includeFolders,
          std::map<std::string, VerilogModule>& modules) {
    const std::vector<std::string> t = allTokens(file, includeFolders);
    VerilogModule* current = nullptr;
    for (size_t i = 0; i + 1 < t.size(); i++) {
        if (t[i] == "module" && isName(t[i + 1])) {
            const auto [it, isNew] = modules.try_emplace(t[i + 1]);
            current = isNew ? &it->second : nullptr;
            if (current)
                current->file = file;
            i++;
        } else if (t[i] == "endmodule") {
            current = nullptr;
        } else if (current && t[i] == "`include") {
            current->includes.insert(t[i + 1]);
        } else if (current && isName(t[i])) {
            size_t k = i + 1; // TYPE [#(...)] NAME (
            if (t[k] == "#" && k + 1 < t.size() && t[k + 1] == "(")
                k = closing(t, k + 1);
            if (k + 1 < t.size() && isName(t[k]) && t[k + 1] == "(")
                current->instances.emplace(t[k], t[i]);
        }
    }
}

} // namespace

Library::Library(const std::vector<fs::path>& folders, const std::vector<fs::path>& includeFolders,
                 const std::vector<fs::path>& files)
    : includeFolders_(includeFolders) {
    for (const fs::path& folder : folders) {
        if (!fs::is_directory(folder))
            throw std::runtime_error(fmt::format("{} is not a folder", folder.string()));
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == ".v")
                found.push_back(entry.path());
        std::sort(found.begin(), found.end());
        for (const fs::path& file : found)
            scan(file, includeFolders, modules_);
    }
    for (const fs::path& file : files)
        scan(file, includeFolders, modules_);
    for (auto& [name, module] : modules_) // a name that is no module was no instance
        for (auto it = module.instances.begin(); it != module.instances.end();)
            it = has(it->second) ? std::next(it) : module.instances.erase(it);
}

std::set<std::string> Library::reach(const std::string& top) const {
    if (!has(top))
        throw std::runtime_error(fmt::format("there is no module {}", top));
    std::set<std::string> found{top};
    std::vector<std::string> open{top};
    while (!open.empty()) {
        const std::string module = open.back();
        open.pop_back();
        for (const auto& [instance, type] : modules_.at(module).instances)
            if (found.insert(type).second)
                open.push_back(type);
    }
    return found;
}

std::vector<fs::path> Library::filesOf(const std::string& top) const {
    std::set<fs::path> files;
    for (const std::string& module : reach(top))
        files.insert(modules_.at(module).file);
    return {files.begin(), files.end()};
}

std::string Library::hashOf(const std::string& top) const {
    std::vector<std::string> contents;
    std::set<std::string> includes;
    for (const fs::path& file : filesOf(top))
        contents.push_back(readFile(file));
    for (const std::string& module : reach(top))
        includes.insert(modules_.at(module).includes.begin(), modules_.at(module).includes.end());
    for (const std::string& include : includes)
        for (const fs::path& folder : includeFolders_)
            if (fs::exists(folder / include)) {
                contents.push_back(readFile(folder / include));
                break;
            }
    return hexHash(contents);
}

std::string Library::moduleAt(const std::string& top, const std::string& path) const {
    std::string module = top;
    for (size_t begin = 0; begin < path.size() && has(module);) {
        const size_t end = std::min(path.find('.', begin), path.size());
        const std::string name = path.substr(begin, end - begin);
        const auto& instances = modules_.at(module).instances;
        const auto it = instances.find(name);
        if (it != instances.end())
            module = it->second;
        else if (name.find('[') == std::string::npos && name.rfind("g_", 0) != 0)
            return ""; // neither an instance nor a generate block
        begin = end + 1;
    }
    return module;
}

std::set<std::string> Library::filesAlong(const std::string& top, const std::string& path) const {
    std::set<std::string> files{modules_.at(top).file.filename()};
    for (size_t dot = 0; dot != std::string::npos && !path.empty();) {
        dot = path.find('.', dot + 1);
        const std::string module = moduleAt(top, path.substr(0, dot));
        if (has(module))
            files.insert(modules_.at(module).file.filename());
    }
    return files;
}
