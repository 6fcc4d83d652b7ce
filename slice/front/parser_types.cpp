// SPDX-License-Identifier: MIT
//
// parser_types: parses types, tags and values of constants.

#include "front/parser.h"
#include <algorithm>
#include <cfloat>
#include <cmath>

namespace {

using Kind = Type::Kind;

const std::pair<std::string_view, Kind> basicTypes[] = {{"void", Kind::Void},
                                                        {"bool", Kind::Bool},
                                                        {"byte", Kind::Byte},
                                                        {"short", Kind::Short},
                                                        {"int", Kind::Int},
                                                        {"long", Kind::Long},
                                                        {"float", Kind::Float},
                                                        {"double", Kind::Double},
                                                        {"string", Kind::String},
                                                        {"Value", Kind::Value},
                                                        {"LocalObject", Kind::LocalObject}};

} // namespace

std::string typeName(const Type& type) {
    for (const auto& [name, kind] : basicTypes)
        if (kind == type.kind && kind != Kind::Value)
            return std::string(name);
    std::string name = type.declaration ? type.declaration->id() : "Object";
    return type.kind == Kind::Proxy ? name + "*" : name;
}

Symbol* Parser::resolve(const std::string& written, const Location& at) {
    return symbols_.resolve(scopeId_, written, at, user_.empty() ? scopeId_ : user_);
}

// Reports an error if a type that is not local contains a local type.
void Parser::checkLocal(const Type& type, bool local, const std::string& what, const Location& at) {
    bool isLocal =
        type.kind == Kind::LocalObject || (type.declaration && type.declaration->isLocal);
    if (isLocal && !local)
        error(at, what + " cannot have the local type '" + typeName(type) + "'");
}

Type Parser::type() {
    Type t;
    const Token& begin = token();
    if (!at(Token::Kind::Identifier) && !isSymbol("::"))
        fail("a type");
    if (at(Token::Kind::Identifier) && !begin.escaped) {
        for (const auto& [name, kind] : basicTypes)
            if (begin.text == name) {
                ++position_;
                t.kind = kind;
                if (isSymbol("*"))
                    fail("no '*': '" + std::string(name) +
                         "' has no proxies, and Slice has no pointers to data");
                return t;
            }
        if (acceptWord("Object")) {
            t.kind = accept("*") ? Kind::Proxy : Kind::Value;
            return t;
        }
    }
    t = namedType();
    return t;
}

Type Parser::namedType() {
    Type t;
    Location begin = token().at;
    std::string written = scopedName("a type");
    Symbol* symbol = resolve(written, begin);
    if (!symbol || symbol->kind != Symbol::Kind::Declaration ||
        symbol->declaration->kind == Declaration::Kind::Constant ||
        symbol->declaration->kind == Declaration::Kind::Exception) {
        std::string is = !symbol                                ? "not a type that is known here"
                         : symbol->kind == Symbol::Kind::Module ? "a module, not a type"
                         : symbol->kind == Symbol::Kind::Enumerator ? "an enumerator, not a type"
                         : symbol->declaration->kind == Declaration::Kind::Constant
                             ? "a constant, not a type"
                             : "an exception; it can only be thrown";
        if (symbol || unknown_.insert(written).second) // each unknown name is reported once
            error(begin, "'" + written + "' is " + is);
        throw SyntaxError();
    }
    t.declaration = symbol->declaration;
    bool isInterface = t.declaration->kind == Declaration::Kind::Interface;
    bool isClass = t.declaration->kind == Declaration::Kind::Class;
    if (isSymbol("*") && !isInterface && !isClass) {
        error(token().at, "Slice has no pointers to data; for a result, write 'out " + written +
                              "' before the name of the parameter");
        throw SyntaxError();
    }
    t.kind = Kind::Named;
    if (accept("*")) {
        t.kind = Kind::Proxy;
        if (t.declaration->isLocal)
            error(begin, "'" + written + "' is local and has no proxies");
        if (isClass)
            diagnostics_.warning(begin, "proxy for a class is deprecated", Diagnostics::Deprecated);
    } else if (isInterface) {
        t.kind = Kind::Value;
        if (!t.declaration->isLocal)
            diagnostics_.warning(begin,
                                 "interface by value is deprecated; a proxy is '" + written + "*'",
                                 Diagnostics::Deprecated);
    }
    return t;
}

