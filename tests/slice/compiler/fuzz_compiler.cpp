// SPDX-License-Identifier: MIT
//
// fuzz_compiler: libFuzzer's entry: any text through lexer, parser, checks and generator. Text
// without errors must give C; nothing may crash, hang or leak (built with sanitizers).

#include "c/generator.h"
#include "front/front.h"
#include <cstdint>
#include <cstdlib>
#include <sstream>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    std::string text(reinterpret_cast<const char*>(data), size);
    std::ostringstream out;
    Diagnostics diagnostics(out);
    Unit unit = compileUnit(text, "Fuzz.ice", {}, diagnostics);
    CFileNames names;
    names.base = "Fuzz";
    names.path = "Fuzz.h";
    if (diagnostics.errors() == 0)
        checkC(unit, names, diagnostics);
    if (diagnostics.errors() > 0) {
        if (out.str().empty())
            std::abort(); // errors without a message
        return 0;
    }
    if (generateC(unit, names).empty())
        std::abort();
    return 0;
}
