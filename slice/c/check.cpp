// SPDX-License-Identifier: MIT
//
// check: rejects valid Slice that cannot be mapped to C90.

#include "c/context.h"
#include "c/generator.h"
#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

namespace {

using DKind = Declaration::Kind;

void checkMetadata(const Declaration& d, Diagnostics& diagnostics) {
    for (const std::string& m : d.metadata) {
        if (m.compare(0, 2, "c:") != 0)
            continue;
        bool isList = d.kind == DKind::Sequence || d.kind == DKind::Dictionary;
        if (m.compare(0, 6, "c:max:") == 0 && isList) {
            std::string number = m.substr(6);
            bool digits = !number.empty() && number.size() <= 5 &&
                          number.find_first_not_of("0123456789") == std::string::npos;
            int n = digits ? std::stoi(number) : 0;
            if (n < 1 || n > 65535)
                diagnostics.error(d.at, "[\"" + m + "\"]: expected a maximum of 1 to 65535");
        } else if (m != "c:scoped" || d.kind != DKind::Enum) {
            diagnostics.warning(d.at, "metadata [\"" + m + "\"] has no effect here",
                                Diagnostics::Metadata);
        }
    }
}

void checkText(const Literal& value, const Location& at, Diagnostics& diagnostics) {
    constexpr size_t most = 509;
    if (value.kind == Literal::Kind::String && value.text.size() > most)
        diagnostics.error(at, "string of " + std::to_string(value.text.size()) +
                                  " bytes: expected at most " + std::to_string(most) +
                                  ", the length that C90 guarantees");
}

// The names at file scope in the generated C, each with its Slice name.
class CNames {
public:
    CNames(const Unit& unit, Diagnostics& diagnostics) : unit_(unit), diagnostics_(diagnostics) {}

    void add(const std::string& c, const std::string& slice, const Location& at) {
        auto [it, isNew] = names_.emplace(c, slice);
        bool isTaken = isRuntimeName(c) && slice != "::Ice::Identity";
        if (((!isNew && it->second != slice) || isTaken) && said_.insert(slice).second)
            diagnostics_.error(at, "'" + slice + "' and " +
                                       (isTaken ? "a name in IceC" : "'" + it->second + "'") +
                                       " would both be named '" + c + "' in C");
    }
    void add(const Declaration& d) {
        std::string c = cName(d), id = d.id();
        switch (d.kind) {
        case DKind::Interface:
            interface(d);
            break;
        case DKind::Class:
            proxy(d);
            each(c, {"", "_cast", "_declared", "_init", "_read", "_type", "_write"}, id, d.at);
            break;
        case DKind::Enum:
            add(c, id, d.at);
            for (const Enumerator& e : d.enumerators)
                addEnumerator(d, e);
            break;
        case DKind::Constant:
            add(c, id, d.at);
            break;
        default:
            each(c,
                 {"", "_Entry", "_find", "_init", "_readFromInputStream", "_readSlices",
                  "_writeSlices", "_writeToOutputStream"},
                 id, d.at);
        }
    }
    // Checks the C name of a member or parameter. The name must not be a macro, and must not equal
    // a name at file scope that the generated functions use; all names at file scope contain an
    // underscore.
    void checkInner(const std::string& c, const std::string& slice, const Location& at) {
        auto it = names_.find(c);
        if (it != names_.end())
            diagnostics_.error(at,
                               "'" + slice + "' has the same name in C as '" + it->second + "'");
    }

private:
    void each(const std::string& c, std::initializer_list<const char*> suffixes,
              const std::string& slice, const Location& at) {
        for (const char* suffix : suffixes)
            add(c + suffix, slice, at);
    }
    void interface(const Declaration& d) {
        std::string c = cName(d), id = d.id();
        proxy(d);
        each(c, {"", "Ptr", "_Operations", "_ice_interface", "_ice_type", "_init", "_initWith"}, id,
             d.at);
        for (const char* own : {"bases_", "dispatch_", "operations_"})
            add(own + c, id, d.at);
        if (d.fromInclude)
            return; // the names in an included file were checked when that file was compiled
        for (const Declaration* from : lineage(d))
            for (const Operation& o : from->operations) {
                std::string slice = from->id() + "::" + o.name;
                each(c + "_" + cOperation(o.name),
                     {"", "_Async", "_Exception", "_exception", "_none", "_response",
                      "_Exception_readFromInputStream", "_Exception_writeToOutputStream"},
                     slice, o.at);
                each(cProxy(d) + "_" + cOperation(o.name), {"", "_async", "_completed"}, slice,
                     o.at);
                add("dispatch_" + operationName(d, o), slice, o.at);
                auto family = mayThrow(unit_, o);
                for (const Declaration* e : family)
                    add(operationName(d, o) + "_" + exceptionLabel(o, family, *e),
                        slice + " throws " + e->id(), o.at);
            }
    }
    void proxy(const Declaration& d) {
        std::string ofValue = cName(d.ofClass ? *d.ofClass : d);
        add(ofValue + "_ice_staticId", d.id(), d.at);
        each(cProxy(d), {"", "Ptr", "_checkedCast", "_declared", "_uncheckedCast"}, d.id(), d.at);
    }
    void addEnumerator(const Declaration& d, const Enumerator& e) {
        std::string c = cEnumerator(d, e.name), id = d.id() + "::" + e.name;
        auto [it, isNew] = names_.emplace(c, id);
        if (!isNew && it->second != id)
            diagnostics_.error(e.at, "'" + id + "' and '" + it->second +
                                         "' (in another file) would both be named '" + c +
                                         "' in C; [\"c:scoped\"] before the enum adds the "
                                         "name of the enum");
    }

