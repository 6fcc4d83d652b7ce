// SPDX-License-Identifier: MIT
//
// header: generates the header with types, constants, proxies and servants, and returns the list of
// all generated files.

#include "c/context.h"
#include "text/doc_comment.h"

namespace {

using DKind = Declaration::Kind;

// Writes forward declarations. Several files may declare an interface or class, but C90 allows only
// one typedef.
void forwardDeclarations(Writer& w, const CContext& c) {
    for (const auto& d : c.unit.declarations) {
        bool isClass = d->kind == DKind::Class;
        if (d->fromInclude || d->isLocal || d->ofClass || (!isClass && d->kind != DKind::Interface))
            continue;
        Writer::Values v = {{"c", cName(*d)}};
        w.blank();
        w.line(isClass ? "#ifndef {c}_declared" : "#ifndef {c}Prx_declared", v);
        w.line(isClass ? "#define {c}_declared" : "#define {c}Prx_declared", v);
        if (isClass) {
            w.line("typedef struct {c} {c};", v);
            w.line("extern const Ice_ValueType {c}_type;", v);
        }
        w.line("typedef Ice_ObjectPrx {c}Prx, *{c}PrxPtr;", v);
        w.line("#endif");
    }
}

void declareConstant(Writer& w, const Declaration& d) {
    std::string value = cValue(d.value, d.element), name = cName(d);
    switch (d.element.kind) {
    case Type::Kind::Long:
        w.line("extern const Ice_Long " + name + ";");
        break;
    case Type::Kind::String:
        w.line("#define " + name + " " + value);
        break;
    default:
        w.line("#define " + name + " ((" + cType(d.element) + ")" +
               (value[0] == '-' ? "(" + value + ")" : value) + ")");
    }
}

void declareEnum(Writer& w, const Declaration& d) {
    w.type("enum", cName(d), [&] {
        for (const Enumerator& e : d.enumerators) {
            writeDoc(w, e.doc);
            w.line(cEnumerator(d, e.name) + " = " + std::to_string(e.value) +
                   (&e == &d.enumerators.back() ? "" : ","));
        }
    });
}

void declareFields(Writer& w, const Declaration& d) {
    for (const Field& f : d.fields) {
        writeDoc(w, f.doc, f.metadata);
        if (f.isOptional)
            w.line("Ice_Bool has_" + f.name + ";");
        w.line(cVariable(f.type, cMember(d, f)) + ";");
    }
}

// Writes the members of a sequence or dictionary of `element`.
void declareElements(Writer& w, const Declaration& d, const std::string& element) {
    int maximum = statedMaximum(d);
    bool pointer = element.back() == '*';
    w.type("struct", cName(d), [&] {
        w.line("Ice_Int size;");
        std::string name = maximum ? "data[" + std::to_string(maximum) + "]" : "*data";
        w.line(element + (pointer ? "" : " ") + name + ";");
    });
}

void declareStruct(Writer& w, const Declaration& d) {
    Writer::Values v = {{"c", cName(d)}};
    bool isClass = d.kind == DKind::Class;
    // The forward declaration of a class already has the typedef.
    w.block(
        isClass ? "struct {c}" : "typedef struct {c}", v,
        [&] {
            if (d.base())
                w.line(cName(*d.base()) + " base;");
            else if (isClass)
                w.line("Ice_Value ice_value;");
            bool keeps = !isClass && d.preserves() && !(d.base() && d.base()->preserves());
            if (keeps)
                w.line("Ice_UnknownSlice *ice_unknown; /* slices of unknown derived types, most "
                       "derived first */");
            declareFields(w, d);
            if (!isClass && !d.base() && d.fields.empty() && !keeps)
                w.line("Ice_Byte ice_unused; /* C90 has no empty structs */");
        },
        isClass ? "};" : "} " + cName(d) + ";");
}

void declareType(Writer& w, const Declaration& d) {
    Writer::Values v = {{"c", cName(d)}};
    switch (d.kind) {
    case DKind::Sequence:
        declareElements(w, d, cType(d.element));
        break;
    case DKind::Dictionary:
        w.type("struct", cName(d) + "_Entry", [&] {
            w.line(cVariable(d.key, "key") + ";");
            w.line(cVariable(d.element, "value") + ";");
        });
        declareElements(w, d, cName(d) + "_Entry");
        break;
    default:
        if (!isRuntimeType(d))
            declareStruct(w, d);
    }
    bool isPlain = d.kind == DKind::Struct || d.kind == DKind::Exception;
    if (isPlain || d.kind == DKind::Class)
        w.line("void {c}_init({c} *v);", v);
    if (d.kind == DKind::Class) {
        w.line("#define {c}_cast(v) (({c} *)Ice_Value_cast(v, &{c}_type))", v);
        return;
    }
    w.line("void {c}_writeToOutputStream(const {c} *v, Ice_OutputStreamPtr os);", v);
    if (d.kind != DKind::Exception) {
        w.line("void {c}_readFromInputStream({c} *v, Ice_InputStreamPtr is);", v);
    } else {
        w.line("/* Write and read the slices of the type and its bases, without the exception "
               "header. */");
        w.line("void {c}_writeSlices(const {c} *v, Ice_OutputStreamPtr os);", v);
        w.line("void {c}_readSlices({c} *v, Ice_InputStreamPtr is);", v);
    }
    if (std::string find = findSignature(d); !find.empty())
        w.line(find + ";");
}

void declare(Writer& w, const Declaration& d) {
    if (d.fromInclude || d.isLocal || d.kind == DKind::Interface || d.isForward)
        return;
    w.blank();
    writeDoc(w, d.doc, d.metadata);
    if (d.kind == DKind::Constant)
        declareConstant(w, d);
    else if (d.kind == DKind::Enum)
        declareEnum(w, d);
    else
        declareType(w, d);
}

void declareThrown(Writer& w, const CContext& c, const Declaration& d, const Operation& o) {
    auto family = mayThrow(c.unit, o);
    std::string op = operationName(d, o), type = exceptionType(d, o);
    w.blank();
    if (c.thrownAs(o) != op) {
        Writer::Values v = {{"op", op}, {"as", c.thrownAs(o)}};
        w.line("/* {op} throws the same exceptions as {as}, so both use one union. */", v);
        w.line("typedef {as}_Exception {op}_Exception;", v);
        w.line("#define {op}_none {as}_none", v);
        for (const Declaration* e : family)
            w.line("#define {op}_" + exceptionLabel(o, family, *e) + " {as}_" +
                       exceptionLabel(o, family, *e),
                   v);
        return;
    }
    w.line("/* The exceptions of {op}: `type` selects the member of `u`. */", {{"op", op}});
    w.type("struct", type, [&] {
        w.line("enum {");
        w.line("    " + op + "_none");
        for (const Declaration* e : family)
            w.line("    , " + op + "_" + exceptionLabel(o, family, *e));
        w.line("} type;");
        w.line("union {");
        for (const Declaration* e : family)
            w.line("    " + cName(*e) + " " + exceptionMember(o, family, *e) + ";");
        w.line("} u;");
    });
    w.line("void " + type + "_writeToOutputStream(const " + type + " *v, Ice_OutputStreamPtr os);");
    w.line("/* Returns ICE_USER_EXCEPTION, ICE_UNKNOWN_USER_EXCEPTION or ICE_MARSHAL. */");
    w.line("Ice_Status " + type + "_readFromInputStream(" + type + " *v, Ice_InputStreamPtr is);");
}

void declareAsync(Writer& w, const Declaration& d, const Operation& o) {
    std::string type = operationName(d, o) + "_Async";
    w.blank();
    w.type("struct", type, [&] {
        w.line("void (*completed)(struct " + type + " *self);");
        w.line("void *context;");
        w.line("Ice_Bool done;");
        w.line("Ice_Status status;");
        for (const Slot& s : outSlots(o, "")) {
            if (s.isOptional)
                w.line("Ice_Bool " + s.has + ";");
            w.line(cVariable(*s.type, s.value) + ";");
        }
        if (!o.throws.empty())
            w.line(exceptionType(d, o) + " exception;");
    });
    w.line(asyncSignature(d, o) + ";");
}

void declareProxy(Writer& w, const Declaration& d) {
    Writer::Values v = {{"p", cProxy(d)}, {"c", cName(d.ofClass ? *d.ofClass : d)}, {"id", d.id()}};
    w.blank();
    w.line("#define {c}_ice_staticId \"{id}\"", v);
    w.line("Ice_Status {p}_checkedCast({p}Ptr self, const Ice_ObjectPrx *from);", v);
    w.line("void {p}_uncheckedCast({p}Ptr self, const Ice_ObjectPrx *from);", v);
    for (const Declaration* from : lineage(d))
        for (const Operation& o : from->operations) {
            if (from == &d) {
                w.blank();
                writeDoc(w, o.doc, o.metadata);
                w.line(proxySignature(d, o) + ";");
                continue;
            }
            Writer::Values names = {
                {"c", cProxy(d)}, {"from", cProxy(*from)}, {"op", cOperation(o.name)}};
            w.line("#define {c}_{op} {from}_{op}", names);
            w.line("#define {c}_{op}_async {from}_{op}_async", names);
        }
}

void declareServant(Writer& w, const Declaration& d) {
    Writer::Values v = {{"c", cName(d)}};
    w.blank();
    w.line("typedef struct {c} {", v);
    w.line("    Ice_Object base;");
    w.line("    const struct {c}_Operations *operations;", v);
    w.line("} {c}, *{c}Ptr;", v);
    w.blank();
    w.line(
        "/* A servant's functions, one for each operation; 0 for an operation that is missing. */");
    w.type("struct", cName(d) + "_Operations", [&] {
        for (const Declaration* base : d.bases)
            w.line(cName(*base) + "_Operations " + cName(*base) + "_;");
        for (const Operation& o : d.operations)
            w.line(servantSignature(d, o, "(*" + cIdentifier(o.name) + ")") + ";");
        if (d.bases.empty() && d.operations.empty())
            w.line("Ice_Byte ice_unused; /* C90 has no empty structs */");
    });
    w.line("extern const Ice_Interface {c}_ice_interface;", v);
    w.line("void {c}_initWith({c}Ptr self, const {c}_Operations *operations);", v);
    w.blank();
    w.line(
        "/* Initialises a servant with the functions below, which the application must define. */");
    w.line("void {c}_init({c}Ptr self);", v);
    for (const Declaration* from : lineage(d))
        for (const Operation& o : from->operations)
            w.line(servantSignature(*from, o, cName(d) + "_" + cOperation(o.name)) + ";");
}

void declareResponses(Writer& w, const Declaration& d) {
    bool first = true;
    for (const Operation& o : d.operations) {
        if (!isAmd(d, o))
            continue;
        if (first) {
            w.blank();
            w.line("/* Send the replies to calls for which the servant returned ICE_LATER. */");
        }
        first = false;
        w.line(responseSignature(d, o) + ";");
        if (!o.throws.empty())
            w.line("Ice_Status " + operationName(d, o) + "_exception(Ice_Reply *reply, const " +
                   exceptionType(d, o) + " *ex);");
    }
}

void declareInterface(Writer& w, const CContext& c, const Declaration& d) {
    if (d.isForward)
        return;
    w.blank();
    w.line(hasMetadata(d.metadata, ":hw")
               ? "/* ---- " + d.id() + ", implemented in hardware ---- */"
               : "/* ---- " + d.id() + " ---- */");
    writeDoc(w, d.doc, d.metadata);
    for (const Operation& o : d.operations)
        if (!o.throws.empty())
            declareThrown(w, c, d, o);
    declareProxy(w, d);
    if (!d.operations.empty()) {
        w.blank();
        w.line(
            "/* Asynchronous calls. The caller keeps the call object until the call has ended. */");
    }
    for (const Operation& o : d.operations)
        declareAsync(w, d, o);
    declareServant(w, d);
    declareResponses(w, d);
}

} // namespace

