// SPDX-License-Identifier: MIT
//
// c_types: how Slice types look in C and on the wire (docs/icec.md).

#ifndef C_TYPES_H
#define C_TYPES_H

#include "ast.h"

// A name that C90 keeps for itself gets a trailing underscore.
std::string cIdentifier(const std::string& name);
// As a member or variable: "Ice_Short", "M_Param".
std::string cType(const Type& type);
// As a parameter that is read: by value, or a pointer to const.
std::string cInParameter(const Type& type, const std::string& name);
std::string cOutParameter(const Type& type, const std::string& name);
// Statements. `expression` names a value of the type; `object` (for reading) an lvalue.
std::string writeStatement(const Type& type, const std::string& expression);
std::string readStatement(const Type& type, const std::string& object, const std::string& communicator);
// The expression that hands a variable on as an in parameter.
std::string asInArgument(const Type& type, const std::string& variable);
bool isByPointer(const Type& type); // structs, sequences and proxies
int leastWireSize(const Type& type); // bytes
int64_t largestEnumerator(const Declaration& declaration);
bool containsProxy(const Type& type);

#endif
