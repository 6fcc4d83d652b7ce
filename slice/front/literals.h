// SPDX-License-Identifier: MIT
//
// literals: values of number and string tokens.

#ifndef SLICE_FRONT_LITERALS_H
#define SLICE_FRONT_LITERALS_H

#include "front/lexer.h"
#include <cstdint>
#include <string>

// Decimal, 0octal or 0xhex, signed; out of range or malformed is an error, and 0.
int64_t integerValue(const Token& token, Diagnostics& diagnostics);
double floatingValue(const Token& token, Diagnostics& diagnostics);
// Returns the bytes of a string literal, its escapes replaced; \u and \U become UTF-8.
std::string stringValue(const Token& token, Diagnostics& diagnostics);

#endif
