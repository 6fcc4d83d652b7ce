// SPDX-License-Identifier: MIT
//
// c_generator: the C90 of one Slice file: header, types, proxies (client), dispatch (server).

#ifndef C_GENERATOR_H
#define C_GENERATOR_H

#include "ast.h"

struct GeneratedFile {
    std::string name, text;
};

// `base`: name of the Slice file without its extension.
std::vector<GeneratedFile> generateC(const Unit& unit, const std::string& base,
                                     const std::string& headerExtension);

// What Slice allows and the C mapping does not; and what a [":hw"] interface cannot hold.
void checkC(const Unit& unit, Diagnostics& diagnostics);

#endif
