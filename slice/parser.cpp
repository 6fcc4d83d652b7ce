// SPDX-License-Identifier: MIT
//
// parser: recursive descent.

#include "parser.h"
#include <filesystem>
#include <map>
#include <set>

namespace {

struct SyntaxError {};

const std::map<std::string, Type::Kind> basicTypes = {
    {"void", Type::Kind::Void},     {"bool", Type::Kind::Bool},     {"byte", Type::Kind::Byte},
    {"short", Type::Kind::Short},   {"int", Type::Kind::Int},       {"long", Type::Kind::Long},
    {"float", Type::Kind::Float},   {"double", Type::Kind::Double}, {"string", Type::Kind::String}};

// Known to Slice, not to the C mapping: said so, instead of a syntax error.
const std::set<std::string> notMapped = {"class", "exception", "dictionary", "optional", "local"};

class Parser {
public:
    Parser(const std::vector<Token>& tokens, const std::string& mainFile, Diagnostics& diagnostics)
        : tokens_(tokens), mainFile_(mainFile), diagnostics_(diagnostics) {}

    Unit run() {
        while (!at(Token::Kind::End))
            guarded();
        for (const auto& d : unit_.declarations)
            if (d->kind == Declaration::Kind::Interface && d->isForward)
                diagnostics_.error(d->at, "interface '" + d->name + "' is declared, but never defined");
        return std::move(unit_);
    }

private:
    const Token& token(size_t ahead = 0) const {
        return tokens_[std::min(position_ + ahead, tokens_.size() - 1)];
    }
    bool at(Token::Kind kind) const { return token().kind == kind; }
    bool isSymbol(const std::string& text) const {
        return at(Token::Kind::Symbol) && token().text == text;
    }
    bool isWord(const std::string& text) const {
        return at(Token::Kind::Identifier) && token().text == text && !token().escaped;
    }
    bool accept(const std::string& symbol) {
        if (!isSymbol(symbol))
            return false;
        ++position_;
        return true;
    }
    [[noreturn]] void fail(const std::string& expected) {
        std::string found = at(Token::Kind::End) ? "the end of the file" : "'" + token().text + "'";
        diagnostics_.error(token().at, "found " + found + "; expected " + expected);
        throw SyntaxError();
    }
    void expect(const std::string& symbol) {
        if (!accept(symbol))
            fail("'" + symbol + "'");
    }
    std::string identifier(const std::string& what) {
        if (!at(Token::Kind::Identifier))
            fail(what);
        if (!token().escaped && basicTypes.count(token().text))
            fail(what + " ('" + token().text + "' is a keyword; write '\\" + token().text + "')");
        return tokens_[position_++].text;
    }

    // Skips to behind the next ';' or '}' of this level.
    void recover() {
        int depth = 0;
        while (!at(Token::Kind::End)) {
            if (isSymbol("{"))
                ++depth;
            if (isSymbol("}") && depth-- == 0)
                return; // belongs to the module around
            bool ends = (isSymbol(";") || isSymbol("}")) && depth <= 0;
            ++position_;
            if (ends) {
                accept(";");
                return;
            }
        }
    }
    void guarded() {
        size_t before = position_;
        try {
            declaration();
        } catch (const SyntaxError&) {
            recover();
        }
        if (position_ == before)
            ++position_; // a stray '}': reported, and passed
    }

    std::vector<std::string> metadata() {
        std::vector<std::string> found;
        while (isSymbol("[") || isSymbol("[[")) {
            std::string close = token().text == "[" ? "]" : "]]";
            ++position_;
            do {
                if (!at(Token::Kind::String))
                    fail("a string of metadata");
                found.push_back(tokens_[position_++].text);
            } while (accept(","));
            expect(close);
        }
        return found;
    }

    void declaration() {
        std::vector<std::string> meta = metadata();
        if (!at(Token::Kind::Identifier))
            fail("module, enum, struct, sequence, interface or const");
        std::string word = token().text;
        if (word == "module")
            return module();
        if (word == "enum")
            return enumeration(meta);
        if (word == "struct")
            return structure(meta);
        if (word == "sequence")
            return sequence(meta);
        if (word == "interface")
            return interface(meta);
        if (word == "const")
            return constant();
        if (notMapped.count(word)) {
            diagnostics_.error(token().at, "'" + word + "' is not mapped to C; use structs, sequences and "
                                           "interfaces");
            throw SyntaxError();
        }
        fail("module, enum, struct, sequence, interface or const");
    }

    void module() {
        ++position_;
        size_t depth = scope_.size();
        do
            scope_.push_back(identifier("the module's name"));
        while (accept("::"));
        expect("{");
        while (!isSymbol("}")) {
            if (at(Token::Kind::End))
                fail("'}' at the end of module '" + scope_.back() + "'");
            guarded();
        }
        ++position_;
        accept(";");
        scope_.resize(depth);
    }

