// SPDX-License-Identifier: MIT
//
// parser_interface: parses interfaces and operations, and checks inheritance.

#include "front/parser.h"
#include <algorithm>

std::vector<const Declaration*> Parser::baseList(const Declaration& d, Declaration::Kind wanted,
                                                 bool many) {
    std::vector<const Declaration*> bases;
    std::string what = std::string("the ") + kindName(wanted) + " to extend";
    do {
        Location begin = token().at;
        if (isWord("Object") || isWord("Value")) {
            error(begin, "'" + std::string(token().text) +
                             "' is a base of every interface and class; do not list it");
            ++position_;
            continue;
        }
        std::string written = scopedName(what);
        Symbol* s = resolve(written, begin);
        const Declaration* base =
            s && s->kind == Symbol::Kind::Declaration ? s->declaration : nullptr;
        if (!base || base->kind != wanted) {
            error(begin, "'" + written + "' is not " +
                             (wanted == Declaration::Kind::Class ? "a " : "an ") +
                             kindName(wanted));
        } else if (base->isForward) {
            error(begin, "'" + written + "' is declared, but not defined yet");
        } else if (base == &d) {
            error(begin, "'" + written + "' cannot extend itself");
        } else if (std::find(bases.begin(), bases.end(), base) == bases.end()) {
            if (base->isLocal && !d.isLocal)
                error(begin, "'" + d.name + "' is not local, but '" + written + "' is");
            if (!base->isLocal && d.isLocal && wanted != Declaration::Kind::Exception)
                error(begin, "'" + d.name + "' is local, but '" + written + "' is not");
            bases.push_back(base);
        }
    } while (many && accept(","));
    return bases;
}

namespace {

using OwnedOperation = std::pair<const Operation*, const Declaration*>;

void collect(const Declaration& d, std::set<const Declaration*>& seen,
             std::vector<OwnedOperation>& list) {
    if (!seen.insert(&d).second)
        return;
    for (const Declaration* base : d.bases)
        collect(*base, seen, list);
    for (const Declaration* base : d.implemented)
        collect(*base, seen, list);
    for (const Operation& o : d.operations)
        list.push_back({&o, &d});
}

// Returns the operations of an interface or class, each once, including inherited ones.
std::vector<OwnedOperation> allOperations(const Declaration& d) {
    std::set<const Declaration*> seen;
    std::vector<OwnedOperation> list;
    collect(d, seen, list);
    return list;
}

} // namespace

