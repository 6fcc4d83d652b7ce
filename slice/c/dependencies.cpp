// SPDX-License-Identifier: MIT
//
// dependencies: shortens paths and prints them.

#include "c/dependencies.h"
#include <filesystem>
#include <sstream>

namespace fs = std::filesystem;

std::string headerOf(const std::string& included, const std::string& file,
                     const std::vector<std::string>& includeDirs, const std::string& extension) {
    fs::path path = fs::weakly_canonical(included), best;
    auto consider = [&](const fs::path& dir) {
        fs::path relative = path.lexically_relative(fs::weakly_canonical(dir));
        bool isUnder = !relative.empty() && *relative.begin() != "..";
        if (isUnder && (best.empty() || relative.string().size() < best.string().size()))
            best = relative;
    };
    for (const std::string& d : includeDirs)
        consider(d);
    if (best.empty())
        best = path.lexically_relative(fs::weakly_canonical(fs::absolute(file).parent_path()));
    return best.replace_extension(extension).generic_string();
}

namespace {

// The preprocessor makes paths absolute; paths below the current folder are written relative to it.
std::string shown(const std::string& file) {
    fs::path path = fs::weakly_canonical(file),
             relative = path.lexically_relative(fs::current_path());
    return relative.empty() || *relative.begin() == ".." ? path.string() : relative.string();
}

} // namespace

void Dependencies::add(const std::string& file, const CFileNames& names,
                       const std::vector<std::string>& files) {
    entries_.push_back({file, names, {}});
    for (const std::string& f : files)
        if (shown(f) != shown(file))
            entries_.back().dependsOn.push_back(shown(f));
}

std::string Dependencies::text() const {
    std::ostringstream out;
    for (const Entry& e : entries_) {
        const std::string& base = e.names.base;
        out << base << '.' << e.names.headerExtension;
        for (const char* part : {"_types", "_client", "_async", "_server"})
            out << ' ' << base << part << '.' << e.names.sourceExtension;
        out << ": \\\n " << e.file;
        for (const std::string& d : e.dependsOn)
            out << " \\\n " << d;
        out << '\n';
    }
    return out.str();
}
