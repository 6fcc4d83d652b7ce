// SPDX-License-Identifier: MIT
//
// generator: the files of a hardware interface, one function a file (docs/hw-mapping.md).

#ifndef SLICE_HW_GENERATOR_H
#define SLICE_HW_GENERATOR_H

#include "hw/map.h"
#include "text/writer.h"

struct CFileNames;

namespace hw {

GeneratedFile registersFile(const Block& b);                          // <block>.regs.json
GeneratedFile verilogFile(const Block& b);                            // <block>_wrapper.v
GeneratedFile vhdlFile(const Block& b);                               // <block>_wrapper.vhd
GeneratedFile servantHeader(const Block& b, const CFileNames& names); // <block>_servant.h
GeneratedFile servantSource(const Block& b, const CFileNames& names); // <block>_servant.c

GeneratedFile proxyFile(const Block& b, const CFileNames& names); // <block>_proxy.h

// Files to begin a core with: <block>.v, <block>.vhd, <block>_test.cpp
GeneratedFile verilogSkeleton(const Block& b);
GeneratedFile vhdlSkeleton(const Block& b);
GeneratedFile testSkeleton(const Block& b);

} // namespace hw

#endif