int32_t Parser::number(const std::string& what, bool mayBeEnumerator) {
    Location begin = token().at;
    int64_t v = 0;
    int before = diagnostics_.errors();
    if (at(Token::Kind::Integer)) {
        v = integerValue(token(), diagnostics_);
        ++position_;
    } else if (at(Token::Kind::Identifier) || isSymbol("::")) {
        std::string written = scopedName(what);
        Symbol* s = resolveValue(written, begin);
        bool isConstant = s && s->kind == Symbol::Kind::Declaration;
        if (s && s->kind == Symbol::Kind::Enumerator && mayBeEnumerator)
            v = s->declaration->enumerators[s->enumerator].value;
        else if (isConstant && s->declaration->kind == Declaration::Kind::Constant &&
                 s->declaration->value.kind == Literal::Kind::Integer)
            v = s->declaration->value.integer;
        else
            error(begin, "'" + written + "' is not a constant integer" +
                             (mayBeEnumerator ? " or an enumerator" : ""));
    } else {
        fail(what);
    }
    bool isWrong = diagnostics_.errors() > before;
    if (!isWrong && (v < 0 || v > INT32_MAX)) {
        error(begin, what + " must be 0 to 2147483647");
        isWrong = true;
    }
    return isWrong ? -1 : static_cast<int32_t>(v);
}

Parser::Optional Parser::optional() {
    Optional o;
    if (!isWord("optional"))
        return o;
    ++position_;
    expect("(");
    o.tag = number("the optional's tag", true);
    o.present = true;
    expect(")");
    return o;
}

// Finds a constant or an enumerator. As in Ice, an enumerator may be written without the name of
// its enum.
Symbol* Parser::resolveValue(const std::string& written, const Location& at) {
    if (Symbol* s = resolve(written, at))
        return s;
    size_t colons = written.rfind("::");
    std::string scope = scopeId_, bare = written;
    if (colons != std::string::npos) {
        Symbol* module = resolve(written.substr(0, colons), at);
        if (!module)
            return nullptr;
        scope = module->id;
        bare = written.substr(colons + 2);
    }
    const std::vector<Symbol*>& found = symbols_.bare(scope, bare);
    if (found.size() > 1)
        error(at, "enumerator '" + written + "' could be '" + found[0]->id + "' or '" +
                      found[1]->id + "'");
    if (found.empty())
        return nullptr;
    diagnostics_.warning(
        at, "enumerator '" + found.front()->id + "' without the name of its enum is deprecated",
        Diagnostics::Deprecated);
    return found.front();
}

// Finds an enumerator by its name alone. Reports an error if the name means something else in this
// scope, as Ice does.
Symbol* Parser::ownEnumerator(const Declaration& d, const std::string& name, const Location& at) {
    Symbol* found = symbols_.find(d.id() + "::" + name);
    Symbol* other = found ? symbols_.innermost(scopeId_, name) : nullptr;
    const Declaration* is = other ? other->declaration : nullptr;
    bool isConstant = is && is->kind == Declaration::Kind::Constant && is->value.owner == &d;
    if (other && other->kind != Symbol::Kind::Enumerator && !isConstant)
        error(at, "'" + name + "' means '" + other->id + "' here; write '" + d.name + "::" + name +
                      "' for the enumerator");
    return found;
}

