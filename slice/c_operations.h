// SPDX-License-Identifier: MIT
//
// c_operations: operations and exceptions as C sees them: signatures, lists of parameters.

#ifndef C_OPERATIONS_H
#define C_OPERATIONS_H

#include "ast.h"
#include "c_types.h"
#include <string>
#include <vector>

// Base interfaces first, without repetition; the interface itself comes last.
std::vector<const Declaration*> lineage(const Declaration& interface);

// Of an operation with a throws clause: what it lists, and what this unit derives from that.
std::vector<const Declaration*> mayThrow(const Unit& unit, const Operation& o);
// The constant and the union member of an exception in M_I_op_Exception.
std::string exceptionLabel(const std::vector<const Declaration*>& family,
                           const Declaration& exception);

bool hasResults(const Operation& o);
bool isAmd(const Declaration& owner, const Operation& o);
bool isSliced(const Declaration& owner, const Operation& o);
// Classes among the parameters, or among the results and exceptions.
bool sendsClasses(const Operation& o);
bool returnsClasses(const Operation& o);
// Classes in one of the slots; in one that is not optional: encoding 1.0 has a list of instances
// then.
bool anyClass(const std::vector<Slot>& slots);
bool anyRequiredClass(const std::vector<Slot>& slots);

// "M_I_op"
std::string operationName(const Declaration& owner, const Operation& o);
std::string exceptionType(const Declaration& owner, const Operation& o);

// ", Ice_Int a, const M_S *b": in parameters; out parameters and the result as pointers; the same
// as values to be sent (of a response).
std::string inParameters(const Operation& o);
std::string outParameters(const Declaration& owner, const Operation& o);
std::string responseParameters(const Operation& o);

std::string proxySignature(const Declaration& d, const Operation& o);
std::string asyncSignature(const Declaration& d, const Operation& o);
// May it throw an exception that keeps unknown slices?
bool throwsPreserved(const Unit& unit, const Operation& o);
// `name` is a function's, or "(*op)"; `self` the servant's type.
std::string servantSignature(const Declaration& owner, const Operation& o, const std::string& name);
std::string responseSignature(const Declaration& d, const Operation& o);

// Parameters as slots. In parameters as the proxy's function has them; out ones behind `object`
// ("*" for pointers, "call->" for members, "" for variables).
std::vector<Slot> inSlots(const Operation& o);
std::vector<Slot> inVariables(const Operation& o);
std::vector<Slot> outSlots(const Operation& o, const std::string& object);
std::vector<Slot> responseSlots(const Operation& o);

#endif
