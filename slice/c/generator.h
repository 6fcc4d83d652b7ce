// SPDX-License-Identifier: MIT
//
// generator: writes a unit as C90 for IceC: a header and four sources (docs/slice-mapping.md).

#pragma once

#include "front/ast.h"
#include "text/writer.h"
#include <string>
#include <vector>

struct CFileNames {
    std::string base;                  // "Printer"
    std::string headerExtension = "h"; // without the dot
    std::string sourceExtension = "c";
    // path of the header in include directives, such as "folder/Printer.h"
    std::string path;
    // prefix of other headers in include directives; may be empty
    std::string includeDir;
    std::vector<std::string> includes; // headers of the Slice files that the main file includes
};

// Returns the limits files of these Slice files: Name.limits in the folder of Name.ice, if it
// exists.
std::vector<std::string> limitFiles(const std::vector<std::string>& files);

// Adds metadata from limits files to the definitions that the files name. The added metadata
// precedes the metadata in the source.
void addLimits(Unit& unit, const std::vector<std::string>& files, Diagnostics& diagnostics);

// Gives long names to the enumerators of an enum, as ["c:scoped"] does, if one of their short names
// is also the name of another item in the same file. Names in other files are ignored, because a
// program may or may not include those files.
void scopeEnumerators(Unit& unit);

// Reports definitions that cannot be mapped to C, and definitions that would get the same C name.
// Call this before generateC.
void checkC(const Unit& unit, const CFileNames& names, Diagnostics& diagnostics);

std::vector<GeneratedFile> generateC(const Unit& unit, const CFileNames& names);
