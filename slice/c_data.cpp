// SPDX-License-Identifier: MIT
//
// c_data: the types file: marshalling of structs, sequences and dictionaries, defaults, constants.

#include "c_files.h"
#include "c_names.h"
#include "checksums.h"

namespace {

using DKind = Declaration::Kind;

std::string element(const Declaration& d) {
    return d.kind == DKind::Dictionary ? d.cName() + "_Entry" : cType(d.element);
}

int leastElementSize(const Declaration& d) {
    return leastWireSize(d.element) + (d.kind == DKind::Dictionary ? leastWireSize(d.key) : 0);
}

// Key and value, or the element.
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
        Writer inner;
        each(inner, elementSlots(d));
        w.nested(inner.text().substr(0, inner.text().size() - 1)); // one statement
    }
}

void writeFunction(Writer& w, const Declaration& d) {
    bool bytes = d.kind == DKind::Sequence && d.element.kind == Type::Kind::Byte;
    int maximum = statedMaximum(d);
    w.blank();
    w.block("void {c}_writeToOutputStream(const {c} *v, Ice_OutputStreamPtr os)",
            {{"c", d.cName()}}, [&] {
                if (!bytes)
                    w.line("Ice_Int i;");
                if (maximum) {
                    w.block("if (v->size > " + std::to_string(maximum) + ")", {}, [&] {
                        w.line("os->failed = 1;");
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
    w.line("if (!v->data)");
    w.nested("v->size = 0;");
}

void readFunction(Writer& w, const Declaration& d) {
    bool bytes = d.kind == DKind::Sequence && d.element.kind == Type::Kind::Byte;
    int maximum = statedMaximum(d);
    w.blank();
    w.block("void {c}_readFromInputStream({c} *v, Ice_InputStreamPtr is)", {{"c", d.cName()}}, [&] {
        if (bytes && maximum)
            w.line("const Ice_Byte *bytes;");
        else if (!bytes)
            w.line("Ice_Int i;");
        w.line("v->size = Ice_InputStream_readSequence(is, " + std::to_string(leastElementSize(d)) +
               ");");
        if (maximum)
            w.block("if (v->size > " + std::to_string(maximum) + ")", {}, [&] {
                w.line("v->size = 0;");
                w.line("is->failed = 1;");
            });
        if (bytes && maximum) {
            w.line("bytes = Ice_InputStream_readBlob(is, v->size);");
            w.line("if (bytes)");
            w.nested("memcpy(v->data, bytes, (size_t)v->size);");
        } else if (bytes) {
            w.line("/* In place: the bytes stay in the message. */");
            w.line("v->data = (Ice_Byte *)Ice_InputStream_readBlob(is, v->size);");
            w.line("if (!v->data)");
            w.nested("v->size = 0;");
        } else {
            if (!maximum)
                readElsewhere(w, d);
            loop(w, d, readSlots);
        }
    });
}

void findFunction(Writer& w, const Declaration& d) {
    if (isByPointer(d.key) || d.key.kind == Type::Kind::Long)
        return;
    bool isString = d.key.kind == Type::Kind::String;
    w.blank();
    w.block(cVariable(d.element, "*" + d.cName() + "_find") + "(const " + d.cName() + " *v, " +
                cVariable(d.key, "key") + ")",
            {}, [&] {
                w.line("Ice_Int i;");
                w.line("for (i = 0; i < v->size; ++i)");
                if (isString) {
                    w.line("    if (Ice_String_same(&v->data[i].key, &key))");
                } else {
                    w.line("    if (v->data[i].key == key)");
                }
                std::string type = cType(d.element);
                w.line("        return (" + type + (type.back() == '*' ? "*" : " *") +
                       ")&v->data[i].value;");
                w.line("return 0;");
            });
}

void structFunctions(Writer& w, const Declaration& d) {
    if (!isRuntimeType(d) || !d.fields.empty())
        initFunction(w, d);
    w.blank();
    w.block("void {c}_writeToOutputStream(const {c} *v, Ice_OutputStreamPtr os)",
            {{"c", d.cName()}}, [&] { writeSlots(w, memberSlots(d)); });
    w.blank();
    w.block("void {c}_readFromInputStream({c} *v, Ice_InputStreamPtr is)", {{"c", d.cName()}},
            [&] { readSlots(w, memberSlots(d)); });
}

// What the zeroes of initFunction are not right for.
void initMember(Writer& w, const Field& f) {
    std::string name = "v->" + cIdentifier(f.name), value = cValue(f.value, f.type);
    if (f.isOptional && f.value.kind != Literal::Kind::None)
        w.line("v->has_" + f.name + " = 1;");
    if (f.value.kind == Literal::Kind::None) {
        bool isStruct =
            f.type.kind == Type::Kind::Named && f.type.declaration->kind == DKind::Struct;
        if (isStruct)
            w.line(f.type.declaration->cName() + "_init(&" + name + ");");
        else if (isEnum(f.type) && f.type.declaration->enumerators.front().value != 0)
            w.line(name + " = " +
                   cEnumerator(*f.type.declaration, f.type.declaration->enumerators.front().name) +
                   ";");
    } else if (f.type.kind == Type::Kind::String) {
        if (f.value.text.empty())
            return;
        w.line(name + ".data = " + value + ";");
        w.line(name + ".size = " + std::to_string(f.value.text.size()) + ";");
    } else if (f.type.kind == Type::Kind::Long) {
        size_t comma = value.find(',');
        w.line(name + ".low = " + value.substr(1, comma - 1) + ";");
        w.line(name + ".high = " + value.substr(comma + 2, value.size() - comma - 3) + ";");
    } else {
        std::string cast = f.type.kind == Type::Kind::Float ? "(Ice_Float)" : "";
        w.line(name + " = " + cast + value + ";");
    }
}

} // namespace

std::vector<Slot> memberSlots(const Declaration& d) {
    std::vector<Slot> slots;
    for (const Field& f : d.fields) {
        std::string name = "v->" + cIdentifier(f.name);
        slots.push_back({&f.type, name, "&" + name, f.isOptional, f.tag, "v->has_" + f.name});
    }
    return slots;
}

void initFunction(Writer& w, const Declaration& d) {
    w.blank();
    w.block("void {c}_init({c} *v)", {{"c", d.cName()}}, [&] {
        w.line("memset(v, 0, sizeof *v);");
        if (d.base())
            w.line(d.base()->cName() + "_init(&v->base);");
        if (d.kind == DKind::Class)
            w.line("((Ice_Value *)v)->type = &" + d.cName() + "_type;");
        for (const Field& f : d.fields)
            initMember(w, f);
    });
}

std::string typesFile(const CContext& c) {
    Writer w = c.beginSource("Marshalling of types and exceptions.");
    w.blank();
    w.line("#include <string.h>");
    c.each(DKind::Constant, [&](const Declaration& d) {
        if (d.element.kind != Type::Kind::Long)
            return;
        w.blank();
        w.line("const Ice_Long " + d.cName() + " = " + cValue(d.value, d.element) + ";");
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
            if (d->kind == DKind::Dictionary)
                findFunction(w, *d);
            break;
        case DKind::Exception:
            exceptionFunctions(w, c, *d);
            break;
        case DKind::Class:
            classFunctions(w, *d);
            break;
        default:
            break;
        }
    }
    c.eachOperation([&](const Declaration& d, const Operation& o) {
        if (!o.throws.empty())
            thrownFunctions(w, c, d, o);
    });
    if (c.usesClasses())
        valueTypeTable(w, c);
    if (c.names.checksums) {
        w.blank();
        w.line("const Ice_SliceChecksum " + c.checksumTable() + "[] = {");
        for (const auto& [id, checksum] : checksums(c.unit))
            w.line("    {\"" + id + "\", \"" + checksum + "\"},");
        w.line("    {0, 0}};");
    }
    return w.text();
}
