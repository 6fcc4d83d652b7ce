// SPDX-License-Identifier: MIT
//
// operations: converts operations to lists of C parameters.

#include "c/context.h"
#include <algorithm>
#include <set>

namespace {

const char* const resultName = "result";

// Returns the declaration of an in parameter or of a response value. An optional parameter or value
// is a pointer, which is 0 if the value is absent.
std::string passed(const Type& t, const std::string& name, bool isOptional) {
    bool isPointer = isByPointer(t) || isOptional;
    if (isClass(t))
        return "const " + cVariable(t, isPointer ? "const *" + name : name);
    return isPointer ? "const " + cVariable(t, "*" + name) : cVariable(t, name);
}

Slot passedSlot(const Type& t, const std::string& name, bool isOptional, int tag) {
    bool pointer = isByPointer(t) || isOptional;
    return {&t, pointer ? "*" + name : name, pointer ? name : "&" + name, isOptional, tag, name};
}

// One result of an operation. The results are in the order of the mapping: out parameters, then the
// return value.
struct Result {
    const Type* type;
    std::string name;
    bool isOptional;
    int tag;
};

std::vector<Result> results(const Operation& o) {
    std::vector<Result> list;
    for (const Field& p : o.parameters)
        if (p.isOut)
            list.push_back({&p.type, cParameter(o, p), p.isOptional, p.tag});
    if (o.result.kind != Type::Kind::Void)
        list.push_back({&o.result, resultName, o.isResultOptional, o.resultTag});
    return list;
}

void collect(const Declaration& d, std::set<const Declaration*>& seen,
             std::vector<const Declaration*>& list) {
    if (!seen.insert(&d).second)
        return;
    for (const Declaration* base : d.bases)
        collect(*base, seen, list);
    list.push_back(&d);
}

} // namespace

std::vector<const Declaration*> lineage(const Declaration& interface) {
    std::set<const Declaration*> seen;
    std::vector<const Declaration*> list;
    collect(interface, seen, list);
    return list;
}

std::vector<const Declaration*> mayThrow(const Unit& unit, const Operation& o) {
    std::vector<const Declaration*> list;
    if (o.throws.empty())
        return list;
    for (const auto& d : unit.declarations)
        if (d->kind == Declaration::Kind::Exception &&
            std::any_of(o.throws.begin(), o.throws.end(),
                        [&](const Declaration* t) { return d->isA(*t); }))
            list.push_back(d.get());
    return list;
}

bool throwsPreserved(const Unit& unit, const Operation& o) {
    auto list = mayThrow(unit, o);
    return std::any_of(list.begin(), list.end(),
                       [](const Declaration* e) { return e->preserves(); });
}

// Returns whether no earlier exception in the union has the same name as this exception. If an
// earlier one has, this exception gets another name in the union. Declared exceptions come before
// derived ones, so a new derived exception never renames a declared exception.
static bool isFirstOfName(const Operation& o, const std::vector<const Declaration*>& family,
                          const Declaration& exception) {
    for (const auto& list : {o.throws, family})
        for (const Declaration* e : list)
            if (e->name == exception.name)
                return e == &exception;
    return true;
}

std::string exceptionLabel(const Operation& o, const std::vector<const Declaration*>& family,
                           const Declaration& exception) {
    static const std::set<std::string> reserved = {"Async", "Exception", "exception", "none",
                                                   "response"};
    if (!isFirstOfName(o, family, exception))
        return cName(exception);
    return exception.name + (reserved.count(exception.name) ? "_" : "");
}

std::string exceptionMember(const Operation& o, const std::vector<const Declaration*>& family,
                            const Declaration& exception) {
    // In C++, a member must not have the same name as its type.
    return isFirstOfName(o, family, exception) ? cIdentifier(exceptionLabel(o, family, exception))
                                               : cName(exception) + "_";
}

bool hasResults(const Operation& o) {
    return !results(o).empty();
}

bool isAmd(const Declaration& owner, const Operation& o) {
    return hasMetadata(o.metadata, "amd") || hasMetadata(owner.metadata, "amd");
}

bool isSliced(const Declaration& owner, const Operation& o) {
    std::string format = metadataValue(o.metadata, "format");
    return (format.empty() ? metadataValue(owner.metadata, "format") : format) == "sliced";
}

