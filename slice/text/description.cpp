// SPDX-License-Identifier: MIT
//
// description: writes declarations as JSON.

#include "text/description.h"
#include "text/doc_comment.h"

namespace {

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
void annotate(Json& target, const std::string& doc, const std::vector<std::string>& metadata) {
    std::string text;
    for (const std::string& line : docLines(doc))
        text += (text.empty() ? "" : "\n") + line;
    if (!text.empty())
        target.set("doc", text);
    if (!metadata.empty())
        target.set("metadata", metadata);
}

Json valueOf(const Literal& value) {
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

Json fieldOf(const Field& f) {
    Json field = Json::object({{"name", f.name}, {"type", typeName(f.type)}});
    if (f.isOut)
        field.set("out", true);
    if (f.isOptional)
        field.set("tag", f.tag);
    if (f.value.kind != Literal::Kind::None)
        field.set("default", valueOf(f.value));
    annotate(field, f.doc, f.metadata);
    return field;
}

Json fieldsOf(const std::vector<Field>& fields) {
    Json list = Json::array();
    for (const Field& f : fields)
        list.add(fieldOf(f));
    return list;
}

Json namesOf(const std::vector<const Declaration*>& declarations) {
    Json list = Json::array();
    for (const Declaration* d : declarations)
        list.add(d->id());
    return list;
}

Json operationOf(const Operation& o) {
    Json operation = Json::object({{"name", o.name}, {"result", typeName(o.result)}});
    if (o.isResultOptional)
        operation.set("tag", o.resultTag);
    if (o.idempotent)
        operation.set("idempotent", true);
    operation.set("parameters", fieldsOf(o.parameters));
    if (!o.throws.empty())
        operation.set("throws", namesOf(o.throws));
    annotate(operation, o.doc, o.metadata);
    return operation;
}

Json declarationOf(const Declaration& d) {
    Json made = Json::object({{"kind", kindName(d.kind)}, {"file", std::string(d.at.file)}});
    annotate(made, d.doc, d.metadata);
    if (!d.bases.empty())
        made.set("bases", namesOf(d.bases));
    if (!d.implemented.empty())
        made.set("implements", namesOf(d.implemented));
    if (d.kind == Declaration::Kind::Enum) {
        Json list = Json::array();
        for (const Enumerator& e : d.enumerators) {
            Json one = Json::object({{"name", e.name}, {"value", e.value}});
            annotate(one, e.doc, {});
            list.add(one);
        }
        made.set("enumerators", list);
    }
    if (d.kind == Declaration::Kind::Struct || d.kind == Declaration::Kind::Class ||
        d.kind == Declaration::Kind::Exception)
        made.set("fields", fieldsOf(d.fields));
    if (d.kind == Declaration::Kind::Dictionary)
        made.set("key", typeName(d.key));
    if (d.kind == Declaration::Kind::Sequence || d.kind == Declaration::Kind::Dictionary ||
        d.kind == Declaration::Kind::Constant)
        made.set("element", typeName(d.element));
    if (d.kind == Declaration::Kind::Constant)
        made.set("value", valueOf(d.value));
    if (d.kind == Declaration::Kind::Interface || !d.operations.empty()) {
        Json list = Json::array();
        for (const Operation& o : d.operations)
            list.add(operationOf(o));
        made.set("operations", list);
    }
    return made;
}

} // namespace

void describeUnit(const Unit& unit, Json& declarations) {
    for (const auto& d : unit.declarations)
        if (!d->isForward && !d->isLocal && !d->ofClass)
            declarations.set(d->id(), declarationOf(*d));
}
