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
    std::string path;                  // "folder/Printer.h": the header, as in include directives
    std::string includeDir;            // prefix of the header in include directives, may be empty
    std::vector<std::string> includes; // headers of the Slice files that the main file includes
};

// Returns the limits files of these Slice files: Name.limits in the folder of Name.ice, if it
// exists.
std::vector<std::string> limitFiles(const std::vector<std::string>& files);

// Adds the metadata of these files to the definitions that they name; it goes before the source's.
void addLimits(Unit& unit, const std::vector<std::string>& files, Diagnostics& diagnostics);

// Gives the enumerators of an enum their long names, as ["c:scoped"] does, if a short one is used
// by another name of the same file. Declarations in other files are ignored, because they may be
// included or not.
void scopeEnumerators(Unit& unit);

// Reports definitions that C cannot map, or would map to one name twice. Call it before generateC.
void checkC(const Unit& unit, const CFileNames& names, Diagnostics& diagnostics);

std::vector<GeneratedFile> generateC(const Unit& unit, const CFileNames& names);
