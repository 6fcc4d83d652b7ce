// SPDX-License-Identifier: MIT
//
// generator: the list of generated files.

#include "c/context.h"

std::vector<GeneratedFile> generateC(const Unit& unit, const CFileNames& names) {
    CContext c{unit, names};
    const std::string& s = names.sourceExtension;
    return {{c.header(), headerFile(c)},
            {names.base + "_types." + s, typesFile(c)},
            {names.base + "_client." + s, clientFile(c)},
            {names.base + "_async." + s, asyncFile(c)},
            {names.base + "_server." + s, serverFile(c)}};
}
