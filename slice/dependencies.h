// SPDX-License-Identifier: MIT
//
// dependencies: what --depend prints, and where the headers of included Slice files are.

#ifndef DEPENDENCIES_H
#define DEPENDENCIES_H

#include "c_generator.h"
#include <string>
#include <vector>

// The header for `included` as it is named in an #include: the shortest path from one of the -I
// folders, else from the folder of `file`.
std::string headerOf(const std::string& included, const std::string& file,
                     const std::vector<std::string>& includeDirs, const std::string& extension);

class Dependencies {
public:
    // `files`: the Slice file itself and all that it includes.
    void add(const std::string& file, const CFileNames& names,
             const std::vector<std::string>& files);
    // As rules for make, or as XML as Ice's compilers write it; to standard output if `path` is
    // empty.
    bool print(bool xml, const std::string& path) const;

private:
    struct Entry {
        std::string file;
        CFileNames names;
        std::vector<std::string> dependsOn;
    };
    std::vector<Entry> entries_;
};

#endif
