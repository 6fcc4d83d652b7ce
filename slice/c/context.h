// SPDX-License-Identifier: MIT
//
// context: shared by all generated files of a unit.

#ifndef SLICE_C_CONTEXT_H
#define SLICE_C_CONTEXT_H

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
    // The name of the table of checksums.
    std::string checksumTable() const;
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

#endif
