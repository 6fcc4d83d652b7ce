// SPDX-License-Identifier: MIT
//
// checksums: of the definitions of a Slice file, the same as ZeroC's compilers make: programs
// compare them to find out whether they were compiled from the same Slice.

#ifndef CHECKSUMS_H
#define CHECKSUMS_H

#include "ast.h"
#include <map>
#include <string>

// By type id; of what the main file defines, local definitions aside.
std::map<std::string, std::string> checksums(const Unit& unit);

#endif
