// SPDX-License-Identifier: MIT
//
// front: runs the steps of the compiler, from the source text to the checked unit. The last step
// makes classes callable, as in Ice's C++11 mapping: for each class with operations, it creates an
// interface that has the class's operations, including inherited ones, and the class's type id.

#include "front/front.h"
#include "front/parser.h"
#include <map>

namespace {

std::unique_ptr<Declaration> interfaceOf(const Declaration& c, const Declaration* base) {
    auto i = std::make_unique<Declaration>();
    i->kind = Declaration::Kind::Interface;
    i->name = c.name + "Disp";
    i->ofClass = &c;
    i->scope = c.scope;
    i->at = c.at;
    i->fromInclude = c.fromInclude;
    i->operations = c.operations;
    if (base)
        i->bases.push_back(base);
    i->bases.insert(i->bases.end(), c.implemented.begin(), c.implemented.end());
    for (const std::string& m : c.metadata)
        if (m == "amd" || m.compare(0, 7, "format:") == 0)
            i->metadata.push_back(m);
    return i;
}

// Adds an interface after each class that has operations. The interface has the operations of the
// class.
void addClassInterfaces(Unit& unit) {
    std::map<const Declaration*, const Declaration*> made; // created interface of each class
    std::vector<std::unique_ptr<Declaration>> all;
    for (auto& d : unit.declarations) {
        const Declaration* c = d.get();
        all.push_back(std::move(d));
        if (c->kind != Declaration::Kind::Class || c->isLocal || c->isForward)
            continue;
        auto base = made.find(c->base());
        bool isServed = !c->operations.empty() || !c->implemented.empty() || base != made.end();
        if (!isServed)
            continue;
        all.push_back(interfaceOf(*c, base == made.end() ? nullptr : base->second));
        made[c] = all.back().get();
    }
    unit.declarations = std::move(all);
}

} // namespace

Unit compileUnit(const std::string& text, const std::string& file, NameRules rules,
                 Diagnostics& diagnostics) {
    const std::vector<Token> tokens = tokenize(text, file, diagnostics);
    Unit unit = Parser(tokens, file, rules, diagnostics).run();
    if (diagnostics.errors() == 0)
        addClassInterfaces(unit);
    return unit;
}