    // The preprocessor may write the main file's name another way than the command line did.
    bool isMain(const std::string& file) {
        auto [it, isNew] = isMain_.try_emplace(file, false);
        if (isNew) {
            std::error_code error;
            it->second = file == mainFile_ || std::filesystem::equivalent(file, mainFile_, error);
        }
        return it->second;
    }

    Declaration& add(Declaration::Kind kind, const std::vector<std::string>& meta) {
        auto d = std::make_unique<Declaration>();
        d->kind = kind;
        d->doc = token().doc;
        ++position_; // the keyword
        d->at = token().at;
        d->fromInclude = !isMain(d->at.file);
        d->scope = scope_;
        d->metadata = meta;
        if (kind != Declaration::Kind::Sequence && kind != Declaration::Kind::Constant)
            name(*d, identifier("a name"));
        unit_.declarations.push_back(std::move(d));
        return *unit_.declarations.back();
    }
    void name(Declaration& d, const std::string& name) {
        Declaration* other = find(scopedId(name));
        d.name = name;
        if (scope_.empty())
            diagnostics_.error(d.at, "'" + name + "' must be in a module");
        if (other && !(other->kind == Declaration::Kind::Interface && other->isForward))
            diagnostics_.error(d.at, "'" + name + "' is defined already, at line " +
                                         std::to_string(other->at.line));
    }
    std::string scopedId(const std::string& name) const {
        std::string id;
        for (const std::string& module : scope_)
            id += "::" + module;
        return id + "::" + name;
    }
    Declaration* find(const std::string& id) {
        for (auto& d : unit_.declarations)
            if (!d->name.empty() && d->id() == id)
                return d.get();
        return nullptr;
    }

    Type type() {
        Type t;
        Location begin = token().at;
        if (at(Token::Kind::Identifier) && !token().escaped && notMapped.count(token().text)) {
            diagnostics_.error(begin, "'" + token().text + "' is not mapped to C");
            throw SyntaxError();
        }
        if (at(Token::Kind::Identifier) && !token().escaped && basicTypes.count(token().text)) {
            t.kind = basicTypes.at(tokens_[position_++].text);
            return t;
        }
        std::string written;
        if (accept("::"))
            written = "::";
        do
            written += (written.empty() || written == "::" ? "" : "::") + identifier("a type");
        while (accept("::"));
        if (written == "Object" && isSymbol("*")) {
            ++position_;
            t.kind = Type::Kind::Proxy;
            return t;
        }
        t.declaration = resolve(written);
        if (!t.declaration) {
            diagnostics_.error(begin, "'" + written + "' is not a type that is known here");
            throw SyntaxError();
        }
        bool isInterface = t.declaration->kind == Declaration::Kind::Interface;
        if (isSymbol("*") && !isInterface) {
            diagnostics_.error(token().at, "Slice has no pointers to data; for a result, write 'out " +
                                               written + "' before the parameter's name");
            throw SyntaxError();
        }
        if (isInterface && !accept("*"))
            fail("'*': an interface is passed as a proxy, '" + written + "*'");
        if (t.declaration->kind == Declaration::Kind::Constant) {
            diagnostics_.error(begin, "'" + written + "' is a constant, not a type");
            throw SyntaxError();
        }
        t.kind = isInterface ? Type::Kind::Proxy : Type::Kind::Named;
        return t;
    }
    Declaration* resolve(const std::string& written) {
        if (written.rfind("::", 0) == 0)
            return find(written);
        for (size_t depth = scope_.size() + 1; depth-- > 0;) {
            std::string id;
            for (size_t i = 0; i < depth; ++i)
                id += "::" + scope_[i];
            if (Declaration* d = find(id + "::" + written))
                return d;
        }
        return nullptr;
    }

    void enumeration(const std::vector<std::string>& meta) {
        Declaration& d = add(Declaration::Kind::Enum, meta);
        expect("{");
        int64_t next = 0;
        while (!isSymbol("}")) {
            Enumerator e;
            Location begin = token().at;
            e.name = identifier("an enumerator");
            if (accept("=")) {
                if (!at(Token::Kind::Integer))
                    fail("a number");
                next = std::stoll(tokens_[position_++].text, nullptr, 0);
            }
            if (next < 0 || next > 0x7FFFFFFF)
                diagnostics_.error(begin, "an enumerator's value is 0..2147483647");
            e.value = next++;
            for (const Enumerator& other : d.enumerators)
                if (other.name == e.name || other.value == e.value)
                    diagnostics_.error(begin, "name or value of '" + e.name + "' is taken by '" +
                                                  other.name + "'");
            d.enumerators.push_back(e);
            if (!accept(","))
                break;
        }
        expect("}");
        accept(";");
        if (d.enumerators.empty())
            diagnostics_.error(d.at, "an enum has at least one enumerator");
    }

