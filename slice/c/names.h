// SPDX-License-Identifier: MIT
//
// names: names and spellings of the C90 mapping (docs/slice-mapping.md).

#pragma once

#include "c/generator.h"
#include <string>

// True if IceC's headers use this name of C.
bool isRuntimeName(const std::string& c);
// Module_Sub_Name, with an underscore behind what would be a name of IceC
std::string cName(const Declaration& d);
// Module_Sub_NamePrx, of an interface or a class
std::string cProxy(const Declaration& d);
// Names in a scope that they share with names of generated code. These are listed in names.cpp, or
// begin with "ice_" or "Ice_". A user's name that equals one of them, or a word of C, gets an
// underscore at its end. No name in Slice ends with an underscore.
std::string cIdentifier(const std::string& name);
// The name of a member of struct, class or exception `d`.
std::string cMember(const Declaration& d, const Field& member);
// The name of a parameter: of functions, as a member of the asynchronous call, as a variable.
std::string cParameter(const Operation& o, const Field& parameter);
// The part of an operation's functions' names behind the interface's.
std::string cOperation(const std::string& name);
// The C type of a value.
std::string cType(const Type& type);
// The name of an enumerator's constant.
std::string cEnumerator(const Declaration& owner, const std::string& name);
// A constant's value as an expression; a Long's is an initialiser {low, high}.
std::string cValue(const Literal& value, const Type& type);
// The name of a thing that a Slice file has once: "Folder_File_what".
std::string cFileName(const CFileNames& names, const std::string& what);
// True if icec.h declares the type itself; only its stream functions are generated.
bool isRuntimeType(const Declaration& d);
// The elements that a sequence or dictionary has room for; 0 if its data lies elsewhere.
int statedMaximum(const Declaration& d);
