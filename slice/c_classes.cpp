// SPDX-License-Identifier: MIT
//
// c_classes: descriptors of classes, which the run time reads and writes graphs by.

#include "c_files.h"
#include "c_names.h"

void classFunctions(Writer& w, const Declaration& d) {
    Writer::Values v = {{"c", d.cName()}, {"id", d.id()}};
    initFunction(w, d);
    w.blank();
    w.block("static void {c}_write(const void *object, Ice_OutputStreamPtr os)", v, [&] {
        if (d.fields.empty()) {
            w.line("(void)object;");
            w.line("(void)os;");
            return;
        }
        w.line("const {c} *v = (const {c} *)object;", v);
        writeSlots(w, memberSlots(d));
    });
    w.blank();
    w.block("static void {c}_read(void *object, Ice_InputStreamPtr is)", v, [&] {
        if (d.fields.empty()) {
            w.line("(void)object;");
            w.line("(void)is;");
            return;
        }
        w.line("{c} *v = ({c} *)object;", v);
        readSlots(w, memberSlots(d));
    });
    w.blank();
    std::string base = d.base() ? "&" + d.base()->cName() + "_type" : "0";
    w.line("const Ice_ValueType {c}_type = {", v);
    w.line("    \"{id}\", " + base + ", " + std::to_string(d.compactId) +
               ", (Ice_Int)sizeof({c}), " + (d.preserves() ? "1" : "0") + ", {c}_write, {c}_read};",
           v);
}

void valueTypeTable(Writer& w, const CContext& c) {
    w.blank();
    w.line("const Ice_ValueType *const " + c.valueTable() + "[] = {");
    for (const auto& d : c.unit.declarations)
        if (d->kind == Declaration::Kind::Class && !d->isLocal && !d->isForward)
            w.line("    &" + d->cName() + "_type,");
    w.line("    0};");
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
