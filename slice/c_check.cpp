// SPDX-License-Identifier: MIT
//
// c_check: what Slice allows and C90 does not.

#include "c_generator.h"
#include "c_names.h"
#include "c_types.h"
#include <map>
#include <set>

namespace {

using DKind = Declaration::Kind;

// A ":hw" interface: numbers, enums, structs and sequences of them; exceptions of them; proxies
// that are told of events. No more fits into registers.
void checkHardware(const Declaration& d, Diagnostics& diagnostics) {
    std::string who = "interface '" + d.name + "' is hardware ([\":hw\"]): '";
    const char* kinds = "a number, an enum, a struct or a sequence of them";
    for (const Operation& o : d.operations) {
        if (!factsOf(o.result).isNumeric)
            diagnostics.error(o.at, who + o.name + "' must return " + kinds);
        for (const Declaration* e : o.throws)
            for (const Declaration* part = e; part; part = part->base())
                for (const Field& f : part->fields)
                    if (!factsOf(f.type).isNumeric || f.isOptional)
                        diagnostics.error(o.at, who + o.name + "' throws '" + e->name +
                                                    "', whose '" + f.name + "' is not " + kinds);
        for (const Field& p : o.parameters)
            if (p.isOptional ||
                !(factsOf(p.type).isNumeric || (p.type.kind == Type::Kind::Proxy && !p.isOut)))
                diagnostics.error(p.at, who + p.name + "' must be " + kinds +
                                            ", or the proxy of a callback interface");
    }
}

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
                diagnostics.error(d.at, "[\"" + m + "\"]: the maximum is a number, 1..65535");
        } else if (m != "c:scoped" || d.kind != DKind::Enum) {
            diagnostics.warning(d.at, "metadata [\"" + m + "\"] means nothing here",
                                Diagnostics::Metadata);
        }
    }
}

// Every name that the generated C has at file scope, and the Slice name it comes from.
class CNames {
public:
    explicit CNames(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    void add(const std::string& c, const std::string& slice, const Location& at) {
        auto [it, isNew] = names_.emplace(c, slice);
        if (!isNew && it->second != slice && said_.insert(slice).second) // once for each
            diagnostics_.error(at, "'" + slice + "' becomes '" + c + "' in C, as '" + it->second +
                                       "' does");
    }
    void add(const Declaration& d) {
        std::string c = d.cName(), id = d.id();
        if (d.kind == DKind::Interface) {
            for (const char* suffix : {"Ptr", "", "_init", "_initWith", "_Operations"})
                add(c + suffix, id, d.at);
            proxy(d);
            for (const Operation& o : d.operations)
                for (const char* suffix : {"", "_Async", "_Exception", "_response", "_exception"})
                    add(c + "_" + cOperation(o.name) + suffix, id + "::" + o.name, o.at);
            return;
        }
        add(c, id, d.at);
        if (d.kind == DKind::Class)
            proxy(d);
        if (d.kind == DKind::Enum)
            for (const Enumerator& e : d.enumerators)
                addEnumerator(d, e);
        if (d.kind == DKind::Dictionary)
            add(c + "_Entry", id, d.at);
        if (d.kind != DKind::Constant && d.kind != DKind::Enum)
            for (const char* suffix :
                 {"_init", "_type", "_find", "_writeToOutputStream", "_readFromInputStream"})
                add(c + suffix, id, d.at);
    }

private:
    void proxy(const Declaration& d) {
        add(d.cProxy(), d.id(), d.at);
        add(d.cProxy() + "Ptr", d.id(), d.at);
    }
    void addEnumerator(const Declaration& d, const Enumerator& e) {
        std::string c = cEnumerator(d, e.name), id = d.id() + "::" + e.name;
        auto [it, isNew] = names_.emplace(c, id);
        if (!isNew && it->second != id)
            diagnostics_.error(e.at,
                               "'" + id + "' becomes '" + c + "' in C, as '" + it->second +
                                   "' does; [\"c:scoped\"] before the enum puts its name between");
    }

    Diagnostics& diagnostics_;
    std::map<std::string, std::string> names_;
    std::set<std::string> said_;
};

// has_x, which an optional member brings, may be another member's name.
void checkOptionalNames(const std::vector<Field>& fields, Diagnostics& diagnostics) {
    for (const Field& f : fields)
        for (const Field& other : fields)
            if (f.isOptional && other.name == "has_" + f.name)
                diagnostics.error(other.at, "'" + other.name + "' says in C whether '" + f.name +
                                                "' is there");
}

} // namespace

void checkC(const Unit& unit, Diagnostics& diagnostics) {
    CNames names(diagnostics);
    for (const auto& d : unit.declarations) {
        if (d->isLocal)
            continue;
        names.add(*d);
        if (d->ofClass) // the rest is said of the class
            continue;
        checkMetadata(*d, diagnostics);
        checkOptionalNames(d->fields, diagnostics);
        for (const Operation& o : d->operations)
            checkOptionalNames(o.parameters, diagnostics);
        if (d->kind == DKind::Interface && d->isHardware())
            checkHardware(*d, diagnostics);
    }
    for (const std::string& m : unit.metadata)
        if (m.compare(0, 2, "c:") == 0 && m.compare(0, 10, "c:include:") != 0)
            diagnostics.warning({diagnostics.intern(unit.file), 1, 1},
                                "metadata [[\"" + m + "\"]] means nothing here",
                                Diagnostics::Metadata);
}
