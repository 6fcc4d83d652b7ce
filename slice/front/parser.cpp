// SPDX-License-Identifier: MIT
//
// parser: handles tokens, error recovery and modules, and selects the rule for each definition.

#include "front/parser.h"
#include <algorithm>
#include <filesystem>
#include <sstream>

const char* kindName(Declaration::Kind kind) {
    static const char* const names[] = {"enum",      "struct", "sequence",  "dictionary",
                                        "interface", "class",  "exception", "constant"};
    return names[static_cast<int>(kind)];
}

Parser::Parser(const std::vector<Token>& tokens, const std::string& mainFile, NameRules rules,
               Diagnostics& diagnostics)
    : tokens_(tokens), mainFile_(mainFile), rules_(rules), diagnostics_(diagnostics),
      symbols_(diagnostics) {
    unit_.file = mainFile;
}

Unit Parser::run() {
    while (!at(Token::Kind::End))
        guarded([&] { definition(); });
    return std::move(unit_);
}

bool Parser::accept(std::string_view symbol) {
    if (!isSymbol(symbol))
        return false;
    ++position_;
    return true;
}

bool Parser::acceptWord(std::string_view word) {
    if (!isWord(word))
        return false;
    ++position_;
    return true;
}

void Parser::fail(const std::string& expected) {
    std::string found = "the end of the file";
    if (at(Token::Kind::String))
        found = "a string";
    else if (!at(Token::Kind::End))
        found = "'" + std::string(token().text) + "'";
    error(token().at, "found " + found + "; expected " + expected);
    throw SyntaxError();
}

void Parser::expect(std::string_view symbol) {
    if (!accept(symbol))
        fail("'" + std::string(symbol) + "'");
}

void Parser::expectEnd(const std::string& what) {
    if (!accept("}"))
        fail(what);
}

std::string Parser::name(const std::string& what) {
    if (!at(Token::Kind::Identifier))
        fail(what);
    std::string_view text = token().text;
    if (!token().escaped && isKeyword(text))
        fail(what + " ('" + std::string(text) + "' is a keyword; write '\\" + std::string(text) +
             "')");
    NameRules rules = rules_;
    if (!isMain(token().at.file))
        // the rules for names apply to the main file only, not to included files
        rules = {true, true};
    checkName(text, rules, token().at, diagnostics_);
    ++position_;
    return std::string(text);
}

std::string Parser::scopedName(const std::string& what) {
    std::string written;
    if (accept("::"))
        written = "::";
    for (;;) {
        if (!at(Token::Kind::Identifier))
            fail(what);
        if (isKeyword(token().text) && !token().escaped)
            fail(what + " ('" + std::string(token().text) + "' is a keyword)");
        written += token().text;
        ++position_;
        if (!accept("::"))
            return written;
        written += "::";
    }
}

void Parser::recover() {
    int depth = 0;
    while (!at(Token::Kind::End)) {
        if (isSymbol("{"))
            ++depth;
        if (isSymbol("}") && depth-- == 0)
            return; // the brace ends the surrounding rule
        bool ends = (isSymbol(";") || isSymbol("}")) && depth <= 0;
        ++position_;
        if (ends) {
            accept(";");
            return;
        }
    }
}

std::string Parser::doc() {
    return std::string(token().doc);
}

// Reads metadata, and the doc comment before or after the metadata.
void Parser::readMetadata(std::string& text, Metadata& found) {
    text = doc();
    found = metadata();
    if (text.empty())
        text = doc();
}

// Returns whether this is the main file; the preprocessor may write its path differently from the
// command line.
bool Parser::isMain(std::string_view file) {
    auto [it, isNew] = isMain_.try_emplace(file, false);
    if (isNew) {
        std::error_code error;
        it->second = file == mainFile_ || std::filesystem::equivalent(file, mainFile_, error);
    }
    return it->second;
}

// Reads strings separated by commas, up to `end`.
void Parser::metadataStrings(Metadata& found, std::string_view end) {
    do {
        if (!at(Token::Kind::String))
            fail("a string of metadata");
        found.emplace_back(token().text);
        ++position_;
    } while (accept(","));
    expect(end);
}

Parser::Metadata Parser::metadata() {
    Metadata found;
    // Ice 3.8 allows several groups of metadata before one definition.
    while (accept("["))
        metadataStrings(found, "]");
    return found;
}

// Handles the metadata suppress-warning, suppress-warning:a and suppress-warning:a,b.
void Parser::suppressWarnings(const std::string& metadata, std::string_view file) {
    static const std::string directive = "suppress-warning";
    if (metadata == directive)
        return diagnostics_.suppress(file, Diagnostics::General);
    if (metadata.compare(0, directive.size() + 1, directive + ":") != 0)
        return;
    std::istringstream list(metadata.substr(directive.size() + 1));
    for (std::string item; std::getline(list >> std::ws, item, ',');) {
        item.erase(item.find_last_not_of(" \t") + 1);
        if (item == "all")
            diagnostics_.suppress(file, Diagnostics::General);
        else if (item == "deprecated")
            diagnostics_.suppress(file, Diagnostics::Deprecated);
        else if (item == "invalid-metadata")
            diagnostics_.suppress(file, Diagnostics::Metadata);
    }
}

void Parser::fileMetadata() {
    Location begin = token().at;
    ++position_;
    Metadata found;
    metadataStrings(found, "]]");
    if (begun_.count(begin.file))
        error(begin, "metadata of the file must come before its first definition");
    for (const std::string& m : found) {
        suppressWarnings(m, begin.file);
        if (!isMain(begin.file))
            continue;
        rules_.underscore |= m == "underscore";
        rules_.icePrefix |= m == "ice-prefix";
        unit_.metadata.push_back(m);
    }
}

