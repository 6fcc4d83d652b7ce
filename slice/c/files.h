// SPDX-License-Identifier: MIT
//
// files: one function for each generated file, and for the parts of the types file.

#ifndef SLICE_C_FILES_H
#define SLICE_C_FILES_H

#include "c/context.h"

std::string headerFile(const CContext& c);
std::string typesFile(const CContext& c);
std::string clientFile(const CContext& c);
std::string asyncFile(const CContext& c);
std::string serverFile(const CContext& c);

// Write an exception's functions, and those of an operation's exception union.
void exceptionFunctions(Writer& w, const Declaration& d);
void thrownFunctions(Writer& w, const CContext& c, const Declaration& d, const Operation& o);
// Write a class's descriptor with its functions, and the table of all descriptors.
void classFunctions(Writer& w, const Declaration& d);
void valueTypeTable(Writer& w, const CContext& c);

#endif
