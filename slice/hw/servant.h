// SPDX-License-Identifier: MIT
//
// servant: shared by the files that write the servant.

#ifndef SLICE_HW_SERVANT_H
#define SLICE_HW_SERVANT_H

#include "c/generator.h"
#include "hw/map.h"
#include "text/writer.h"

namespace hw {

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

void operation(Writer& w, const Block& b, const Call& c);
// Operations that are answered later, in two functions; the test bench's proxy calls these, too.
void amdDeclarations(Writer& w, const Block& b, const Call& c);
void eventDeclaration(Writer& w, const Block& b, const Call& c);
void amdFunctions(Writer& w, const Block& b, const Call& c);
void pollFunction(Writer& w, const Block& b);
void listenerFunctions(Writer& w, const Block& b, const Listener& l);

} // namespace hw

#endif
