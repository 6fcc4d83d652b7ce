// SPDX-License-Identifier: MIT
//
// context: declarations shared by the generators of C, grouped by the source that defines them, and
// one function for each generated file.

#pragma once

#include "c/generator.h"
#include "front/ast.h"
#include "text/writer.h"
#include <map>
#include <string>
#include <vector>

// ---- names: names and spellings of the C90 mapping (docs/slice-mapping.md) ----

// True if IceC's headers use this name of C.
bool isRuntimeName(const std::string& c);
// Module_Sub_Name, with an underscore appended if IceC uses that name
std::string cName(const Declaration& d);
// Module_Sub_NamePrx, of an interface or a class
std::string cProxy(const Declaration& d);
// Returns the C name for a name of the user. Generated code uses other names in the same scope:
// they are listed in names.cpp, or begin with "ice_" or "Ice_". A name that equals one of them, or
// a keyword of C, gets an underscore appended. No name in Slice ends with an underscore.
std::string cIdentifier(const std::string& name);
// The name of a member of struct, class or exception `d`.
std::string cMember(const Declaration& d, const Field& member);
// The name of a parameter: of functions, as a member of the asynchronous call, as a variable.
std::string cParameter(const Operation& o, const Field& parameter);
// Returns the part of a function name that stands for the operation, after the interface.
std::string cOperation(const std::string& name);
// The C type of a value.
std::string cType(const Type& type);
// The name of an enumerator's constant.
std::string cEnumerator(const Declaration& owner, const std::string& name);
// A constant's value as an expression; a Long's is an initialiser {low, high}.
std::string cValue(const Literal& value, const Type& type);
// Name of an item that each Slice file has once: "Folder_File_what".
std::string cFileName(const CFileNames& names, const std::string& what);
// True if icec.h declares the type itself; only its stream functions are generated.
bool isRuntimeType(const Declaration& d);
// The elements that a sequence or dictionary has room for; 0 if its data lies elsewhere.
int statedMaximum(const Declaration& d);

// ---- types: pieces of C that pass, write and read values ----

// True if the type is passed by const pointer: all types except scalars, strings, enums and
// classes.
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
    std::string has; // condition whether it is present when writing, an lvalue when reading
};

// Write or read slots in the order of the wire.
void writeSlots(Writer& w, const std::vector<Slot>& slots);
void readSlots(Writer& w, const std::vector<Slot>& slots);

// ---- operations: operations and exceptions in C: signatures, lists of parameters ----

// Base interfaces first, without repetition; the interface itself is last.
std::vector<const Declaration*> lineage(const Declaration& interface);

// Exceptions that an operation may throw: the declared ones, and exceptions derived from them in
// this unit.
std::vector<const Declaration*> mayThrow(const Unit& unit, const Operation& o);
// Label of an exception in M_I_op_Exception (constant M_I_op_<label>), and its member in the union.
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
// True if one of the slots holds a class; if a required one does (encoding 1.0 then has a list of
// instances).
bool anyClass(const std::vector<Slot>& slots);
bool anyRequiredClass(const std::vector<Slot>& slots);

// "M_I_op"
std::string operationName(const Declaration& owner, const Operation& o);
std::string exceptionType(const Declaration& owner, const Operation& o);

// Lists of C parameters, each preceded by a comma (", Ice_Int a, const M_S *b"): the in parameters;
// out parameters and the result as pointers. Instances of a servant, which are sent, may be const.
std::string inParameters(const Operation& o);
std::string outParameters(const Declaration& owner, const Operation& o, bool isSent);

std::string proxySignature(const Declaration& d, const Operation& o);
std::string asyncSignature(const Declaration& d, const Operation& o);
// True if it may throw an exception that preserves unknown slices.
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

// ---- context: data of a whole unit ----

struct CContext {
    const Unit& unit;
    const CFileNames& names;

    CContext(const Unit& ofFile, const CFileNames& ofFiles);
    std::string header() const;
    // Name of the table of classes that this unit knows, and so can receive.
    std::string valueTable() const;
    bool usesClasses() const;
    Writer begin(const std::string& what) const;
    Writer beginSource(const std::string& what) const;
    // Returns the prefix ("M_I_op") of the exception union of an operation. Operations that throw
    // the same exceptions use the union of the first one in the file, so that an exception can be
    // rethrown by an assignment.
    const std::string& thrownAs(const Operation& o) const { return thrown_.at(&o); }

    // Calls `f` for each declaration of this kind in the main file, except local ones.
    template <class F> void each(Declaration::Kind kind, F f) const {
        for (const auto& d : unit.declarations)
            if (d->kind == kind && !d->fromInclude && !d->isLocal)
                f(*d);
    }
    // Calls `f` for each interface of the main file and each operation that the interface declares.
    template <class F> void eachOperation(F f) const {
        each(Declaration::Kind::Interface, [&](const Declaration& d) {
            for (const Operation& o : d.operations)
                f(d, o);
        });
    }

private:
    std::map<const Operation*, std::string> thrown_;
};

// ---- the files ----

std::string headerFile(const CContext& c);
std::string typesFile(const CContext& c);
std::string clientFile(const CContext& c);
std::string asyncFile(const CContext& c);
std::string serverFile(const CContext& c);

// M_D_find of a dictionary; empty where its keys cannot be compared.
std::string findSignature(const Declaration& d);
// Write the functions of an exception and of an operation's exception union.
void exceptionFunctions(Writer& w, const Declaration& d);
void thrownFunctions(Writer& w, const CContext& c, const Declaration& d, const Operation& o);
// Write a class's descriptor with its functions, and the table of all descriptors.
void classFunctions(Writer& w, const Declaration& d);
void valueTypeTable(Writer& w, const CContext& c);

// ---- members of a struct, class or exception: defaults, and marshalling with the table of
// instances for classes among them ----

// The function M_T_init, which sets every member to zero or its default.
void initFunction(Writer& w, const Declaration& d);
// Returns the members that `d` declares itself, as slots of the variable `v`.
std::vector<Slot> memberSlots(const Declaration& d);
// Writes or reads slots. If one holds a class, the variable `table` collects the instances.
void writeWithValues(Writer& w, const std::vector<Slot>& slots, const std::string& table);
void readWithValues(Writer& w, const CContext& c, const std::vector<Slot>& slots,
                    const std::string& table);