    void structure(const std::vector<std::string>& meta) {
        Declaration& d = add(Declaration::Kind::Struct, meta);
        expect("{");
        while (!isSymbol("}")) {
            metadata();
            Field f;
            f.doc = token().doc;
            f.type = type();
            f.at = token().at;
            f.name = identifier("the member's name");
            for (const Field& other : d.fields)
                if (other.name == f.name)
                    diagnostics_.error(f.at, "member '" + f.name + "' is there already");
            if (f.type.kind == Type::Kind::Void)
                diagnostics_.error(f.at, "a member cannot be void");
            if (accept("=")) {
                while (!isSymbol(";") && !at(Token::Kind::End))
                    ++position_;
                diagnostics_.warning(f.at, "the default of '" + f.name + "' is not used: C has no constructors");
            }
            expect(";");
            d.fields.push_back(f);
        }
        expect("}");
        accept(";");
        if (d.fields.empty())
            diagnostics_.error(d.at, "a struct has at least one member");
    }

    void sequence(const std::vector<std::string>& meta) {
        Declaration& d = add(Declaration::Kind::Sequence, meta);
        expect("<");
        metadata();
        d.element = type();
        expect(">");
        d.at = token().at;
        name(d, identifier("the sequence's name"));
        expect(";");
    }

    void constant() {
        Declaration& d = add(Declaration::Kind::Constant, {});
        d.element = type();
        d.at = token().at;
        name(d, identifier("the constant's name"));
        expect("=");
        if (at(Token::Kind::End) || at(Token::Kind::Symbol))
            fail("a value");
        d.value = at(Token::Kind::String) ? '"' + token().text + '"' : token().text;
        ++position_;
        expect(";");
    }

    void interface(const std::vector<std::string>& meta) {
        Declaration* d = &add(Declaration::Kind::Interface, meta);
        if (accept(";")) {
            if (find(d->id()) != d)
                unit_.declarations.pop_back();
            else
                d->isForward = true;
            return;
        }
        Declaration* earlier = find(d->id());
        if (earlier != d && earlier->isForward) { // the definition of what was declared before
            std::unique_ptr<Declaration> own = std::move(unit_.declarations.back());
            unit_.declarations.pop_back();
            *earlier = std::move(*own);
            d = earlier;
        }
        if (isWord("extends")) {
            ++position_;
            do {
                Location begin = token().at;
                std::string written = identifier("the interface to extend");
                while (accept("::"))
                    written += "::" + identifier("the interface to extend");
                Declaration* base = resolve(written);
                if (!base || base->kind != Declaration::Kind::Interface)
                    diagnostics_.error(begin, "'" + written + "' is not an interface");
                else
                    d->bases.push_back(base);
            } while (accept(","));
        }
        expect("{");
        while (!isSymbol("}")) {
            if (at(Token::Kind::End))
                fail("'}' at the end of interface '" + d->name + "'");
            try {
                operation(*d);
            } catch (const SyntaxError&) {
                recover();
            }
        }
        expect("}");
        accept(";");
    }

    void operation(Declaration& d) {
        metadata();
        Operation o;
        o.doc = token().doc;
        if (isWord("idempotent")) {
            ++position_;
            o.idempotent = true;
        }
        o.result = type();
        o.at = token().at;
        o.name = identifier("the operation's name");
        for (const Operation& other : d.operations)
            if (other.name == o.name)
                diagnostics_.error(o.at, "operation '" + o.name + "' is there already; Slice has no overloading");
        expect("(");
        if (isWord("void") && token(1).kind == Token::Kind::Symbol && token(1).text == ")") {
            diagnostics_.warning(token().at, "'(void)' is C, not Slice; taken as '()'");
            ++position_;
        }
        while (!isSymbol(")")) {
            metadata();
            Field p;
            if (isWord("out")) {
                ++position_;
                p.isOut = true;
            }
            p.type = type();
            p.at = token().at;
            p.name = identifier("the parameter's name");
            if (p.type.kind == Type::Kind::Void)
                diagnostics_.error(p.at, "a parameter cannot be void");
            if (!p.isOut && !o.parameters.empty() && o.parameters.back().isOut)
                diagnostics_.error(p.at, "in parameters come before out parameters");
            o.parameters.push_back(p);
            if (!accept(","))
                break;
        }
        expect(")");
        if (isWord("throws")) {
            diagnostics_.error(token().at, "user exceptions are not mapped to C; return a result");
            throw SyntaxError();
        }
        expect(";");
        d.operations.push_back(o);
    }

    const std::vector<Token>& tokens_;
    std::string mainFile_;
    Diagnostics& diagnostics_;
    size_t position_ = 0;
    std::vector<std::string> scope_;
    std::map<std::string, bool> isMain_;
    Unit unit_;
};

} // namespace

Unit parse(const std::vector<Token>& tokens, const std::string& mainFile, Diagnostics& diagnostics) {
    return Parser(tokens, mainFile, diagnostics).run();
}
