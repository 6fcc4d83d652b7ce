// SPDX-License-Identifier: MIT
//
// description: writes declarations as JSON.

#include "text/description.h"
#include "text/doc_comment.h"

namespace {

using json = nlohmann::ordered_json;

std::string typeName(const Type& type) {
    switch (type.kind) {
    case Type::Kind::Void:
        return "void";
    case Type::Kind::Bool:
        return "bool";
    case Type::Kind::Byte:
        return "byte";
    case Type::Kind::Short:
        return "short";
    case Type::Kind::Int:
        return "int";
    case Type::Kind::Long:
        return "long";
    case Type::Kind::Float:
        return "float";
    case Type::Kind::Double:
        return "double";
    case Type::Kind::String:
        return "string";
    case Type::Kind::Named:
        return type.declaration->id();
    case Type::Kind::Proxy:
        return (type.declaration ? type.declaration->id() : "Object") + "*";
    case Type::Kind::Value:
        return type.declaration ? type.declaration->id() : "Object";
    case Type::Kind::LocalObject:
        return "LocalObject";
    }
    return "";
}

const char* kindName(Declaration::Kind kind) {
    static const char* const names[] = {"enum",      "struct", "sequence",  "dictionary",
                                        "interface", "class",  "exception", "constant"};
    return names[static_cast<size_t>(kind)];
}

// Adds the documentation and the metadata, if there are any.
void annotate(json& target, const std::string& doc, const std::vector<std::string>& metadata) {
    std::string text;
    for (const std::string& line : docLines(doc))
        text += (text.empty() ? "" : "\n") + line;
    if (!text.empty())
        target["doc"] = text;
    if (!metadata.empty())
        target["metadata"] = metadata;
}

json valueOf(const Literal& value) {
    switch (value.kind) {
    case Literal::Kind::Bool:
        return value.integer != 0;
    case Literal::Kind::Integer:
        return value.integer;
    case Literal::Kind::Floating:
        return value.floating;
    default:
        return value.text; // text of a string, or name of an enumerator
    }
}

json fieldOf(const Field& f) {
    json field = {{"name", f.name}, {"type", typeName(f.type)}};
    if (f.isOut)
        field["out"] = true;
    if (f.isOptional)
        field["tag"] = f.tag;
    if (f.value.kind != Literal::Kind::None)
        field["default"] = valueOf(f.value);
    annotate(field, f.doc, f.metadata);
    return field;
}

json fieldsOf(const std::vector<Field>& fields) {
    json list = json::array();
    for (const Field& f : fields)
        list.push_back(fieldOf(f));
    return list;
}

json namesOf(const std::vector<const Declaration*>& declarations) {
    json list = json::array();
    for (const Declaration* d : declarations)
        list.push_back(d->id());
    return list;
}

json operationOf(const Operation& o) {
    json operation = {{"name", o.name}, {"result", typeName(o.result)}};
    if (o.isResultOptional)
        operation["tag"] = o.resultTag;
    if (o.idempotent)
        operation["idempotent"] = true;
    operation["parameters"] = fieldsOf(o.parameters);
    if (!o.throws.empty())
        operation["throws"] = namesOf(o.throws);
    annotate(operation, o.doc, o.metadata);
    return operation;
}

json declarationOf(const Declaration& d) {
    json made = {{"kind", kindName(d.kind)}, {"file", d.at.file}};
    annotate(made, d.doc, d.metadata);
    if (!d.bases.empty())
        made["bases"] = namesOf(d.bases);
    if (!d.implemented.empty())
        made["implements"] = namesOf(d.implemented);
    if (d.kind == Declaration::Kind::Enum) {
        made["enumerators"] = json::array();
        for (const Enumerator& e : d.enumerators) {
            json one = {{"name", e.name}, {"value", e.value}};
            annotate(one, e.doc, {});
            made["enumerators"].push_back(one);
        }
    }
    if (d.kind == Declaration::Kind::Struct || d.kind == Declaration::Kind::Class ||
        d.kind == Declaration::Kind::Exception)
        made["fields"] = fieldsOf(d.fields);
    if (d.kind == Declaration::Kind::Dictionary)
        made["key"] = typeName(d.key);
    if (d.kind == Declaration::Kind::Sequence || d.kind == Declaration::Kind::Dictionary ||
        d.kind == Declaration::Kind::Constant)
        made["element"] = typeName(d.element);
    if (d.kind == Declaration::Kind::Constant)
        made["value"] = valueOf(d.value);
    if (d.kind == Declaration::Kind::Interface || !d.operations.empty()) {
        made["operations"] = json::array();
        for (const Operation& o : d.operations)
            made["operations"].push_back(operationOf(o));
    }
    return made;
}

} // namespace

void describeUnit(const Unit& unit, json& declarations) {
    for (const auto& d : unit.declarations)
        if (!d->isForward && !d->isLocal && !d->ofClass)
            declarations[d->id()] = declarationOf(*d);
}