Literal Parser::namedLiteral(const Type& type, const std::string& what) {
    Location begin = token().at;
    std::string written = scopedName("a value");
    // The value may be an enumerator of `type`, which needs no scope.
    Symbol* s = nullptr;
    if (type.declaration && type.declaration->kind == Declaration::Kind::Enum &&
        written.find("::") == std::string::npos)
        s = ownEnumerator(*type.declaration, written, begin);
    if (!s)
        s = resolveValue(written, begin);
    Literal v;
    if (!s) {
        error(begin, "'" + written + "' is not known here");
    } else if (s->kind == Symbol::Kind::Enumerator) {
        v.kind = Literal::Kind::Enumerator;
        v.owner = s->declaration;
        v.text = s->declaration->enumerators[s->enumerator].name;
        v.integer = s->declaration->enumerators[s->enumerator].value;
    } else if (s->kind == Symbol::Kind::Declaration &&
               s->declaration->kind == Declaration::Kind::Constant) {
        v = s->declaration->value;
    } else {
        error(begin, "'" + written + "' is not a constant or an enumerator");
    }
    return v.kind == Literal::Kind::None ? v : convert(v, type, what, begin);
}

Literal Parser::literal(const Type& type, const std::string& what) {
    Location begin = token().at;
    Literal v;
    if (at(Token::Kind::Integer)) {
        v.kind = Literal::Kind::Integer;
        v.integer = integerValue(token(), diagnostics_);
    } else if (at(Token::Kind::Float)) {
        v.kind = Literal::Kind::Floating;
        v.floating = floatingValue(token(), diagnostics_);
        v.text = token().text;
    } else if (at(Token::Kind::String)) {
        v.kind = Literal::Kind::String;
        v.text = stringValue(token(), diagnostics_);
    } else if (isWord("true") || isWord("false")) {
        v.kind = Literal::Kind::Bool;
        v.integer = isWord("true");
    } else if (at(Token::Kind::Identifier) || isSymbol("::")) {
        return namedLiteral(type, what);
    } else {
        fail("a value");
    }
    ++position_;
    return convert(v, type, what, begin);
}

// Converts a value to `type`. Reports an error and returns no value if that is not possible.
Literal Parser::convert(Literal v, const Type& type, const std::string& what, const Location& at) {
    auto wrong = [&](const std::string& text) {
        error(at, what + " of type '" + typeName(type) + "' " + text);
        return Literal();
    };
    auto ranged = [&](int64_t least, int64_t most) {
        if (v.kind != Literal::Kind::Integer)
            return wrong("needs an integer");
        if (v.integer < least || v.integer > most)
            return wrong("cannot be " + std::to_string(v.integer) + ": it is " +
                         std::to_string(least) + ".." + std::to_string(most));
        return v;
    };
    switch (type.kind) {
    case Kind::Bool:
        return v.kind == Literal::Kind::Bool ? v : wrong("needs true or false");
    case Kind::Byte:
        return ranged(0, 255);
    case Kind::Short:
        return ranged(INT16_MIN, INT16_MAX);
    case Kind::Int:
        return ranged(INT32_MIN, INT32_MAX);
    case Kind::Long:
        return ranged(INT64_MIN, INT64_MAX);
    case Kind::Float:
    case Kind::Double:
        if (v.kind == Literal::Kind::Integer) {
            v.kind = Literal::Kind::Floating;
            v.floating = static_cast<double>(v.integer);
            v.text = std::to_string(v.integer) + ".0";
        }
        if (v.kind != Literal::Kind::Floating)
            return wrong("needs a number");
        if (type.kind == Kind::Float && std::fabs(v.floating) > static_cast<double>(FLT_MAX))
            return wrong("is too large");
        return v;
    case Kind::String:
        return v.kind == Literal::Kind::String ? v : wrong("needs a string");
    case Kind::Named:
        if (type.declaration->kind == Declaration::Kind::Enum)
            return v.kind == Literal::Kind::Enumerator && v.owner == type.declaration
                       ? v
                       : wrong("needs one of its enumerators");
        break;
    default:
        break;
    }
    return wrong("cannot have a value: only numbers, bool, string and enums can");
}
