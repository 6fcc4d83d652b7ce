// SPDX-License-Identifier: MIT
//
// operations: operations and exceptions in C: signatures, lists of parameters.

#pragma once

#include "c/types.h"
#include "front/ast.h"
#include <string>
#include <vector>

// Base interfaces first, without repetition; the interface itself comes last.
std::vector<const Declaration*> lineage(const Declaration& interface);

// The exceptions that an operation may throw: its own, and those derived from them in this unit.
std::vector<const Declaration*> mayThrow(const Unit& unit, const Operation& o);
// The label of an exception in M_I_op_Exception, whose constant is M_I_op_<label>; and its member
// in the union.
std::string exceptionLabel(const Operation& o, const std::vector<const Declaration*>& family,
                           const Declaration& exception);
std::string exceptionMember(const Operation& o, const std::vector<const Declaration*>& family,
                            const Declaration& exception);

bool hasResults(const Operation& o);
bool isAmd(const Declaration& owner, const Operation& o);
bool isSliced(const Declaration& owner, const Operation& o);
// True if classes are among the in parameters (sends), among the results (returns).
bool sendsClasses(const Operation& o);
bool returnsClasses(const Operation& o);
// True if one of the slots holds a class; if a required one does (encoding 1.0 has a list of
// instances then).
bool anyClass(const std::vector<Slot>& slots);
bool anyRequiredClass(const std::vector<Slot>& slots);

// "M_I_op"
std::string operationName(const Declaration& owner, const Operation& o);
std::string exceptionType(const Declaration& owner, const Operation& o);

// Lists of C parameters, each with a comma before it (", Ice_Int a, const M_S *b"): the in
// parameters; out parameters and the result as pointers. A servant's instances, which are sent, may
// be const.
std::string inParameters(const Operation& o);
std::string outParameters(const Declaration& owner, const Operation& o, bool isSent);

std::string proxySignature(const Declaration& d, const Operation& o);
std::string asyncSignature(const Declaration& d, const Operation& o);
// True if it may throw an exception that keeps unknown slices.
bool throwsPreserved(const Unit& unit, const Operation& o);
// `name` is a function, or "(*op)"; `self` the servant's type.
std::string servantSignature(const Declaration& owner, const Operation& o, const std::string& name);
std::string responseSignature(const Declaration& d, const Operation& o);

// Parameters as slots: in parameters of the proxy's function; as variables; results behind `object`
// ("*" for pointers, "call->" for members, "" for variables); results of a response.
std::vector<Slot> inSlots(const Operation& o);
std::vector<Slot> inVariables(const Operation& o);
std::vector<Slot> outSlots(const Operation& o, const std::string& object);
std::vector<Slot> responseSlots(const Operation& o);
