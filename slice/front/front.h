// SPDX-License-Identifier: MIT
//
// front: the front end of the Slice compiler: converts the text of a file into a unit. It does not
// depend on the command line.
//
// A file passes through these steps, each in a source file of that name:
//
//   preprocessor   #include, #define and #if, by libmcpp; comments are kept, #line gives the origin
//   lexer          text into tokens, each with its place in the original file and its doc comment
//   parser         tokens into declarations by recursive descent: parser.cpp has tokens, recovery
//                  and modules, parser_data, parser_interface and parser_types one method for each
//                  rule; each declaration is checked at the end of its rule
//   symbols        identifiers that Slice allows, and what a name means in its scope; the parser
//                  resolves every name at once
//   literals       converts numbers and strings as written into values
//   ast            the result: a Unit of declarations, in source order, all names resolved
//   front          adds an interface for each class that can be called
//   diagnostics    every error and warning of all steps, with the source line and a caret
//
// A step reports errors and continues; a unit is valid if no error was reported.

#pragma once

#include "front/symbols.h"
#include <string>
#include <vector>

// Result of preprocessing one file with libmcpp.
struct Preprocessed {
    bool ok = false;
    // text of the file and of all included files, with #line markers and comments
    std::string text;
    std::string messages;              // messages of the preprocessor
    std::vector<std::string> files;    // the file and all files included, at any depth
    std::vector<std::string> includes; // files included directly
};

// Preprocesses a file. `options` are -I, -D and -U as for the C preprocessor.
Preprocessed preprocess(const std::string& file, const std::vector<std::string>& options);

// Returns the unit of a preprocessed file. Errors are reported to `diagnostics`.
Unit compileUnit(const std::string& text, const std::string& file, NameRules rules,
                 Diagnostics& diagnostics);
