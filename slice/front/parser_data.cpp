// SPDX-License-Identifier: MIT
//
// parser_data: parses enums, structs, exceptions, classes, sequences, dictionaries and constants.

#include "front/parser.h"

void Parser::enumeration() {
    Declaration& d = declareType(Declaration::Kind::Enum, false);
    int64_t next = 0;
    expect("{");
    while (!isSymbol("}")) {
        Enumerator e;
        e.doc = doc();
        e.at = token().at;
        if (at(Token::Kind::Identifier) && !token().escaped && isKeyword(token().text)) {
            std::string word(token().text);
            error(e.at, "'" + word + "' is a keyword; as an enumerator, write '\\" + word + "'");
            ++position_;
            if (!accept(","))
                break;
            continue;
        }
        e.name = name("an enumerator");
        bool isWritten = accept("=");
        d.hasValues = d.hasValues || isWritten;
        e.value = isWritten ? number("an enumerator's value", false) : next;
        if (e.value > INT32_MAX)
            error(e.at, "an enumerator's value must be 0 to 2147483647");
        if (e.value >= 0)
            next = e.value + 1;
        bool isTaken = false;
        for (const Enumerator& other : d.enumerators) {
            isTaken = isTaken || lowerCase(other.name) == lowerCase(e.name);
            if (lowerCase(other.name) == lowerCase(e.name))
                error(e.at, "enumerator '" + e.name + "' already exists, as '" + other.name + "'");
            else if (other.value == e.value && e.value >= 0)
                error(e.at,
                      "enumerator '" + e.name + "' has the same value as '" + other.name + "'");
        }
        d.enumerators.push_back(e);
        bool isNew = false;
        Symbol* s = isTaken ? nullptr : symbols_.declare(d.id(), e.name, e.at, isNew);
        if (s && isNew) {
            s->kind = Symbol::Kind::Enumerator;
            s->declaration = &d;
            s->enumerator = d.enumerators.size() - 1;
            symbols_.declareBare(scopeId_, e.name, s);
        }
        if (!accept(","))
            break;
    }
    expect("}");
    accept(";");
    d.complete();
    if (d.enumerators.empty())
        error(d.at, "an enum needs at least one enumerator");
}

void Parser::structure() {
    Declaration& d = declareType(Declaration::Kind::Struct, false);
    if (isSymbol(";"))
        fail("'{': a struct cannot be declared forward");
    bool isEmpty = isSymbol("}", 1);
    braces(d, [&] { member(d, false); });
    d.complete();
    if (isEmpty)
        error(d.at, "a struct needs at least one member");
}

void Parser::exception() {
    Declaration& d = declareType(Declaration::Kind::Exception, false);
    if (isSymbol(";"))
        fail("'{': an exception cannot be declared forward");
    if (acceptWord("extends"))
        d.bases = baseList(d, Declaration::Kind::Exception, false);
    braces(d, [&] { member(d, true); });
}

void Parser::classDefinition() {
    Declaration& d = declareType(Declaration::Kind::Class, true);
    d.complete();
    if (accept(";"))
        return;
    if (accept("(")) {
        Location begin = token().at;
        d.compactId = number("a class's compact id", true);
        auto [it, isNew] = compactIds_.emplace(d.compactId, d.id());
        if (!isNew && d.compactId >= 0)
            error(begin, "compact id " + std::to_string(d.compactId) + " is already used by '" +
                             it->second + "'");
        expect(")");
    }
    if (acceptWord("extends"))
        d.bases = baseList(d, Declaration::Kind::Class, false);
    if (isWord("implements")) {
        diagnostics_.warning(token().at, "classes implementing interfaces are deprecated",
                             Diagnostics::Deprecated);
        ++position_;
        d.implemented = baseList(d, Declaration::Kind::Interface, true);
    }
    checkBases(d);
    braces(d, [&] { member(d, true); });
}

