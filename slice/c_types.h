// SPDX-License-Identifier: MIT
//
// c_types: how values are passed, written and read: pieces of C that the generators put together.

#ifndef C_TYPES_H
#define C_TYPES_H

#include "ast.h"
#include "writer.h"
#include <string>
#include <vector>

// Passed by const pointer: all but scalars, strings, enums and pointers to classes.
bool isByPointer(const Type& type);
bool isEnum(const Type& type);
bool isClass(const Type& type); // a pointer to an Ice_Value

// Least bytes on the wire, and whether that is all there can be.
int leastWireSize(const Type& type);
bool isVariable(const Type& type);
// A class is in it, at any depth.
bool containsClass(const Type& type);

// A declaration of `name`: "Ice_Int x", "M_Node *x".
std::string cVariable(const Type& type, const std::string& name);

// One value in a list of members or parameters that is written or read.
struct Slot {
    const Type* type = nullptr;
    std::string value;   // its lvalue
    std::string pointer; // its address
    bool isOptional = false;
    int tag = 0;
    std::string has; // is it there? written: a condition; read: an lvalue
};

// Required ones in their order, then the optional ones by tag, as they are on the wire.
std::vector<Slot> wireOrder(std::vector<Slot> slots);
void writeSlots(Writer& w, const std::vector<Slot>& slots);
void readSlots(Writer& w, const std::vector<Slot>& slots);

std::string writeStatement(const Type& type, const std::string& value, const std::string& pointer);
std::string readStatement(const Type& type, const std::string& value, const std::string& pointer);

#endif
