// SPDX-License-Identifier: MIT
//
// generator: the files of a hardware interface, one function a file (docs/hw-mapping.md), and what
// wrappers in both languages share.

#pragma once

#include "hw/map.h"
#include "text/writer.h"

namespace hw {

GeneratedFile registersFile(const Block& b); // <block>.regs.json
GeneratedFile verilogFile(const Block& b);   // <block>_wrapper.v
GeneratedFile vhdlFile(const Block& b);      // <block>_wrapper.vhd
GeneratedFile servantHeader(const Block& b); // <block>_servant.h
GeneratedFile servantSource(const Block& b); // <block>_servant.c

GeneratedFile proxyFile(const Block& b); // <block>_proxy.h

// Files to begin a core with: <block>.v, <block>.vhd, <block>_test.cpp
GeneratedFile verilogSkeleton(const Block& b);
GeneratedFile vhdlSkeleton(const Block& b);
GeneratedFile testSkeleton(const Block& b);

// ---- the head and the ports of a wrapper ----

// Writes a wrapper's first comment; `mark` begins its lines.
void wrapperHead(Writer& w, const Block& b, const std::string& mark);

// "[7:0] ", or nothing for a bit; "std_logic_vector(7 downto 0)", or "std_logic".
std::string verilogRange(unsigned width);
std::string vhdlType(unsigned width);
// Writes an entity, up to its architecture's declarations, with a package that it uses.
void vhdlEntity(Writer& w, const std::string& name, const std::vector<Port>& ports,
                const std::string& package = "");

// ---- values of the servant ----

std::string coreType(const Block& b); // Module_Interface_Core

// Moves parameters into registers and buffers; `hw_core` is the servant.
void writeParameters(Writer& w, const Block& b, const Call& c);
// Moves registers and buffers into results, through pointers; returns after an exception.
void readResults(Writer& w, const Block& b, const Call& c);
// Declares the variables of both.
void resultVariables(Writer& w, const Call& c);
// Declares room for the elements of received sequences, as members of the servant.
void sequenceMembers(Writer& w, const Block& b);
void checkLayouts(Writer& w, const Block& b);

} // namespace hw
