// SPDX-License-Identifier: MIT
//
// fuzz_compiler: entry point for libFuzzer. It passes any text through lexer, parser, checks and
// all generators, as slice2c does. If a text has no errors, the generators must write C for it; for
// each of its [":hw"] interfaces they must also write registers, wrappers, servant, proxy and
// skeletons. Nothing may crash, hang or leak (built with sanitizers).

#include "c/generator.h"
#include "front/front.h"
#include "hw/generator.h"
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
    scopeEnumerators(unit);
    if (diagnostics.errors() == 0)
        checkC(unit, names, diagnostics);
    std::vector<hw::Block> blocks;
    if (diagnostics.errors() == 0)
        blocks = hw::mapHardware(unit, diagnostics);
    if (diagnostics.errors() > 0) {
        if (out.str().empty())
            std::abort(); // the compiler failed without an error message
        return 0;
    }
    if (generateC(unit, names).empty())
        std::abort();
    for (hw::Block& block : blocks) {
        block.hasOwnClock = size % 2 == 0;
        block.header = names.path;
        for (auto makes : {hw::registersFile, hw::verilogFile, hw::vhdlFile, hw::servantHeader,
                           hw::servantSource, hw::proxyFile, hw::verilogSkeleton, hw::vhdlSkeleton,
                           hw::testSkeleton})
            if (makes(block).text.empty())
                std::abort();
    }
    return 0;
}
