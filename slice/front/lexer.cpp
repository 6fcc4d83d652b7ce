// SPDX-License-Identifier: MIT
//
// lexer: splits the text into tokens in one pass.

#include "front/parser.h"
#include <algorithm>
#include <cstdlib>
#include <string>

namespace {

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}
bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool isSpace(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

class Lexer {
public:
    Lexer(std::string_view text, std::string_view file, Diagnostics& diagnostics)
        : text_(text), diagnostics_(diagnostics) {
        at_.file = diagnostics.intern(file);
        at_.line = at_.column = 1;
        tokens_.reserve(text.size() / 12);
    }

    std::vector<Token> run() {
        while (position_ < text_.size())
            next();
        add(Token::Kind::End, text_.size(), at_);
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
    void skipTo(size_t position) {
        while (position_ < position)
            advance();
    }
    // Adds a token that extends from `begin` to the current position.
    void add(Token::Kind kind, size_t begin, const Location& at, bool escaped = false) {
        tokens_.push_back(
            {kind, text_.substr(begin, position_ - begin), doc_, linesAbove(at.line), at, escaped});
        doc_ = {};
        comments_.clear();
    }
    // Returns the block of // comments that ends on the line before `line`.
    std::string linesAbove(int line) const {
        auto end = comments_.end();
        // skips comments in `line` and in later lines
        while (end != comments_.begin() && (end - 1)->first >= line)
            --end;
        auto begin = end;
        while (begin != comments_.begin() && (begin - 1)->first == line - 1) {
            --begin;
            --line;
        }
        std::string lines;
        for (; begin != end; ++begin)
            lines.append(begin->second) += '\n';
        return lines;
    }

    // Handles a marker of the preprocessor (# 12 "file" or #line 12 "file") or a #pragma for a
    // compiler.
    void lineMarker() {
        size_t end = text_.find('\n', position_);
        std::string_view line = text_.substr(position_, end - position_);
        if (line.compare(0, 7, "#pragma") == 0)
            diagnostics_.error(at_, "Slice has no pragma but '#pragma once'");
        position_ = end == std::string_view::npos ? text_.size() : end + 1;
        at_.column = 1;
        ++at_.line;
        moved_ = 0;
        size_t digits = line.find_first_of("0123456789");
        if (digits == std::string_view::npos)
            return;
        at_.line = std::atoi(std::string(line.substr(digits, 9)).c_str());
        size_t open = line.find('"'), close = line.rfind('"');
        if (open != std::string_view::npos && close > open)
            at_.file = diagnostics_.intern(line.substr(open + 1, close - open - 1));
    }

    void comment() {
        Location begin = at_;
        size_t end = text_.find("*/", position_ + 2);
        if (end == std::string_view::npos) {
            diagnostics_.error(begin, "comment without an end; expected '*/'");
            skipTo(text_.size());
            return;
        }
        if (end > position_ + 2 && peek(2) == '*')
            doc_ = text_.substr(position_ + 3, end - position_ - 3);
        skipTo(end + 2);
        ++moved_;
    }

    void lineComment() {
        size_t end = std::min(text_.find('\n', position_), text_.size());
        if (peek(2) == '/') { // // comments on consecutive lines form one comment
            size_t begin =
                doc_.empty() ? position_ + 3 : static_cast<size_t>(doc_.data() - text_.data());
            doc_ = text_.substr(begin, end - begin);
        } else {
            comments_.emplace_back(at_.line - moved_,
                                   text_.substr(position_ + 2, end - position_ - 2));
        }
        ++moved_;
        skipTo(end);
    }

    void string() {
        Location at = at_;
        advance();
        size_t begin = position_;
        while (peek() != '"') {
            if (peek() == '\n' || position_ >= text_.size()) {
                diagnostics_.error(at, "string without an end; expected '\"'");
                return add(Token::Kind::String, begin, at);
            }
            if (peek() == '\\' && peek(1) != '\n' && position_ + 1 < text_.size())
                advance();
            advance();
        }
        add(Token::Kind::String, begin, at);
        advance();
    }

    void word() {
        Location at = at_;
        bool escaped = peek() == '\\';
        if (escaped)
            advance();
        size_t begin = position_;
        while (isLetter(peek()) || isDigit(peek()))
            advance();
        if (begin == position_)
            diagnostics_.error(at, "'\\' without an identifier after it");
        else
            add(Token::Kind::Identifier, begin, at, escaped);
    }

    void number() {
        Location at = at_;
        size_t begin = position_;
        bool isFloat = false, isHex = false;
        if (peek() == '+' || peek() == '-')
            advance();
        isHex = peek() == '0' && (peek(1) == 'x' || peek(1) == 'X');
        while (isLetter(peek()) || isDigit(peek()) || peek() == '.') {
            bool exponent = !isHex && (peek() == 'e' || peek() == 'E');
            isFloat = isFloat || peek() == '.' || exponent;
            advance();
            if (exponent && (peek() == '+' || peek() == '-'))
                advance();
        }
        add(isFloat ? Token::Kind::Float : Token::Kind::Integer, begin, at);
    }

    bool isNumber() const {
        char c = peek();
        size_t sign = c == '+' || c == '-';
        return isDigit(peek(sign)) || (peek(sign) == '.' && isDigit(peek(sign + 1)));
    }

    void next() {
        char c = peek();
        if (c == '#' && at_.column == 1)
            return lineMarker();
        if (isSpace(c))
            return advance();
        if (c == '/' && peek(1) == '*')
            return comment();
        if (c == '/' && peek(1) == '/')
            return lineComment();
        if (c == '"')
            return string();
        if (isLetter(c) || c == '\\')
            return word();
        if (isNumber())
            return number();
        bool isFirst = at_.line == 1 && at_.column == 1;
        if (isFirst && text_.compare(position_, 3, "\xEF\xBB\xBF") == 0) { // byte order mark
            position_ += 3;
            return;
        }
        Location at = at_;
        size_t begin = position_;
        advance();
        if ((c == ':' || c == '[' || c == ']') && peek() == c)
            advance();
        if (position_ == begin + 1 &&
            std::string_view("{}()[];:,*=<>").find(c) == std::string_view::npos) {
            auto u = static_cast<unsigned char>(c);
            if (u >= 0xC0) // the message shows a whole UTF-8 character
                while ((static_cast<unsigned char>(peek()) & 0xC0) == 0x80)
                    ++position_;
            std::string shown = u > 32 && u != 127
                                    ? std::string(text_.substr(begin, position_ - begin))
                                    : "code " + std::to_string(u);
            diagnostics_.error(at, "character '" + shown + "' has no meaning in Slice");
        } else {
            add(Token::Kind::Symbol, begin, at);
        }
    }

    std::string_view text_;
    Diagnostics& diagnostics_;
    size_t position_ = 0;
    Location at_;
    std::string_view doc_;
    // text of each // comment, with its line
    std::vector<std::pair<int, std::string_view>> comments_;
    // number of lines that the preprocessor has added so far (one after each comment)
    int moved_ = 0;
    std::vector<Token> tokens_;
};

} // namespace

std::vector<Token> tokenize(std::string_view text, std::string_view file,
                            Diagnostics& diagnostics) {
    return Lexer(text, file, diagnostics).run();
}