bool sendsClasses(const Operation& o) {
    return std::any_of(o.parameters.begin(), o.parameters.end(),
                       [](const Field& p) { return !p.isOut && factsOf(p.type).hasClass; });
}

bool returnsClasses(const Operation& o) {
    auto list = results(o);
    return std::any_of(list.begin(), list.end(),
                       [](const Result& r) { return factsOf(*r.type).hasClass; });
}

bool anyClass(const std::vector<Slot>& slots) {
    return std::any_of(slots.begin(), slots.end(),
                       [](const Slot& s) { return factsOf(*s.type).hasClass; });
}

bool anyRequiredClass(const std::vector<Slot>& slots) {
    return std::any_of(slots.begin(), slots.end(),
                       [](const Slot& s) { return !s.isOptional && factsOf(*s.type).hasClass; });
}

std::string operationName(const Declaration& owner, const Operation& o) {
    return cName(owner) + "_" + cOperation(o.name);
}

std::string exceptionType(const Declaration& owner, const Operation& o) {
    return operationName(owner, o) + "_Exception";
}

std::string inParameters(const Operation& o) {
    std::string list;
    for (const Field& p : o.parameters)
        if (!p.isOut)
            list += ", " + passed(p.type, cParameter(o, p), p.isOptional);
    return list;
}

std::string outParameters(const Declaration& owner, const Operation& o, bool isSent) {
    std::string list;
    for (const Result& r : results(o)) {
        if (r.isOptional)
            list += ", Ice_Bool *has_" + r.name;
        list += isSent && isClass(*r.type) ? ", const " : ", ";
        list += cVariable(*r.type, "*" + r.name);
    }
    if (!o.throws.empty())
        list += ", " + exceptionType(owner, o) + " *ex";
    return list;
}

// Returns the parameters that pass the results to the function that sends the response.
static std::string responseParameters(const Operation& o) {
    std::string list;
    for (const Result& r : results(o))
        list += ", " + passed(*r.type, r.name, r.isOptional);
    return list;
}

std::string proxySignature(const Declaration& d, const Operation& o) {
    return "Ice_Status " + cProxy(d) + "_" + cOperation(o.name) + "(" + cProxy(d) + "Ptr self" +
           inParameters(o) + outParameters(d, o, false) + ")";
}

std::string asyncSignature(const Declaration& d, const Operation& o) {
    return "Ice_Status " + cProxy(d) + "_" + cOperation(o.name) + "_async(" + cProxy(d) +
           "Ptr self" + inParameters(o) + ", " + operationName(d, o) + "_Async *call)";
}

std::string servantSignature(const Declaration& owner, const Operation& o,
                             const std::string& name) {
    std::string list = "Ice_Status " + name + "(" + cName(owner) + "Ptr self" + inParameters(o);
    if (!isAmd(owner, o))
        list += outParameters(owner, o, true);
    return list + ", const Ice_Current *current)";
}

std::string responseSignature(const Declaration& d, const Operation& o) {
    return "Ice_Status " + operationName(d, o) + "_response(Ice_Reply *reply" +
           responseParameters(o) + ")";
}

std::vector<Slot> inSlots(const Operation& o) {
    std::vector<Slot> list;
    for (const Field& p : o.parameters)
        if (!p.isOut)
            list.push_back(passedSlot(p.type, cParameter(o, p), p.isOptional, p.tag));
    return list;
}

std::vector<Slot> inVariables(const Operation& o) {
    std::vector<Slot> list;
    for (const Field& p : o.parameters)
        if (!p.isOut) {
            std::string name = cParameter(o, p);
            list.push_back({&p.type, name, "&" + name, p.isOptional, p.tag, "has_" + name});
        }
    return list;
}

std::vector<Slot> outSlots(const Operation& o, const std::string& object) {
    std::vector<Slot> list;
    for (const Result& r : results(o)) {
        Slot s{r.type,       object + r.name, "&" + object + r.name,
               r.isOptional, r.tag,           object + "has_" + r.name};
        if (object == "*") {
            s.value = "*" + r.name;
            s.pointer = r.name;
        }
        list.push_back(s);
    }
    return list;
}

std::vector<Slot> responseSlots(const Operation& o) {
    std::vector<Slot> list;
    for (const Result& r : results(o))
        list.push_back(passedSlot(*r.type, r.name, r.isOptional, r.tag));
    return list;
}
