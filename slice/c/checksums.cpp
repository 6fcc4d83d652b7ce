// SPDX-License-Identifier: MIT
//
// checksums: the digest of a definition in one fixed spelling: without comments, metadata and
// defaults, optionals by their tags. Words and blanks are those of slice2cpp
// (tests/slice/compiler/commandline_test.py compares).

#include "c/context.h"
#include "front/parser.h"
#define OPENSSL_SUPPRESS_DEPRECATED // MD5, which protects no secret here
#include <algorithm>
#include <cstdio>
#include <openssl/md5.h>
#include <sstream>

namespace {

using DKind = Declaration::Kind;

std::string written(const Type& t) {
    switch (t.kind) {
    case Type::Kind::Bool:
        return "boolean";
    case Type::Kind::Value:
        return t.declaration ? t.declaration->id() : "Object"; // slice2cpp fails on Value
    default:
        return typeName(t);
    }
}

std::string listed(const std::vector<const Declaration*>& declarations) {
    std::string list;
    for (const Declaration* d : declarations)
        list += (list.empty() ? "" : ", ") + d->id();
    return list;
}

// Required ones in their order, then the optional ones by tag.
std::vector<const Field*> ordered(const std::vector<Field>& fields) {
    std::vector<const Field*> list;
    for (const Field& f : fields)
        list.push_back(&f);
    std::stable_sort(list.begin(), list.end(), [](const Field* a, const Field* b) {
        return a->isOptional != b->isOptional ? b->isOptional : a->isOptional && a->tag < b->tag;
    });
    return list;
}

std::string named(const Field& f) {
    return written(f.type) + ' ' + (f.isOptional ? std::to_string(f.tag) + ' ' : "") + f.name;
}

void members(std::ostream& out, const Declaration& d) {
    for (const Field* f : ordered(d.fields))
        out << named(*f) << (f->isOptional ? "" : "\n"); // no line end: slice2cpp has none
}

void operation(std::ostream& out, const Operation& o) {
    out << written(o.result) << ' ' << (o.isResultOptional ? std::to_string(o.resultTag) + ' ' : "")
        << o.name << '(';
    // slice2cpp puts a comma before the first required parameter if an optional one was declared
    // before it.
    bool comma = !o.parameters.empty() && o.parameters.front().isOptional &&
                 std::any_of(o.parameters.begin(), o.parameters.end(),
                             [](const Field& p) { return !p.isOptional; });
    for (const Field* p : ordered(o.parameters)) {
        out << (comma ? ", " : "") << (p->isOut ? "out " : "") << named(*p);
        comma = true;
    }
    out << ')';
    if (!o.throws.empty())
        out << " throws " << listed(o.throws);
    out << '\n';
}

void enumerators(std::ostream& out, const Declaration& d) {
    auto list = d.enumerators;
    if (d.hasValues)
        std::stable_sort(list.begin(), list.end(), [](const Enumerator& a, const Enumerator& b) {
            return a.value < b.value;
        });
    for (const Enumerator& e : list)
        out << e.name << (d.hasValues ? ' ' + std::to_string(e.value) : "") << '\n';
}

std::string value(const Literal& v) {
    std::ostringstream out;
    switch (v.kind) {
    case Literal::Kind::Bool:
        return v.integer ? "true" : "false";
    case Literal::Kind::Integer:
        return std::to_string(v.integer);
    case Literal::Kind::Floating:
        out << v.floating; // six digits, as slice2cpp
        return out.str();
    default:
        return v.written;
    }
}

std::string definition(const Declaration& d) {
    std::ostringstream out;
    switch (d.kind) {
    case DKind::Sequence:
        out << "sequence<" << written(d.element) << "> " << d.name << '\n';
        break;
    case DKind::Dictionary:
        out << "dictionary<" << written(d.key) << ", " << written(d.element) << "> " << d.name
            << '\n';
        break;
    case DKind::Constant:
        out << "const " << written(d.element) << ' ' << d.name << " = " << value(d.value) << '\n';
        break;
    default:
        out << kindName(d.kind) << ' ' << d.name;
        if (d.compactId >= 0)
            out << '(' << d.compactId << ')';
        if (!d.bases.empty())
            out << " extends " << listed(d.bases);
        if (!d.implemented.empty())
            out << " implements " << listed(d.implemented);
        out << '\n';
        enumerators(out, d);
        members(out, d);
        for (const Operation& o : d.operations)
            operation(out, o);
    }
    return out.str();
}

} // namespace

std::map<std::string, std::string> checksums(const Unit& unit) {
    std::map<std::string, std::string> all;
    for (const auto& d : unit.declarations) {
        if (d->fromInclude || d->isLocal || d->isForward || d->ofClass)
            continue;
        std::string text = definition(*d), digits;
        unsigned char digest[MD5_DIGEST_LENGTH];
        MD5_CTX context; // MD5() would bring all of libcrypto into the program
        MD5_Init(&context);
        MD5_Update(&context, text.data(), text.size());
        MD5_Final(digest, &context);
        for (unsigned char byte : digest) {
            char two[3];
            std::snprintf(two, sizeof two, "%x", byte); // slice2cpp's has no leading zeros either
            digits += two;
        }
        all[d->id()] = digits;
    }
    return all;
}