// Parses a data member; in a class, also an operation.
void Parser::member(Declaration& d, bool mayBeOptional) {
    size_t start = position_;
    Field f;
    readMetadata(f.doc, f.metadata);
    Location begin = token().at;
    bool isClass = d.kind == Declaration::Kind::Class;
    bool isIdempotent = isClass && isWord("idempotent");
    bool returnsNothing = isClass && isWord("void");
    Optional o;
    if (!isIdempotent) {
        o = optional();
        f.type = type();
    }
    if (isClass && (isIdempotent || returnsNothing || isSymbol("(", 1))) {
        if (!d.isLocal && d.operations.empty())
            diagnostics_.warning(begin, "classes with operations are deprecated",
                                 Diagnostics::Deprecated);
        position_ = start;
        return operation(d);
    }
    f.isOptional = o.present;
    f.tag = o.tag;
    if (o.present && !mayBeOptional)
        error(begin, "a struct's member cannot be optional");
    f.at = token().at;
    f.name = name("the name of the member");
    if (f.type.kind == Type::Kind::Void)
        error(begin, "a member cannot be void");
    checkLocal(f.type, d.isLocal, "member '" + f.name + "'", begin);
    checkMember(d, f);
    // A type that contains itself would have an infinite size, and traversing it would never end.
    bool containsItself = f.type.declaration == &d && f.type.kind == Type::Kind::Named && !isClass;
    if (containsItself)
        error(f.at, "a " + std::string(kindName(d.kind)) + " cannot contain itself");
    if (accept("="))
        f.value = literal(f.type, "member '" + f.name + "'");
    expect(";");
    if (!containsItself)
        d.fields.push_back(std::move(f));
}

void Parser::checkMember(const Declaration& d, const Field& f) {
    std::string called = lowerCase(f.name);
    if (d.kind == Declaration::Kind::Class)
        checkMemberOfClass(d, f);
    for (const Declaration* from = &d; from; from = from->base())
        for (const Field& other : from->fields) {
            if (other.name == f.name)
                error(f.at, "member '" + f.name + "' already exists" +
                                (from == &d ? "" : ", in the base '" + from->id() + "'"));
            else if (lowerCase(other.name) == called)
                error(f.at,
                      "member '" + f.name + "' differs in capitals only from '" + other.name + "'");
            if (from == &d && f.isOptional && other.isOptional && f.tag >= 0 && other.tag == f.tag)
                error(f.at,
                      "tag " + std::to_string(f.tag) + " is already used by '" + other.name + "'");
        }
}

void Parser::sequence() {
    expect("<");
    Metadata elementMetadata = metadata();
    Location begin = token().at;
    Type element = type();
    expect(">");
    Declaration& d = declareType(Declaration::Kind::Sequence, false);
    d.element = element;
    if (element.kind == Type::Kind::Void)
        error(begin, "a sequence cannot have elements of type void");
    d.complete();
    checkLocal(element, d.isLocal, "sequence '" + d.name + "'", begin);
    expect(";");
}

void Parser::dictionary() {
    expect("<");
    (void)metadata();
    Location keyAt = token().at;
    Type key = type();
    expect(",");
    (void)metadata();
    Location valueAt = token().at;
    Type value = type();
    expect(">");
    Declaration& d = declareType(Declaration::Kind::Dictionary, false);
    d.key = key;
    d.element = value;
    if (!factsOf(key).isKey)
        error(keyAt, "dictionary '" + d.name + "' cannot have keys of type '" + typeName(key) +
                         "': only bool, integers, strings, enums and structs of them");
    else if (factsOf(key).hasSequence)
        diagnostics_.warning(keyAt, "sequences in dictionary keys are deprecated",
                             Diagnostics::Deprecated);
    if (value.kind == Type::Kind::Void)
        error(valueAt, "a dictionary's value cannot be void");
    checkLocal(key, d.isLocal, "dictionary '" + d.name + "'", keyAt);
    checkLocal(value, d.isLocal, "dictionary '" + d.name + "'", valueAt);
    d.complete();
    expect(";");
}

void Parser::constant() {
    (void)metadata();
    Type t = type();
    Declaration& d = declareType(Declaration::Kind::Constant, false);
    d.element = t;
    expect("=");
    d.value = literal(t, "constant '" + d.name + "'");
    expect(";");
}
