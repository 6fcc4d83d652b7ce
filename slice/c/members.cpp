// SPDX-License-Identifier: MIT
//
// members: defaults and marshalling of members.

#include "c/context.h"
#include "c/names.h"

namespace {

using DKind = Declaration::Kind;

// Sets a member to its default where that is not the zero that initFunction has written.
void initMember(Writer& w, const Declaration& d, const Field& f) {
    std::string name = "v->" + cMember(d, f), value = cValue(f.value, f.type);
    if (f.isOptional && f.value.kind != Literal::Kind::None)
        w.line("v->has_" + f.name + " = 1;");
    if (f.value.kind == Literal::Kind::None) {
        bool isStruct =
            f.type.kind == Type::Kind::Named && f.type.declaration->kind == DKind::Struct;
        if (isStruct)
            w.line(cName(*f.type.declaration) + "_init(&" + name + ");");
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
        std::string name = "v->" + cMember(d, f);
        slots.push_back({&f.type, name, "&" + name, f.isOptional, f.tag, "v->has_" + f.name});
    }
    return slots;
}

void initFunction(Writer& w, const Declaration& d) {
    w.function("void {c}_init({c} *v)", {{"c", cName(d)}}, [&] {
        w.line("memset(v, 0, sizeof *v);");
        if (d.base())
            w.line(cName(*d.base()) + "_init(&v->base);");
        if (d.kind == DKind::Class)
            w.line("((Ice_Value *)v)->type = &" + cName(d) + "_type;");
        for (const Field& f : d.fields)
            initMember(w, d, f);
    });
}

void writeWithValues(Writer& w, const std::vector<Slot>& slots, const std::string& table) {
    bool classes = anyClass(slots);
    if (classes)
        w.line("Ice_OutputStream_beginValues(os, &" + table + ");");
    if (classes && !anyRequiredClass(slots))
        w.line(table + ".pending = 0;");
    writeSlots(w, slots);
    if (classes)
        w.line("Ice_OutputStream_endValues(os);");
}

void readWithValues(Writer& w, const CContext& c, const std::vector<Slot>& slots,
                    const std::string& table) {
    bool classes = anyClass(slots);
    if (classes)
        w.line("Ice_InputStream_beginValues(is, &" + table + ", " + c.valueTable() + ");");
    if (classes && !anyRequiredClass(slots))
        w.line(table + ".pending = 0;");
    readSlots(w, slots);
    if (classes)
        w.line("Ice_InputStream_endValues(is);");
}
