// SPDX-License-Identifier: MIT
//
// exceptions: generates the marshalling of exceptions, of the unions of exceptions that operations
// throw, and of classes.

#include "c/context.h"
#include <algorithm>
#include <set>

namespace {

// Returns whether the exception or one of its bases has a member that holds a class.
bool hasClasses(const Declaration& d) {
    return anyClass(memberSlots(d)) || (d.base() && hasClasses(*d.base()));
}

bool requiresClasses(const Declaration& d) {
    return anyRequiredClass(memberSlots(d)) || (d.base() && requiresClasses(*d.base()));
}

// Returns the C path from the exception to the member that stores slices of unknown types.
std::string unknownOf(const Declaration& d) {
    return d.base() && d.base()->preserves() ? "base." + unknownOf(*d.base()) : "ice_unknown";
}

// Returns whether the generated code needs a table of instances. Members that are classes need the
// table. Preserved slices also need it, because they may contain instances.
bool needsTables(const Declaration& d) {
    return hasClasses(d) || d.preserves();
}

void slicesFunctions(Writer& w, const Declaration& d, const Writer::Values& v) {
    w.block("void {c}_writeSlices(const {c} *v, Ice_OutputStreamPtr os)", v, [&] {
        std::string last = d.base() ? "0" : "1";
        w.line("Ice_Int slice = Ice_OutputStream_startSlice(os, \"{id}\", " + last + ");", v);
        writeSlots(w, memberSlots(d));
        w.line("Ice_OutputStream_endSlice(os, slice, " + last + ");");
        if (d.base())
            w.line(cName(*d.base()) + "_writeSlices(&v->base, os);");
        else if (d.fields.empty())
            w.line("(void)v;");
    });
    w.function("void {c}_readSlices({c} *v, Ice_InputStreamPtr is)", v, [&] {
        readSlots(w, memberSlots(d));
        w.line("Ice_InputStream_endSlice(is);");
        if (d.base()) {
            w.line("(void)Ice_InputStream_startSlice(is);");
            w.line(cName(*d.base()) + "_readSlices(&v->base, is);");
        } else if (d.fields.empty()) {
            w.line("(void)v;");
        }
    });
}

void writeFunction(Writer& w, const Declaration& d, const Writer::Values& v) {
    bool classes = needsTables(d);
    w.block("void {c}_writeToOutputStream(const {c} *v, Ice_OutputStreamPtr os)", v, [&] {
        if (classes) {
            w.line("Ice_OutputValues values;");
            w.line("Ice_OutputStream_beginValues(os, &values);");
            w.line("values.pending = {classes};", v);
        }
        w.line("Ice_OutputStream_startException(os, {classes});", v);
        if (d.preserves())
            w.line("Ice_OutputStream_writeUnknown(os, v->" + unknownOf(d) + ");");
        w.line("{c}_writeSlices(v, os);", v);
        if (classes)
            w.line("Ice_OutputStream_endValues(os);");
    });
}

} // namespace

void exceptionFunctions(Writer& w, const Declaration& d) {
    const Writer::Values v = {
        {"c", cName(d)}, {"id", d.id()}, {"classes", requiresClasses(d) ? "1" : "0"}};
    initFunction(w, d);
    w.blank();
    slicesFunctions(w, d, v);
    w.blank();
    writeFunction(w, d, v);
}

namespace {

// An exception that an operation may throw, and its names in the templates.
struct Thrown {
    const Declaration* exception;
    Writer::Values names;
};

std::vector<Thrown> thrownBy(const Unit& unit, const Declaration& d, const Operation& o) {
    std::vector<Thrown> all;
    auto family = mayThrow(unit, o);
    for (const Declaration* e : family)
        all.push_back({e,
                       {{"t", exceptionType(d, o)},
                        {"op", operationName(d, o)},
                        {"e", cName(*e)},
                        {"id", e->id()},
                        {"label", exceptionLabel(o, family, *e)},
                        {"member", exceptionMember(o, family, *e)}}});
    return all;
}

void writeThrown(Writer& w, const std::vector<Thrown>& family) {
    w.line("switch (v->type) {");
    for (const Thrown& e : family) {
        w.line("case {op}_{label}:", e.names);
        w.nested("{e}_writeToOutputStream(&v->u.{member}, os);", e.names);
        w.nested("break;");
    }
    w.single("default:", "os->failed = 1; /* the servant has not set the type */");
    w.line("}");
}

// Writes code that reads one slice and compares its type id with the type ids of the exceptions in
// `family`.
void readOneSlice(Writer& w, const std::vector<Thrown>& family, bool preserves) {
    w.line(std::string(preserves ? "" : "Ice_String ") + "id = Ice_InputStream_startSlice(is);");
    const char* otherwise = "";
    for (const Thrown& e : family) {
        w.line(std::string(otherwise) + "if (Ice_String_equals(id, \"{id}\")) {", e.names);
        w.nested("v->type = {op}_{label};", e.names);
        w.nested("{e}_readSlices(&v->u.{member}, is);", e.names);
        if (e.exception->preserves())
            w.nested("v->u.{member}." + unknownOf(*e.exception) + " = unknown;", e.names);
        otherwise = "} else ";
    }
    w.line("}");
}

} // namespace

void thrownFunctions(Writer& w, const CContext& c, const Declaration& d, const Operation& o) {
    const std::vector<Thrown> family = thrownBy(c.unit, d, o);
    Writer::Values v = {{"t", exceptionType(d, o)}, {"op", operationName(d, o)}};
    bool preserves = throwsPreserved(c.unit, o);
    bool classes = std::any_of(family.begin(), family.end(),
                               [](const Thrown& e) { return needsTables(*e.exception); });
    w.function("void {t}_writeToOutputStream(const {t} *v, Ice_OutputStreamPtr os)", v,
               [&] { writeThrown(w, family); });
    w.function("Ice_Status {t}_readFromInputStream({t} *v, Ice_InputStreamPtr is)", v, [&] {
        if (classes)
            w.line("Ice_InputValues values;");
        if (preserves) {
            w.line("Ice_UnknownSlice *unknown = 0;");
            w.line("Ice_String id;");
        }
        w.line("v->type = {op}_none;", v);
        if (classes)
            w.line("Ice_InputStream_beginValues(is, &values, " + c.valueTable() + ");");
        w.line("Ice_InputStream_startException(is);");
        w.line("do {");
        w.indented([&] { readOneSlice(w, family, preserves); });
        w.line("} while (v->type == {op}_none && Ice_InputStream_" +
                   std::string(preserves ? "keepSlice(is, id, &unknown));" : "skipSlice(is));"),
               v);
        if (classes)
            w.line("Ice_InputStream_endValues(is);");
        w.single("if (is->failed)", "return ICE_MARSHAL;");
        w.line("return v->type == {op}_none ? ICE_UNKNOWN_USER_EXCEPTION : ICE_USER_EXCEPTION;", v);
    });
}

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

// Returns three kinds of declarations: classes that the main file uses, interfaces that it passes
// by value, and interfaces derived from such interfaces.
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
    // a base comes before the types derived from it, so one pass finds all derived types
    for (const auto& d : unit.declarations)
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
