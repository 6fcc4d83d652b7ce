// SPDX-License-Identifier: MIT
//
// c_files: the generated files, one function each, and what they share.

#ifndef C_FILES_H
#define C_FILES_H

#include "c_generator.h"
#include "c_operations.h"
#include "writer.h"

struct CContext {
    const Unit& unit;
    const CFileNames& names;

    std::string header() const;
    // The table of all classes that this unit knows: what may be received.
    std::string valueTable() const;
    // The table of checksums, where one is wanted.
    std::string checksumTable() const;
    bool usesClasses() const;
    Writer begin(const std::string& what) const;
    Writer beginSource(const std::string& what) const;

    // What this file declares, local definitions aside.
    template <class F> void each(Declaration::Kind kind, F f) const {
        for (const auto& d : unit.declarations)
            if (d->kind == kind && !d->fromInclude && !d->isLocal)
                f(*d);
    }
    // Interfaces and their own operations.
    template <class F> void eachOperation(F f) const {
        each(Declaration::Kind::Interface, [&](const Declaration& d) {
            for (const Operation& o : d.operations)
                f(d, o);
        });
    }
};

std::string headerFile(const CContext& c);
std::string typesFile(const CContext& c);
std::string clientFile(const CContext& c);
std::string asyncFile(const CContext& c);
std::string serverFile(const CContext& c);

// Parts of the types file: exceptions, and the union of what an operation throws; classes.
void exceptionFunctions(Writer& w, const CContext& c, const Declaration& d);
void thrownFunctions(Writer& w, const CContext& c, const Declaration& d, const Operation& o);
void classFunctions(Writer& w, const Declaration& d);
void valueTypeTable(Writer& w, const CContext& c);
// Zero and the defaults, for all of them.
void initFunction(Writer& w, const Declaration& d);
// Members as slots of `v`.
std::vector<Slot> memberSlots(const Declaration& d);
// Writes or reads slots; where they hold classes, within a table of instances of this name.
void writeWithValues(Writer& w, const std::vector<Slot>& slots, const std::string& table);
void readWithValues(Writer& w, const CContext& c, const std::vector<Slot>& slots,
                    const std::string& table);

#endif
