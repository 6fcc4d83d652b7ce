// SPDX-License-Identifier: MIT
//
// c_names: names and spellings of the C90 mapping (docs/slice-mapping.md).

#ifndef C_NAMES_H
#define C_NAMES_H

#include "ast.h"
#include <string>

// A member's or parameter's name: an underscore behind what C or the generated code has taken.
std::string cIdentifier(const std::string& name);
// The part of an operation's functions' names behind the interface's.
std::string cOperation(const std::string& name);
// The C type of a value.
std::string cType(const Type& type);
// An enumerator's constant.
std::string cEnumerator(const Declaration& owner, const std::string& name);
// A constant's value as an expression; Long: an initialiser {low, high}.
std::string cValue(const Literal& value, const Type& type);
// "text" with escapes, so that any bytes survive.
std::string cString(const std::string& bytes);
// Declared by icec.h itself: only the stream functions are generated.
bool isRuntimeType(const Declaration& d);
// 0: the data lies elsewhere; otherwise the elements that a sequence or dictionary has room for.
int statedMaximum(const Declaration& d);

#endif
