// SPDX-License-Identifier: MIT
//
// checksums: of the definitions of a Slice file, as ZeroC's compilers make them: programs compare
// them to find out whether they were compiled from the same Slice.

#ifndef SLICE_C_CHECKSUMS_H
#define SLICE_C_CHECKSUMS_H

#include "front/ast.h"
#include <map>
#include <string>

// The checksums of the main file's definitions, except local ones, by type id.
std::map<std::string, std::string> checksums(const Unit& unit);

#endif
