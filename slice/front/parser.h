// SPDX-License-Identifier: MIT
//
// parser: turns tokens into the declarations of a unit, with every name resolved. It reports errors
// and continues after them.

#pragma once

#include "front/ast.h"
#include "front/symbols.h"
#include <map>
#include <set>
#include <string_view>
#include <vector>

// A token of preprocessed Slice text, with its position in the original file.
struct Token {
    enum class Kind { Identifier, Integer, Float, String, Symbol, End };
    Kind kind;
    std::string_view text; // text as written; for a string, the text between the quotes
    std::string_view doc;  // doc comment before the token, without /** and */
    std::string comment;   // text of the // lines directly above the token
    Location at;
    bool escaped; // true for an identifier written with a backslash
};

// Splits `text` into tokens, which point into `text`. The last token is End.
std::vector<Token> tokenize(std::string_view text, std::string_view file, Diagnostics& diagnostics);

// Return names for messages: "struct" for a kind; "int", "::M::I*" for a type.
const char* kindName(Declaration::Kind kind);
std::string typeName(const Type& type);

// ---- values of tokens (literals.cpp)

// Returns the value of a signed number in decimal, 0octal or 0xhex. Reports an error and returns 0
// if it is malformed or out of range.
int64_t integerValue(const Token& token, Diagnostics& diagnostics);
double floatingValue(const Token& token, Diagnostics& diagnostics);
// Returns the bytes of a string literal with its escapes replaced; \u and \U become UTF-8.
std::string stringValue(const Token& token, Diagnostics& diagnostics);

class Parser {
public:
    // `mainFile` is the file on the command line; declarations in other files are marked
    // fromInclude.
    Parser(const std::vector<Token>& tokens, const std::string& mainFile, NameRules rules,
           Diagnostics& diagnostics);
    Unit run();

private:
    struct SyntaxError {};
    struct Optional {
        bool present = false;
        int tag = 0;
    };
    using Metadata = std::vector<std::string>;

    // ---- tokens (parser.cpp)
    const Token& token(size_t ahead = 0) const {
        return tokens_[std::min(position_ + ahead, tokens_.size() - 1)];
    }
    bool at(Token::Kind kind) const { return token().kind == kind; }
    bool isSymbol(std::string_view text, size_t ahead = 0) const {
        return token(ahead).kind == Token::Kind::Symbol && token(ahead).text == text;
    }
    bool isWord(std::string_view text, size_t ahead = 0) const {
        return token(ahead).kind == Token::Kind::Identifier && token(ahead).text == text &&
               !token(ahead).escaped;
    }
    bool accept(std::string_view symbol);
    bool acceptWord(std::string_view word);
    void expect(std::string_view symbol);
    void expectEnd(const std::string& what); // expects a '}'
    [[noreturn]] void fail(const std::string& expected);
    void error(const Location& at, const std::string& text) { diagnostics_.error(at, text); }
    // Reads a name that is being declared, and checks it.
    std::string name(const std::string& what);
    std::string scopedName(const std::string& what);
    void recover();
    // Runs a grammar rule. After a syntax error, skips to the next ';' or '}', where parsing
    // continues.
    template <class Rule> void guarded(Rule rule);
    template <class Rule> void braces(const Declaration& d, Rule rule);
    std::string doc();

    // ---- files and metadata (parser.cpp)
    bool isMain(std::string_view file);
    void metadataStrings(Metadata& found, std::string_view end);
    Metadata metadata();
    void readMetadata(std::string& text, Metadata& found);
    void fileMetadata();
    void suppressWarnings(const std::string& metadata, std::string_view file);

    // ---- definitions (parser.cpp, parser_data.cpp, parser_interface.cpp)
    void definition();
    void module();
    Declaration& add(Declaration::Kind kind, const std::string& name, const Location& at);
    Declaration& declareType(Declaration::Kind kind, bool mayBeForward);
    void checkGlobal(const std::string& name, const Location& at);
    void enumeration();
    void structure();
    void exception();
    void classDefinition();
    void sequence();
    void dictionary();
    void constant();
    void interface();

    // ---- parts of definitions
    void member(Declaration& d, bool mayBeOptional);
    void checkMember(const Declaration& d, const Field& f);
    void checkMemberOfClass(const Declaration& d, const Field& f);
    void operation(Declaration& d);
    void parameters(Operation& o, const Declaration& owner);
    void throwsClause(Operation& o, const Declaration& owner);
    void checkOperation(const Declaration& d, const Operation& o);
    std::vector<const Declaration*> baseList(const Declaration& d, Declaration::Kind wanted,
                                             bool many);
    void checkBases(const Declaration& d);

    // ---- types and values (parser_types.cpp)
    Type type();
    Type namedType();
    Optional optional();
    Literal literal(const Type& type, const std::string& what);
    Symbol* ownEnumerator(const Declaration& d, const std::string& name, const Location& at);
    Literal namedLiteral(const Type& type, const std::string& what);
    Literal convert(Literal value, const Type& type, const std::string& what, const Location& at);
    // Reads a number that is not negative. Returns -1 after an error.
    int32_t number(const std::string& what, bool mayBeEnumerator);
    Symbol* resolve(const std::string& written, const Location& at);
    Symbol* resolveValue(const std::string& written, const Location& at);
    void checkLocal(const Type& type, bool local, const std::string& what, const Location& at);

    const std::vector<Token>& tokens_;
    std::string mainFile_;
    NameRules rules_;
    Diagnostics& diagnostics_;
    Symbols symbols_;
    size_t position_ = 0;
    std::vector<std::string> scope_;
    std::string scopeId_; // "::A::B"
    // type that is being parsed; the names that it uses are recorded for the type, not for its
    // module
    std::string user_;
    std::map<std::string_view, bool> isMain_;
    std::set<std::string_view> begun_; // files with at least one definition so far
    std::map<int, std::string> compactIds_;
    std::set<std::string> unknown_; // names of unknown types that have been reported
    // State of the current definition.
    Metadata metadata_;
    std::string doc_;
    bool local_ = false;
    Unit unit_;
};

template <class Rule> void Parser::guarded(Rule rule) {
    size_t before = position_;
    try {
        rule();
    } catch (const SyntaxError&) {
        recover();
    }
    if (position_ == before)
        ++position_; // a '}' without '{' is reported and skipped
}

// Parses { rule rule ... } with an optional ';' after it.
template <class Rule> void Parser::braces(const Declaration& d, Rule rule) {
    if (isSymbol(":")) // this is the syntax of Ice 3.8
        fail("'{'; in Ice 3.7 a base follows 'extends', not ':'");
    expect("{");
    user_ = d.id();
    while (!isSymbol("}") && !at(Token::Kind::End))
        guarded(rule);
    user_.clear();
    expectEnd("'}' at the end of " + std::string(kindName(d.kind)) + " '" + d.name + "'");
    accept(";");
}
