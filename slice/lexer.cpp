// SPDX-License-Identifier: MIT
//
// lexer: one pass over the text.

#include "lexer.h"
#include <cctype>
#include <cstdlib>

namespace {

class Lexer {
public:
    Lexer(const std::string& text, const std::string& file, Diagnostics& diagnostics)
        : text_(text), diagnostics_(diagnostics) {
        at_.file = file;
        at_.line = at_.column = 1;
    }

    std::vector<Token> run() {
        while (position_ < text_.size())
            next();
        add(Token::Kind::End, "", at_);
        return std::move(tokens_);
    }

private:
    char peek(size_t ahead = 0) const {
        return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
    }
    void advance() {
        if (text_[position_++] == '\n') {
            ++at_.line;
            at_.column = 1;
        } else {
            ++at_.column;
        }
    }
    void add(Token::Kind kind, std::string text, const Location& at) {
        tokens_.push_back({kind, std::move(text), std::move(doc_), at, false});
        doc_.clear();
    }

    // # 12 "file" or #line 12 "file", as the preprocessor leaves them.
    void lineMarker() {
        std::string line;
        while (position_ < text_.size() && peek() != '\n') {
            line += peek();
            advance();
        }
        if (position_ < text_.size())
            advance();
        size_t digits = line.find_first_of("0123456789");
        if (digits == std::string::npos)
            return;
        at_.line = std::atoi(line.c_str() + digits);
        size_t open = line.find('"'), close = line.rfind('"');
        if (open != std::string::npos && close > open)
            at_.file = line.substr(open + 1, close - open - 1);
    }

    void comment() {
        Location begin = at_;
        bool isDoc = peek(1) == '*' && peek(2) == '*' && peek(3) != '/';
        std::string body;
        advance();
        advance();
        while (position_ < text_.size() && !(peek() == '*' && peek(1) == '/')) {
            body += peek();
            advance();
        }
        if (position_ >= text_.size()) {
            diagnostics_.error(begin, "comment without an end; expected '*/'");
            return;
        }
        advance();
        advance();
        if (isDoc)
            doc_ = body.substr(1);
    }

    void string() {
        Location begin = at_;
        std::string value;
        advance();
        while (peek() != '"') {
            if (peek() == '\n' || position_ >= text_.size()) {
                diagnostics_.error(begin, "string without an end; expected '\"'");
                return;
            }
            if (peek() == '\\') {
                value += peek();
                advance();
            }
            value += peek();
            advance();
        }
        advance();
        add(Token::Kind::String, value, begin);
    }

    void word() {
        Location begin = at_;
        bool escaped = peek() == '\\';
        if (escaped)
            advance();
        std::string value;
        while (std::isalnum(static_cast<unsigned char>(peek())) || peek() == '_') {
            value += peek();
            advance();
        }
        add(Token::Kind::Identifier, value, begin);
        tokens_.back().escaped = escaped;
    }

    void number() {
        Location begin = at_;
        std::string value;
        bool isFloat = false;
        while (std::isalnum(static_cast<unsigned char>(peek())) || peek() == '.' ||
               ((peek() == '-' || peek() == '+') &&
                (value.empty() || value.back() == 'e' || value.back() == 'E'))) {
            isFloat = isFloat || peek() == '.';
            value += peek();
            advance();
        }
        add(isFloat ? Token::Kind::Float : Token::Kind::Integer, value, begin);
    }

    void next() {
        char c = peek();
        if (c == '#' && at_.column == 1)
            return lineMarker();
        if (std::isspace(static_cast<unsigned char>(c)))
            return advance();
        if (c == '/' && peek(1) == '*')
            return comment();
        if (c == '/' && peek(1) == '/') {
            std::string body;
            while (position_ < text_.size() && peek() != '\n') {
                body += peek();
                advance();
            }
            if (body.size() > 2 && body[2] == '/')
                doc_ = body.substr(3);
            return;
        }
        if (c == '"')
            return string();
        if (std::isalpha(static_cast<unsigned char>(c)) || c == '_' || c == '\\')
            return word();
        if (std::isdigit(static_cast<unsigned char>(c)) ||
            (c == '-' && std::isdigit(static_cast<unsigned char>(peek(1)))))
            return number();
        Location begin = at_;
        std::string symbol(1, c);
        advance();
        if ((c == ':' && peek() == ':') || (c == '[' && peek() == '[') || (c == ']' && peek() == ']')) {
            symbol += peek();
            advance();
        }
        if (symbol.size() == 1 && std::string("{}()[];:,*=<>").find(c) == std::string::npos)
            diagnostics_.error(begin, "character '" + symbol + "' has no meaning in Slice");
        else
            add(Token::Kind::Symbol, symbol, begin);
    }

    const std::string& text_;
    Diagnostics& diagnostics_;
    size_t position_ = 0;
    Location at_;
    std::string doc_;
    std::vector<Token> tokens_;
};

} // namespace

std::vector<Token> tokenize(const std::string& text, const std::string& file,
                            Diagnostics& diagnostics) {
    return Lexer(text, file, diagnostics).run();
}