// Reports an error if two bases have different operations of the same name.
void Parser::checkBases(const Declaration& d) {
    std::vector<OwnedOperation> list = allOperations(d);
    for (size_t i = 0; i < list.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            if (lowerCase(list[i].first->name) == lowerCase(list[j].first->name)) {
                error(d.at, "'" + d.name + "' inherits operation '" + list[i].first->name +
                                "' twice: from '" + list[j].second->id() + "' and '" +
                                list[i].second->id() + "'");
                return;
            }
}

void Parser::interface() {
    Declaration& d = declareType(Declaration::Kind::Interface, true);
    if (accept(";"))
        return;
    if (acceptWord("extends"))
        d.bases = baseList(d, Declaration::Kind::Interface, true);
    checkBases(d);
    braces(d, [&] { operation(d); });
    if (hasMetadata(d.metadata, "delegate") && (!d.isLocal || allOperations(d).size() != 1))
        diagnostics_.warning(d.at, "[\"delegate\"]: expected a local interface with one operation",
                             Diagnostics::Metadata);
}

void Parser::operation(Declaration& d) {
    Operation o;
    user_ = d.id();
    auto readDoc = [&] {
        if (o.doc.empty())
            o.doc = doc().empty() ? token().comment : doc();
    };
    readDoc();
    o.metadata = metadata();
    readDoc();
    o.idempotent = acceptWord("idempotent");
    Optional result = optional();
    Location begin = token().at;
    o.result = type();
    o.isResultOptional = result.present;
    o.resultTag = result.tag;
    if (result.present && o.result.kind == Type::Kind::Void)
        error(begin, "void cannot be optional");
    o.at = token().at;
    o.name = name("the name of the operation");
    checkLocal(o.result, d.isLocal, "operation '" + o.name + "'", begin);
    checkOperation(d, o);
    expect("(");
    user_ += "::" + o.name; // names in the parameter list are recorded as used by this operation
    parameters(o, d);
    user_ = d.id();
    expect(")");
    if (acceptWord("throws"))
        throwsClause(o, d);
    expect(";");
    d.operations.push_back(std::move(o));
}

void Parser::checkOperation(const Declaration& d, const Operation& o) {
    std::string called = lowerCase(o.name);
    (void)symbols_.hasChanged(d.id(), o.name, o.at);
    if (called == lowerCase(d.name))
        error(o.at,
              "operation '" + o.name + "' must differ from the name of its " + kindName(d.kind));
    for (const auto& [other, from] : allOperations(d)) {
        if (other->name == o.name)
            error(o.at, "operation '" + o.name + "' already exists" +
                            (from == &d ? "" : ", in the base '" + from->id() + "'") +
                            "; Slice has no overloading");
        else if (lowerCase(other->name) == called)
            error(o.at,
                  "operation '" + o.name + "' differs in capitals only from '" + other->name + "'");
    }
    for (const Declaration* from = &d; from && d.kind == Declaration::Kind::Class;
         from = from->base())
        for (const Field& f : from->fields)
            if (lowerCase(f.name) == called)
                error(o.at,
                      "operation '" + o.name + "' has the name of a member, '" + f.name + "'");
}

// Checks that a class member does not have the same name as an operation.
void Parser::checkMemberOfClass(const Declaration& d, const Field& f) {
    for (const auto& [operation, from] : allOperations(d))
        if (lowerCase(operation->name) == lowerCase(f.name))
            error(f.at, "member '" + f.name + "' has the name of an operation, '" +
                            operation->name + "' of '" + from->id() + "'");
}

void Parser::parameters(Operation& o, const Declaration& owner) {
    if (isWord("void") && isSymbol(")", 1)) {
        diagnostics_.warning(token().at, "'(void)' is C, not Slice; read as '()'");
        ++position_;
    }
    while (!isSymbol(")")) {
        Field p;
        p.isOut = acceptWord("out");
        p.metadata = metadata();
        if (isWord("out"))
            fail("a type; write 'out' before the metadata");
        Optional tag = optional();
        Location begin = token().at;
        p.type = type();
        p.isOptional = tag.present;
        p.tag = tag.tag;
        p.at = token().at;
        p.name = name("the name of the parameter");
        if (p.type.kind == Type::Kind::Void)
            error(begin, "a parameter cannot be void");
        checkLocal(p.type, owner.isLocal, "parameter '" + p.name + "'", begin);
        if (!p.isOut && !o.parameters.empty() && o.parameters.back().isOut)
            error(p.at, "in parameters must precede out parameters");
        for (const Field& other : o.parameters) {
            if (lowerCase(other.name) == lowerCase(p.name))
                error(p.at, "parameter '" + p.name + "' already exists, as '" + other.name + "'");
            if (p.isOptional && other.isOptional && p.tag >= 0 && other.tag == p.tag)
                error(p.at,
                      "tag " + std::to_string(p.tag) + " is already used by '" + other.name + "'");
        }
        if (p.isOptional && o.isResultOptional && p.tag >= 0 && o.resultTag == p.tag)
            error(p.at, "tag " + std::to_string(p.tag) + " is already used by the return value");
        o.parameters.push_back(std::move(p));
        if (!accept(","))
            break;
        if (isSymbol(")"))
            fail("a parameter");
    }
}

void Parser::throwsClause(Operation& o, const Declaration& owner) {
    do {
        Location begin = token().at;
        std::string written = scopedName("an exception");
        Symbol* s = resolve(written, begin);
        // The name of an operation must not have another meaning in its interface.
        std::string first = lowerCase(written.substr(0, written.find("::")));
        bool isOperation = first == lowerCase(o.name);
        for (const Operation& other : owner.operations)
            isOperation = isOperation || first == lowerCase(other.name);
        if (isOperation) {
            error(begin,
                  "'" + written + "' has changed meaning: here it is the name of an operation");
            continue;
        }
        if (!s || s->kind != Symbol::Kind::Declaration ||
            s->declaration->kind != Declaration::Kind::Exception) {
            error(begin, "'" + written + "' is not an exception");
            continue;
        }
        if (s->declaration->isLocal && !owner.isLocal)
            error(begin,
                  "operation '" + o.name + "' cannot throw the local exception '" + written + "'");
        if (std::find(o.throws.begin(), o.throws.end(), s->declaration) != o.throws.end())
            error(begin, "'" + written + "' is listed twice");
        else
            o.throws.push_back(s->declaration);
    } while (accept(","));
}
