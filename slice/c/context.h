// SPDX-License-Identifier: MIT
//
// context: what the generated files of a unit share, and one function for each of them.

#pragma once

#include "c/generator.h"
#include "c/operations.h"
#include "text/writer.h"
#include <map>

struct CContext {
    const Unit& unit;
    const CFileNames& names;

    CContext(const Unit& ofFile, const CFileNames& ofFiles);
    std::string header() const;
    // The name of the table of classes that this unit knows, and so can receive.
    std::string valueTable() const;
    bool usesClasses() const;
    Writer begin(const std::string& what) const;
    Writer beginSource(const std::string& what) const;
    // Returns the prefix ("M_I_op") of an operation's exception union: that of the first operation
    // in the file that throws the same, so that an exception is thrown again by an assignment.
    const std::string& thrownAs(const Operation& o) const { return thrown_.at(&o); }

    // Calls `f` for each declaration of the main file of this kind, local ones aside.
    template <class F> void each(Declaration::Kind kind, F f) const {
        for (const auto& d : unit.declarations)
            if (d->kind == kind && !d->fromInclude && !d->isLocal)
                f(*d);
    }
    // Calls `f` for each interface of the main file with each of its own operations.
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
// Write an exception's functions, and those of an operation's exception union.
void exceptionFunctions(Writer& w, const Declaration& d);
void thrownFunctions(Writer& w, const CContext& c, const Declaration& d, const Operation& o);
// Write a class's descriptor with its functions, and the table of all descriptors.
void classFunctions(Writer& w, const Declaration& d);
void valueTypeTable(Writer& w, const CContext& c);

// ---- members of a struct, class or exception: defaults, and marshalling with the table of
// instances for classes among them ----

// The function M_T_init, which sets every member to zero or its default.
void initFunction(Writer& w, const Declaration& d);
// Returns the own members of `d` as slots of the variable `v`.
std::vector<Slot> memberSlots(const Declaration& d);
// Writes or reads slots. Where one holds a class, the variable `table` collects the instances.
void writeWithValues(Writer& w, const std::vector<Slot>& slots, const std::string& table);
void readWithValues(Writer& w, const CContext& c, const std::vector<Slot>& slots,
                    const std::string& table);
