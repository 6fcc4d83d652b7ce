// SPDX-License-Identifier: MIT
//
// literals: converts the text of number and string literals to values. Numbers are read by
// functions of the C library.

#include "front/parser.h"
#include <cerrno>
#include <cmath>
#include <cstdlib>

namespace {

bool isHex(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

void appendUtf8(std::string& s, uint32_t c) {
    auto byte = [&](uint32_t b) { s += static_cast<char>(b); };
    if (c < 0x80) {
        byte(c);
    } else if (c < 0x800) {
        byte(0xC0 | c >> 6);
        byte(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
        byte(0xE0 | c >> 12);
        byte(0x80 | (c >> 6 & 0x3F));
        byte(0x80 | (c & 0x3F));
    } else {
        byte(0xF0 | c >> 18);
        byte(0x80 | (c >> 12 & 0x3F));
        byte(0x80 | (c >> 6 & 0x3F));
        byte(0x80 | (c & 0x3F));
    }
}

class StringReader {
public:
    StringReader(const Token& token, Diagnostics& diagnostics)
        : text_(token.text), at_(token.at), diagnostics_(diagnostics) {}

    std::string run() {
        while (position_ < text_.size()) {
            char c = text_[position_++];
            if (c == '\\' && position_ < text_.size())
                escape(text_[position_++]);
            else if (static_cast<unsigned char>(c) < 32 || c == 127)
                error("a string may only contain printable characters; write an escape sequence");
            else
                value_ += c;
        }
        return std::move(value_);
    }

private:
    void error(const std::string& text) {
        Location at = at_;
        at.column += static_cast<int>(position_);
        diagnostics_.error(at, text);
    }
    // Reads up to `most` decimal or hexadecimal digits; sets `count` to their number.
    uint32_t digits(size_t most, bool hex, size_t& count) {
        uint32_t v = 0;
        for (count = 0; count < most && position_ < text_.size(); ++count, ++position_) {
            char c = text_[position_];
            if (hex ? !isHex(c) : c < '0' || c > '7')
                break;
            v = v * (hex ? 16 : 8) +
                static_cast<uint32_t>(c <= '9' ? c - '0' : (c | 32) - 'a' + 10);
        }
        return v;
    }
    void escape(char c) {
        static const std::string simple = "abfnrtv", replaced = "\a\b\f\n\r\t\v";
        size_t found = simple.find(c), count = 0;
        if (found != std::string::npos) {
            value_ += replaced[found];
        } else if (c == '\\' || c == '"' || c == '\'' || c == '?') {
            value_ += c;
        } else if (c >= '0' && c <= '7') {
            --position_;
            uint32_t v = digits(3, false, count);
            if (v > 255)
                error("octal escape sequence is above 377");
            value_ += static_cast<char>(v);
        } else if (c == 'x') {
            value_ += static_cast<char>(digits(2, true, count));
            if (count == 0)
                error("no digit in a hexadecimal escape sequence");
        } else if (c == 'u' || c == 'U') {
            size_t wanted = c == 'u' ? 4 : 8;
            uint32_t v = digits(wanted, true, count);
            if (count < wanted)
                error("a universal character name has " + std::to_string(wanted) +
                      " hexadecimal digits");
            else if ((v >= 0xD800 && v <= 0xDFFF) || v > 0x10FFFF)
                error("no character has this code");
            else
                appendUtf8(value_, v);
        } else {
            diagnostics_.warning(at_, "unknown escape sequence '\\" + std::string(1, c) + "'");
            value_ += {'\\', c};
        }
    }

    std::string_view text_;
    Location at_;
    Diagnostics& diagnostics_;
    size_t position_ = 0;
    std::string value_;
};

} // namespace

int64_t integerValue(const Token& token, Diagnostics& diagnostics) {
    std::string text(token.text);
    char* end = nullptr;
    errno = 0;
    int64_t v = std::strtoll(text.c_str(), &end, 0);
    if (end == text.c_str() || *end) {
        diagnostics.error(token.at, "'" + text + "' is not an integer");
        return 0;
    }
    if (errno == ERANGE) {
        diagnostics.error(token.at, "integer '" + text + "' is out of range");
        return 0;
    }
    return v;
}

double floatingValue(const Token& token, Diagnostics& diagnostics) {
    std::string text(token.text);
    if (!text.empty() && (text.back() == 'f' || text.back() == 'F') &&
        text.find_first_of("xX") == std::string::npos)
        text.pop_back();
    char* end = nullptr;
    errno = 0;
    double v = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || *end) {
        diagnostics.error(token.at, "'" + std::string(token.text) + "' is not a number");
        return 0;
    }
    if (errno == ERANGE && (v == 0 || std::fabs(v) > 1)) { // a denormal number is valid
        diagnostics.error(token.at, "number '" + text +
                                        (std::fabs(v) > 1 ? "' is too large" : "' is too small"));
        return 0;
    }
    return v;
}

std::string stringValue(const Token& token, Diagnostics& diagnostics) {
    return StringReader(token, diagnostics).run();
}
