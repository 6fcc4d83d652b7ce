// SPDX-License-Identifier: MIT
//
// compiler_fuzz: libFuzzer's entry: any text through lexer, parser, checks and generator. What has
// no errors must give C; nothing may crash, hang or leak (built with sanitizers).

#include "compiler.h"
#include <cstdint>
#include <cstdlib>
#include <sstream>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    std::string text(reinterpret_cast<const char*>(data), size);
    std::ostringstream out;
    Diagnostics diagnostics(out);
    CFileNames names;
    names.base = "Fuzz";
    names.checksums = true;
    auto files = compileToC(text, "Fuzz.ice", {}, names, diagnostics);
    if (files.has_value() == (diagnostics.errors() > 0) ||
        (diagnostics.errors() > 0 && out.str().empty()))
        std::abort(); // errors without a message, or a result in spite of them
    return 0;
}
