// SPDX-License-Identifier: MIT
//
// hw_servant: what the files that write the servant share.

#ifndef HW_SERVANT_H
#define HW_SERVANT_H

#include "c_generator.h"
#include "hw_map.h"
#include "writer.h"

namespace hw {

std::string coreType(const Block& b); // Module_Interface_Core

// Parameters into registers and buffers; `hw_core` is the servant.
void writeParameters(Writer& w, const Block& b, const Call& c);
// Registers and buffers into results, through pointers; returns where the core threw.
void readResults(Writer& w, const Block& b, const Call& c);
// The variables that they use.
void resultVariables(Writer& w, const Call& c);
// Room for the elements of received sequences, as members of the servant.
void sequenceMembers(Writer& w, const Block& b);
void checkLayouts(Writer& w, const Block& b);

void operation(Writer& w, const Block& b, const Call& c);
// What is answered later: exported for the test bench's proxy, too.
void amdDeclarations(Writer& w, const Block& b, const Call& c);
void eventDeclaration(Writer& w, const Block& b, const Call& c);
void amdFunctions(Writer& w, const Block& b, const Call& c);
void pollFunction(Writer& w, const Block& b);
void listenerFunctions(Writer& w, const Block& b, const Listener& l);

} // namespace hw

#endif