    const Unit& unit_;
    Diagnostics& diagnostics_;
    std::unordered_map<std::string, std::string> names_;
    std::set<std::string> said_;
};

void checkInner(const Declaration& d, CNames& names) {
    for (const Field& f : d.fields)
        names.checkInner(cMember(d, f), f.name, f.at);
    for (const Operation& o : d.operations) {
        names.checkInner(cIdentifier(o.name), o.name, o.at);
        for (const Field& p : o.parameters)
            names.checkInner(cParameter(o, p), p.name, p.at);
        for (const Declaration* e : o.throws)
            names.checkInner(exceptionMember(o, o.throws, *e), e->name, o.at);
    }
}

} // namespace

void scopeEnumerators(Unit& unit) {
    // source file of each Slice definition, by the C name of the definition
    std::map<std::string, std::string_view> files;
    for (const auto& d : unit.declarations)
        files.emplace(cName(*d), d->at.file);
    for (const auto& d : unit.declarations) {
        auto isTaken = [&](const Enumerator& e) {
            std::string c = cEnumerator(*d, e.name);
            auto it = files.find(c);
            return isRuntimeName(c) || (it != files.end() && it->second == d->at.file);
        };
        const auto& all = d->enumerators;
        if (!hasMetadata(d->metadata, "c:scoped") && std::any_of(all.begin(), all.end(), isTaken))
            d->metadata.push_back("c:scoped");
        for (const Enumerator& e : all)
            files.emplace(cEnumerator(*d, e.name), d->at.file);
    }
}

void checkC(const Unit& unit, const CFileNames& files, Diagnostics& diagnostics) {
    CNames names(unit, diagnostics);
    names.add(cFileName(files, "_ice_valueTypes"), files.base + "_ice_valueTypes", {});
    for (const auto& d : unit.declarations)
        if (!d->isLocal)
            names.add(*d);
    for (const auto& d : unit.declarations) {
        if (d->isLocal)
            continue;
        checkInner(*d, names);
        // this interface was generated from a class; errors are reported for that class
        if (d->ofClass)
            continue;
        checkMetadata(*d, diagnostics);
        checkText(d->value, d->at, diagnostics);
        for (const Field& f : d->fields)
            checkText(f.value, f.at, diagnostics);
        for (const Operation& o : d->operations)
            if (hasMetadata(o.metadata, ":broadcast") && (hasResults(o) || !o.throws.empty()))
                diagnostics.error(o.at, "[\":broadcast\"]: '" + o.name +
                                            "': expected no result and no exception, because a "
                                            "one-way call returns none");
    }
    for (const std::string& m : unit.metadata)
        if (m.compare(0, 2, "c:") == 0 && m.compare(0, 10, "c:include:") != 0)
            diagnostics.warning({diagnostics.intern(unit.file), 1, 1},
                                "metadata [[\"" + m + "\"]] has no effect here",
                                Diagnostics::Metadata);
}
