// SPDX-License-Identifier: MIT
//
// dependencies: the output of --depend, and the headers of included Slice files.

#ifndef SLICE_C_DEPENDENCIES_H
#define SLICE_C_DEPENDENCIES_H

#include "c/generator.h"
#include <string>
#include <vector>

// Returns the header for `included` as an #include names it: the shortest path from one of the -I
// folders, else from the folder of `file`.
std::string headerOf(const std::string& included, const std::string& file,
                     const std::vector<std::string>& includeDirs, const std::string& extension);

class Dependencies {
public:
    // `files`: the Slice file itself and all files that it includes.
    void add(const std::string& file, const CFileNames& names,
             const std::vector<std::string>& files);
    // The dependencies as rules for make.
    std::string text() const;

private:
    struct Entry {
        std::string file;
        CFileNames names;
        std::vector<std::string> dependsOn;
    };
    std::vector<Entry> entries_;
};

#endif