void Parser::definition() {
    static const char* const expected = "a definition: module, enum, struct, sequence, dictionary, "
                                        "class, interface, exception or const";
    while (isSymbol("[["))
        fileMetadata();
    if (at(Token::Kind::End))
        return;
    readMetadata(doc_, metadata_);
    if (!at(Token::Kind::Identifier) || token().escaped)
        fail(expected);
    begun_.insert(token().at.file);
    local_ = acceptWord("local");
    static const std::map<std::string_view, void (Parser::*)()> rules = {
        {"module", &Parser::module},         {"enum", &Parser::enumeration},
        {"struct", &Parser::structure},      {"exception", &Parser::exception},
        {"class", &Parser::classDefinition}, {"sequence", &Parser::sequence},
        {"dictionary", &Parser::dictionary}, {"const", &Parser::constant},
        {"interface", &Parser::interface}};
    auto rule = rules.find(token().text);
    if (rule == rules.end() || token().escaped || !at(Token::Kind::Identifier))
        fail(expected);
    if (local_ && (rule->first == "module" || rule->first == "const"))
        error(token().at, "a " + std::string(rule->first) + " cannot be local");
    ++position_; // the keyword
    (this->*rule->second)();
}

void Parser::module() {
    Location begin = token().at;
    std::string called = name("the name of the module"), outer = scopeId_;
    bool isNew = false;
    Symbol* symbol = symbols_.declare(scopeId_, called, begin, isNew);
    if (symbol && symbol->declaration)
        error(begin, "'" + called + "' is declared as " + kindName(symbol->declaration->kind) +
                         " already, at line " + std::to_string(symbol->at.line));
    for (const std::string& around : scope_)
        if (lowerCase(around) == lowerCase(called))
            error(begin, "module '" + called + "' needs another name than the module around it, '" +
                             around + "'");
    if (scope_.size() == 1000)
        fail("modules are nested too deeply: expected at most 1000");
    expect("{");
    scope_.push_back(called);
    scopeId_ += "::" + called;
    while (!isSymbol("}") && !at(Token::Kind::End))
        guarded([&] { definition(); });
    scope_.pop_back();
    scopeId_ = outer;
    expectEnd("'}' at the end of module '" + called + "'");
    accept(";");
}

void Parser::checkGlobal(const std::string& name, const Location& at) {
    if (scope_.empty())
        error(at, "'" + name + "' must be in a module");
    for (const std::string& around : scope_)
        if (lowerCase(around) == lowerCase(name))
            error(at, "'" + name + "' needs another name than the module around it");
}

Declaration& Parser::add(Declaration::Kind kind, const std::string& name, const Location& at) {
    auto owned = std::make_unique<Declaration>();
    Declaration& d = *owned;
    d.kind = kind;
    d.name = name;
    d.doc = doc_;
    d.at = at;
    d.fromInclude = !isMain(at.file);
    d.isLocal = local_;
    d.scope = scope_;
    d.metadata = metadata_;
    unit_.declarations.push_back(std::move(owned));
    return d;
}

// Declares the type that the next token names. The declaration replaces a forward declaration of
// the same kind.
Declaration& Parser::declareType(Declaration::Kind kind, bool mayBeForward) {
    Location begin = token().at;
    std::string called = name("the " + std::string(kindName(kind)) + "'s name");
    checkGlobal(called, begin);
    Declaration& d = add(kind, called, begin);
    d.isForward = mayBeForward && isSymbol(";");
    bool isNew = false;
    Symbol* symbol = symbols_.declare(scopeId_, called, begin, isNew);
    if (!symbol)
        return d;
    if (isNew) {
        symbol->kind = Symbol::Kind::Declaration;
        symbol->declaration = &d;
        return d;
    }
    Declaration* earlier = symbol->declaration;
    if (!earlier) {
        error(begin,
              "'" + called + "' is already a module, at line " + std::to_string(symbol->at.line));
        return d;
    }
    if (earlier->kind != kind || !mayBeForward || (!earlier->isForward && !isSymbol(";"))) {
        bool isAgain = earlier->at.file == begin.file && earlier->at.line == begin.line &&
                       earlier->at.column == begin.column;
        error(begin, "'" + called + "' is already defined" +
                         (isAgain ? ": this file is included twice; begin it with #pragma once"
                                  : std::string(", as ") + kindName(earlier->kind) + " at line " +
                                        std::to_string(earlier->at.line)));
        return d;
    }
    if (earlier->isLocal != d.isLocal)
        error(begin, "'" + called + "' is " + (d.isLocal ? "" : "not ") +
                         "local here, unlike at line " + std::to_string(earlier->at.line));
    if (isSymbol(";")) { // a repeated forward declaration
        unit_.declarations.pop_back();
        return *earlier;
    }
    // Other declarations point to the object of the forward declaration, so this object becomes the
    // definition. It is moved to the end, so that definitions are in the order of the source.
    auto it = std::find_if(unit_.declarations.begin(), unit_.declarations.end(),
                           [&](const auto& p) { return p.get() == earlier; });
    *earlier = std::move(d);
    std::unique_ptr<Declaration> kept = std::move(*it);
    unit_.declarations.erase(it);
    unit_.declarations.back() = std::move(kept);
    return *unit_.declarations.back();
}
