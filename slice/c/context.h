// SPDX-License-Identifier: MIT
//
// context: declarations that the generators of C share, grouped by the source file that defines
// them. At the end, one function for each generated file.

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
// Returns Module_Sub_Name, with an underscore appended if IceC uses that name.
std::string cName(const Declaration& d);
// Returns Module_Sub_NamePrx, the proxy type of an interface or a class.
std::string cProxy(const Declaration& d);
// Returns the C name for a name of the user. Generated code uses other names in the same scope:
// they are listed in names.cpp, or begin with "ice_" or "Ice_". A user's name that equals such a
// name, or a keyword of C, gets an underscore appended, which is safe because no name in Slice
// ends with an underscore.
std::string cIdentifier(const std::string& name);
// Returns the name of a member of the struct, class or exception `d`.
std::string cMember(const Declaration& d, const Field& member);
// Returns the C name of a parameter. Functions, variables, and the struct of an asynchronous call
// use the same name for the parameter.
std::string cParameter(const Operation& o, const Field& parameter);
// Returns the part of a C function name that stands for the operation; it follows the name of the
// interface.
std::string cOperation(const std::string& name);
// Returns the C type of a value.
std::string cType(const Type& type);
// Returns the name of the C constant for an enumerator.
std::string cEnumerator(const Declaration& owner, const std::string& name);
// Returns a constant's value as an expression. The value of a Long is an initialiser {low, high}.
std::string cValue(const Literal& value, const Type& type);
// Returns "Folder_File_what", a C name that is unique to a Slice file.
std::string cFileName(const CFileNames& names, const std::string& what);
// True if icec.h declares the type; slice2c then generates only its stream functions.
bool isRuntimeType(const Declaration& d);
// Returns the capacity, in elements, of a sequence or dictionary that stores its elements inside
// its struct; 0 if it stores them outside.
int statedMaximum(const Declaration& d);

// ---- types: pieces of C that pass, write and read values ----

// True if the type is passed by const pointer: all types except scalars, strings, enums and
// classes.
bool isByPointer(const Type& type);
bool isEnum(const Type& type);
bool isClass(const Type& type); // True if the type is a class, in C a pointer to an Ice_Value.

// Returns a declaration of `name`: "Ice_Int x", "M_Node *x".
std::string cVariable(const Type& type, const std::string& name);

// A member or parameter that generated code writes to a stream or reads from a stream.
struct Slot {
    const Type* type = nullptr;
    std::string value;   // its lvalue
    std::string pointer; // its address
    bool isOptional = false;
    int tag = 0;
    // C lvalue that is true if the value is present; code that writes the value tests this lvalue,
    // code that reads the value sets it
    std::string has;
};

// Generate the code that writes or reads slots in their order on the wire.
void writeSlots(Writer& w, const std::vector<Slot>& slots);
void readSlots(Writer& w, const std::vector<Slot>& slots);

// ---- operations: operations and exceptions in C: signatures, lists of parameters ----

// Returns an interface and all its bases. Each occurs once; the bases come before the interfaces
// that derive from them.
std::vector<const Declaration*> lineage(const Declaration& interface);

// Returns the exceptions that an operation may throw: the declared ones, and the exceptions of this
// unit that derive from them.
std::vector<const Declaration*> mayThrow(const Unit& unit, const Operation& o);
// Returns the label of an exception: its part of the constant M_I_op_<label>, and its member in the
// union.
std::string exceptionLabel(const Operation& o, const std::vector<const Declaration*>& family,
                           const Declaration& exception);
std::string exceptionMember(const Operation& o, const std::vector<const Declaration*>& family,
                            const Declaration& exception);

bool hasResults(const Operation& o);
bool isAmd(const Declaration& owner, const Operation& o);
bool isSliced(const Declaration& owner, const Operation& o);
// sendsClasses: true if an in parameter holds a class instance. returnsClasses: true if a result
// holds a class instance.
bool sendsClasses(const Operation& o);
bool returnsClasses(const Operation& o);
// True if a slot holds a class instance. The second function considers only required slots: if one
// of them holds an instance, encoding 1.0 adds a list of instances.
bool anyClass(const std::vector<Slot>& slots);
bool anyRequiredClass(const std::vector<Slot>& slots);

// "M_I_op"
std::string operationName(const Declaration& owner, const Operation& o);
std::string exceptionType(const Declaration& owner, const Operation& o);

// Return lists of C parameters; each parameter is preceded by a comma (", Ice_Int a, const M_S
// *b"). inParameters: the in parameters. outParameters: the out parameters, the result and the
// exception, as pointers. With `isSent`, pointers to class instances are const.
std::string inParameters(const Operation& o);
std::string outParameters(const Declaration& owner, const Operation& o, bool isSent);

std::string proxySignature(const Declaration& d, const Operation& o);
std::string asyncSignature(const Declaration& d, const Operation& o);
// True if the operation may throw an exception that preserves unknown slices.
bool throwsPreserved(const Unit& unit, const Operation& o);
// Returns the signature of a servant's function. `name` is the name of the function, or "(*op)" for
// a pointer; `self` is the servant's type.
std::string servantSignature(const Declaration& owner, const Operation& o, const std::string& name);
std::string responseSignature(const Declaration& d, const Operation& o);

// Return parameters as slots. inSlots: the in parameters of the proxy's function. inVariables: the
// in parameters as variables. outSlots: the results, with `object` before their names ("*" for
// pointers, "call->" for members, "" for variables). responseSlots: the results of a response.
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
    // Returns the name of the table of the classes in this unit. Only instances of these classes
    // can be received.
    std::string valueTable() const;
    bool usesClasses() const;
    Writer begin(const std::string& what) const;
    Writer beginSource(const std::string& what) const;
    // Returns the prefix ("M_I_op") in the name of an operation's exception union. Operations that
    // throw the same exceptions share one union, named after the first of these operations in the
    // file; an assignment is then enough to rethrow an exception.
    const std::string& thrownAs(const Operation& o) const { return thrown_.at(&o); }

    // Calls `f` for each declaration of kind `kind` in the main file, except local declarations.
    template <class F> void each(Declaration::Kind kind, F f) const {
        for (const auto& d : unit.declarations)
            if (d->kind == kind && !d->fromInclude && !d->isLocal)
                f(*d);
    }
    // Calls `f` for each operation of the main file's interfaces; the arguments are interface and
    // operation.
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

// Returns the signature of a dictionary's M_D_find; empty if its keys cannot be compared.
std::string findSignature(const Declaration& d);
// Write the functions for an exception, and for the union of the exceptions that an operation
// throws.
void exceptionFunctions(Writer& w, const Declaration& d);
void thrownFunctions(Writer& w, const CContext& c, const Declaration& d, const Operation& o);
// Write the descriptor and the functions of a class, and the table of all descriptors.
void classFunctions(Writer& w, const Declaration& d);
void valueTypeTable(Writer& w, const CContext& c);

// ---- members of structs, classes and exceptions: default values and marshalling; if a member is a
// class, marshalling includes the table of instances ----

// Writes the function M_T_init, which sets every member to zero or its default.
void initFunction(Writer& w, const Declaration& d);
// Returns the members that `d` declares itself, as slots of the variable `v`.
std::vector<Slot> memberSlots(const Declaration& d);
// Generate the code that writes or reads slots. If a slot holds a class, the variable `table`
// collects the instances.
void writeWithValues(Writer& w, const std::vector<Slot>& slots, const std::string& table);
void readWithValues(Writer& w, const CContext& c, const std::vector<Slot>& slots,
                    const std::string& table);