std::string headerFile(const CContext& c) {
    Writer w = c.begin("Types, proxies and servants. Mapping: docs/slice-mapping.md.");
    w.line("#pragma once");
    w.blank();
    w.line("#include \"ice_operation.h\"");
    if (c.usesClasses())
        w.line("#include \"ice_value.h\"");
    for (const std::string& include : c.names.includes)
        w.line("#include \"" + include + "\"");
    for (const std::string& m : c.unit.metadata)
        if (m.compare(0, 10, "c:include:") == 0)
            w.line("#include \"" + m.substr(10) + "\"");
    w.blank();
    w.line("#ifdef __cplusplus");
    w.line("extern \"C\" {");
    w.line("#endif");
    forwardDeclarations(w, c);
    for (const auto& d : c.unit.declarations)
        declare(w, *d);
    if (c.usesClasses()) {
        w.blank();
        w.line("/* The classes that can be received; 0 marks the end. */");
        w.line("extern const Ice_ValueType *const " + c.valueTable() + "[];");
    }
    c.each(DKind::Interface, [&](const Declaration& d) { declareInterface(w, c, d); });
    w.blank();
    w.line("#ifdef __cplusplus");
    w.line("}");
    w.line("#endif");
    return w.text();
}

std::vector<GeneratedFile> generateC(const Unit& unit, const CFileNames& names) {
    CContext c{unit, names};
    const std::string& s = names.sourceExtension;
    return {{c.header(), headerFile(c)},
            {names.base + "_types." + s, typesFile(c)},
            {names.base + "_client." + s, clientFile(c)},
            {names.base + "_async." + s, asyncFile(c)},
            {names.base + "_server." + s, serverFile(c)}};
}
