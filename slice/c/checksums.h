// SPDX-License-Identifier: MIT
//
// checksums: of the definitions of a Slice file, the same as ZeroC's compilers make: programs
// compare them to find out whether they were compiled from the same Slice.

#ifndef SLICE_C_CHECKSUMS_H
#define SLICE_C_CHECKSUMS_H

#include "front/ast.h"
#include <map>
#include <string>

// The checksums of what the main file defines, local definitions aside, by type id.
std::map<std::string, std::string> checksums(const Unit& unit);

#endif
