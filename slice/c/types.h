// SPDX-License-Identifier: MIT
//
// types: pieces of C that pass, write and read values, which the generators put together.

#pragma once

#include "front/ast.h"
#include "text/writer.h"
#include <string>
#include <vector>

// True if it is passed by const pointer: all types except scalars, strings, enums and classes.
bool isByPointer(const Type& type);
bool isEnum(const Type& type);
bool isClass(const Type& type); // a pointer to an Ice_Value

// A declaration of `name`: "Ice_Int x", "M_Node *x".
std::string cVariable(const Type& type, const std::string& name);

// A value in a list of members or parameters for writing or reading.
struct Slot {
    const Type* type = nullptr;
    std::string value;   // its lvalue
    std::string pointer; // its address
    bool isOptional = false;
    int tag = 0;
    std::string has; // whether it is there: a condition when writing, an lvalue when reading
};

// Write or read slots in the order of the wire.
void writeSlots(Writer& w, const std::vector<Slot>& slots);
void readSlots(Writer& w, const std::vector<Slot>& slots);
