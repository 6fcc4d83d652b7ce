// SPDX-License-Identifier: MIT
//
// exceptions: marshalling of exceptions, and of operations' exception unions.

#include "c/context.h"
#include "c/names.h"

namespace {

// True if its members, or those of its bases, hold classes.
bool hasClasses(const Declaration& d) {
    return anyClass(memberSlots(d)) || (d.base() && hasClasses(*d.base()));
}

bool requiresClasses(const Declaration& d) {
    return anyRequiredClass(memberSlots(d)) || (d.base() && requiresClasses(*d.base()));
}

// Returns the path from an exception to the member that keeps unknown slices.
std::string unknownOf(const Declaration& d) {
    return d.base() && d.base()->preserves() ? "base." + unknownOf(*d.base()) : "ice_unknown";
}

// True if the code needs a table of instances; kept slices may hold instances, too.
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

void thrownFunctions(Writer& w, const CContext& c, const Declaration& d, const Operation& o) {
    auto family = mayThrow(c.unit, o);
    Writer::Values v = {{"t", exceptionType(d, o)}, {"op", operationName(d, o)}};
    bool classes = false, preserves = throwsPreserved(c.unit, o);
    for (const Declaration* e : family)
        classes = classes || needsTables(*e);
    auto eachOf = [&](auto f) {
        for (const Declaration* e : family) {
            f(*e, Writer::Values{{"t", exceptionType(d, o)},
                                 {"op", operationName(d, o)},
                                 {"e", cName(*e)},
                                 {"id", e->id()},
                                 {"label", exceptionLabel(o, family, *e)},
                                 {"member", exceptionMember(o, family, *e)}});
        }
    };
    w.function("void {t}_writeToOutputStream(const {t} *v, Ice_OutputStreamPtr os)", v, [&] {
        w.line("switch (v->type) {");
        eachOf([&](const Declaration&, const Writer::Values& names) {
            w.line("case {op}_{label}:", names);
            w.nested("{e}_writeToOutputStream(&v->u.{member}, os);", names);
            w.nested("break;");
        });
        w.single("default:", "os->failed = 1; /* the servant has not said which */");
        w.line("}");
    });
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
        w.nested(std::string(preserves ? "" : "Ice_String ") +
                 "id = Ice_InputStream_startSlice(is);");
        bool first = true;
        eachOf([&](const Declaration& e, const Writer::Values& names) {
            w.nested(std::string(first ? "" : "} else ") + "if (Ice_String_equals(id, \"{id}\")) {",
                     names);
            w.nested("    v->type = {op}_{label};", names);
            w.nested("    {e}_readSlices(&v->u.{member}, is);", names);
            if (e.preserves())
                w.nested("    v->u.{member}." + unknownOf(e) + " = unknown;", names);
            first = false;
        });
        w.nested("}");
        w.line(
            preserves
                ? "} while (v->type == {op}_none && Ice_InputStream_keepSlice(is, id, &unknown));"
                : "} while (v->type == {op}_none && Ice_InputStream_skipSlice(is));",
            v);
        if (classes)
            w.line("Ice_InputStream_endValues(is);");
        w.single("if (is->failed)", "return ICE_MARSHAL;");
        w.line("return v->type == {op}_none ? ICE_UNKNOWN_USER_EXCEPTION : ICE_USER_EXCEPTION;", v);
    });
}
