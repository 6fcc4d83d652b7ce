// SPDX-License-Identifier: MIT
//
// data: generates the source file of the types: marshalling of structs, sequences and dictionaries;
// default values; constants.

#include "c/context.h"

namespace {

using DKind = Declaration::Kind;

std::string element(const Declaration& d) {
    return d.kind == DKind::Dictionary ? cName(d) + "_Entry" : cType(d.element);
}

int leastElementSize(const Declaration& d) {
    return factsOf(d.element).leastWireSize +
           (d.kind == DKind::Dictionary ? factsOf(d.key).leastWireSize : 0);
}

// Returns the slots of one element: a key and a value for a dictionary, otherwise the element.
std::vector<Slot> elementSlots(const Declaration& d) {
    Slot s{&d.element, "v->data[i]", "&v->data[i]", false, 0, ""};
    if (d.kind == DKind::Sequence)
        return {s};
    return {{&d.key, "v->data[i].key", "&v->data[i].key", false, 0, ""},
            {&d.element, "v->data[i].value", "&v->data[i].value", false, 0, ""}};
}

void loop(Writer& w, const Declaration& d, void (*each)(Writer&, const std::vector<Slot>&)) {
    std::string head = "for (i = 0; i < v->size; ++i)";
    if (d.kind == DKind::Dictionary) {
        w.block(head, {}, [&] { each(w, elementSlots(d)); });
    } else {
        w.line(head);
        w.indented([&] { each(w, elementSlots(d)); }); // one statement
    }
}

// Writes code that fails the stream if a sequence has more elements than its bound.
static void overBound(Writer& w, const Declaration& d, const std::string& stream) {
    w.line(stream + "->failed = ICE_FAILED_BOUND;");
    w.line(stream + "->bound = \"::Ice::MarshalException: over [\\\"c:max:" +
           std::to_string(statedMaximum(d)) + "\\\"] of " + d.id() + "\";");
}

void writeFunction(Writer& w, const Declaration& d) {
    bool bytes = d.kind == DKind::Sequence && d.element.kind == Type::Kind::Byte;
    int maximum = statedMaximum(d);
    w.function("void {c}_writeToOutputStream(const {c} *v, Ice_OutputStreamPtr os)",
               {{"c", cName(d)}}, [&] {
                   if (!bytes)
                       w.line("Ice_Int i;");
                   if (maximum) {
                       w.block("if (v->size > " + std::to_string(maximum) + ")", {}, [&] {
                           overBound(w, d, "os");
                           w.line("return;");
                       });
                   }
                   w.line("Ice_OutputStream_writeSize(os, v->size);");
                   if (bytes)
                       w.line("Ice_OutputStream_writeBlob(os, v->data, v->size);");
                   else
                       loop(w, d, writeSlots);
               });
}

void readElsewhere(Writer& w, const Declaration& d) {
    Writer::Values v = {{"e", element(d)}};
    w.line("v->data = ({e}" + std::string(v[0].second.back() == '*' ? "*" : " *") +
               ")Ice_InputStream_allocate(is, v->size, (Ice_Int)sizeof *v->data);",
           v);
    w.single("if (!v->data)", "v->size = 0;");
}

void readFunction(Writer& w, const Declaration& d) {
    bool bytes = d.kind == DKind::Sequence && d.element.kind == Type::Kind::Byte;
    int maximum = statedMaximum(d);
    w.function("void {c}_readFromInputStream({c} *v, Ice_InputStreamPtr is)", {{"c", cName(d)}},
               [&] {
                   if (bytes && maximum)
                       w.line("const Ice_Byte *bytes;");
                   else if (!bytes)
                       w.line("Ice_Int i;");
                   w.line("v->size = Ice_InputStream_readSequence(is, " +
                          std::to_string(leastElementSize(d)) + ");");
                   if (maximum)
                       w.block("if (v->size > " + std::to_string(maximum) + ")", {}, [&] {
                           w.line("v->size = 0;");
                           overBound(w, d, "is");
                       });
                   if (bytes && maximum) {
                       w.line("bytes = Ice_InputStream_readBlob(is, v->size);");
                       w.single("if (bytes)", "memcpy(v->data, bytes, (size_t)v->size);");
                   } else if (bytes) {
                       w.line("/* The bytes are not copied: they stay in the message. */");
                       w.line("v->data = (Ice_Byte *)Ice_InputStream_readBlob(is, v->size);");
                       w.single("if (!v->data)", "v->size = 0;");
                   } else {
                       if (!maximum)
                           readElsewhere(w, d);
                       loop(w, d, readSlots);
                   }
               });
}

void findFunction(Writer& w, const Declaration& d) {
    std::string signature = findSignature(d);
    if (signature.empty())
        return;
    w.function(signature, {}, [&] {
        w.line("Ice_Int i;");
        w.line("for (i = 0; i < v->size; ++i)");
        w.line(d.key.kind == Type::Kind::String ? "    if (Ice_String_same(&v->data[i].key, &key))"
                                                : "    if (v->data[i].key == key)");
        w.line("        return (" + cVariable(d.element, "*") + ")&v->data[i].value;");
        w.line("return 0;");
    });
}

void structFunctions(Writer& w, const Declaration& d) {
    if (!isRuntimeType(d) || !d.fields.empty())
        initFunction(w, d);
    w.function("void {c}_writeToOutputStream(const {c} *v, Ice_OutputStreamPtr os)",
               {{"c", cName(d)}}, [&] { writeSlots(w, memberSlots(d)); });
    w.function("void {c}_readFromInputStream({c} *v, Ice_InputStreamPtr is)", {{"c", cName(d)}},
               [&] { readSlots(w, memberSlots(d)); });
}

} // namespace

std::string findSignature(const Declaration& d) {
    if (d.kind != DKind::Dictionary || isByPointer(d.key) || d.key.kind == Type::Kind::Long)
        return "";
    return cVariable(d.element, "*" + cName(d) + "_find") + "(const " + cName(d) + " *v, " +
           cVariable(d.key, "key") + ")";
}

std::string typesFile(const CContext& c) {
    Writer w = c.beginSource("Marshalling of types and exceptions.");
    w.blank();
    w.line("#include <string.h>");
    c.each(DKind::Constant, [&](const Declaration& d) {
        if (d.element.kind != Type::Kind::Long)
            return;
        w.blank();
        w.line("const Ice_Long " + cName(d) + " = " + cValue(d.value, d.element) + ";");
    });
    for (const auto& d : c.unit.declarations) {
        if (d->fromInclude || d->isLocal || d->isForward)
            continue;
        switch (d->kind) {
        case DKind::Struct:
            structFunctions(w, *d);
            break;
        case DKind::Sequence:
        case DKind::Dictionary:
            writeFunction(w, *d);
            readFunction(w, *d);
            findFunction(w, *d);
            break;
        case DKind::Exception:
            exceptionFunctions(w, *d);
            break;
        case DKind::Class:
            classFunctions(w, *d);
            break;
        default:
            break;
        }
    }
    c.eachOperation([&](const Declaration& d, const Operation& o) {
        if (!o.throws.empty() && c.thrownAs(o) == operationName(d, o))
            thrownFunctions(w, c, d, o);
    });
    if (c.usesClasses())
        valueTypeTable(w, c);
    return w.text();
}
