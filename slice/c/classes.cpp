// SPDX-License-Identifier: MIT
//
// classes: descriptors of classes, by which the run time reads and writes graphs.

#include "c/context.h"
#include "c/names.h"
#include <set>

void classFunctions(Writer& w, const Declaration& d) {
    Writer::Values v = {{"c", cName(d)}, {"id", d.id()}};
    auto function = [&](std::string_view head, std::string_view object, const char* unused,
                        auto body) {
        w.function(head, v, [&] {
            w.line(d.fields.empty() ? "(void)object;" : object, v);
            if (d.fields.empty())
                w.line(unused);
            body(w, memberSlots(d));
        });
    };
    initFunction(w, d);
    function("static void {c}_write(const void *object, Ice_OutputStreamPtr os)",
             "const {c} *v = (const {c} *)object;", "(void)os;", writeSlots);
    function("static void {c}_read(void *object, Ice_InputStreamPtr is)", "{c} *v = ({c} *)object;",
             "(void)is;", readSlots);
    w.blank();
    std::string base = d.base() ? "&" + cName(*d.base()) + "_type" : "0";
    w.line("const Ice_ValueType {c}_type = {", v);
    w.line("    \"{id}\", " + base + ", " + std::to_string(d.compactId) +
               ", (Ice_Int)sizeof({c}), " + (d.preserves() ? "1" : "0") + ", {c}_write, {c}_read};",
           v);
}

// The classes that the main file's types mention and do not define, the interfaces that they
// mention by value, and types derived from these.
static std::set<const Declaration*> mentioned(const Unit& unit) {
    std::set<const Declaration*> found;
    auto add = [&](const Type& t) {
        bool isValue =
            t.kind == Type::Kind::Value ||
            (t.kind == Type::Kind::Named && t.declaration->kind == Declaration::Kind::Class);
        if (isValue && t.declaration)
            found.insert(t.declaration);
    };
    for (const auto& d : unit.declarations) {
        if (d->fromInclude || d->isLocal)
            continue;
        add(d->key);
        add(d->element);
        for (const Field& f : d->fields)
            add(f.type);
        for (const Operation& o : d->operations) {
            add(o.result);
            for (const Field& p : o.parameters)
                add(p.type);
        }
    }
    for (const auto& d : unit.declarations) // bases come before derived types
        for (const Declaration* base : d->bases)
            if (d->kind == Declaration::Kind::Interface && found.count(base))
                found.insert(d.get());
    return found;
}

// Writes the types of interfaces passed by value: instances without members.
static void interfaceTypes(Writer& w, const std::vector<const Declaration*>& interfaces) {
    if (interfaces.empty())
        return;
    w.function("static void ice_write(const void *object, Ice_OutputStreamPtr os)", {}, [&] {
        w.line("(void)object;");
        w.line("(void)os;");
    });
    w.function("static void ice_read(void *object, Ice_InputStreamPtr is)", {}, [&] {
        w.line("(void)object;");
        w.line("(void)is;");
    });
    w.blank();
    for (const Declaration* d : interfaces) {
        w.line("static const Ice_ValueType {c}_ice_type = {", {{"c", cName(*d)}});
        w.line("    \"" + d->id() +
               "\", 0, -1, (Ice_Int)sizeof(Ice_Value), 0, ice_write, ice_read};");
    }
}

void valueTypeTable(Writer& w, const CContext& c) {
    std::set<const Declaration*> used = mentioned(c.unit);
    std::vector<const Declaration*> interfaces;
    for (const auto& d : c.unit.declarations)
        if (d->kind == Declaration::Kind::Interface && used.count(d.get()))
            interfaces.push_back(d.get());
    interfaceTypes(w, interfaces);
    w.blank();
    w.line("const Ice_ValueType *const " + c.valueTable() + "[] = {");
    for (const auto& d : c.unit.declarations)
        if (d->kind == Declaration::Kind::Class && !d->isLocal &&
            (!d->isForward || used.count(d.get())))
            w.line("    &" + cName(*d) + "_type,");
    for (const Declaration* d : interfaces)
        w.line("    &" + cName(*d) + "_ice_type,");
    w.line("    0};");
}
