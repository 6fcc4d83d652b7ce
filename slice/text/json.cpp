// SPDX-License-Identifier: MIT
//
// json: writes JSON.

#include "text/json.h"
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

// Returns the length of the character in UTF-8 at `at`, 1 to 4; 0 if the bytes are not UTF-8.
size_t characterLength(const std::string& text, size_t at) {
    auto byte = [&](size_t i) { return at + i < text.size() ? text[at + i] & 0xFFu : 0u; };
    unsigned first = byte(0), second = byte(1);
    size_t length = first < 0x80 ? 1 : first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    // overlong encodings, surrogates, and numbers above U+10FFFF
    if (first > 0xF4 || (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
        (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F))
        return 0;
    for (size_t i = 1; i < length; ++i)
        if (byte(i) >> 6 != 2)
            return 0;
    return length;
}

std::string quoted(const std::string& text) {
    static const std::string special = "\"\\\b\f\n\r\t", letters = "\"\\bfnrt";
    std::string out = "\"";
    for (size_t at = 0, length; at < text.size(); at += length ? length : 1) {
        length = characterLength(text, at);
        size_t found = special.find(text[at]);
        char code[8];
        std::snprintf(code, sizeof code, "\\u%04x", text[at] & 0xFFu);
        if (found != std::string::npos)
            out += std::string("\\") + letters[found];
        else if (length == 0)
            out += "\uFFFD";
        else
            out += length == 1 && text[at] >= 0 && text[at] < ' ' ? code : text.substr(at, length);
    }
    return out + "\"";
}

// Returns the shortest text that reads as the same number. JSON has no infinity.
std::string decimal(double number) {
    char text[32] = "null";
    for (int digits = 15; std::isfinite(number) && digits <= 17; ++digits) {
        std::snprintf(text, sizeof text, "%.*g", digits, number);
        if (std::strtod(text, nullptr) == number)
            break;
    }
    std::string made = text;
    return made.find_first_of(".en") == std::string::npos ? made + ".0" : made;
}

} // namespace

Json::Json(const std::string& text) : text_(quoted(text)) {}

Json::Json(double number) : text_(decimal(number)) {}

Json::Json(const std::vector<std::string>& texts) : Json(Kind::Array) {
    for (const std::string& text : texts)
        add(text);
}

Json Json::array(const std::vector<Json>& elements) {
    Json made(Kind::Array);
    for (const Json& element : elements)
        made.add(element);
    return made;
}

Json Json::object(std::vector<Member> members) {
    Json made(Kind::Object);
    made.members_ = std::move(members);
    return made;
}

void Json::add(const Json& element) {
    members_.push_back({"", element});
}

void Json::set(const std::string& name, const Json& value) {
    for (Member& m : members_)
        if (m.name == name) {
            m.value = value;
            return;
        }
    members_.push_back({name, value});
}

void Json::set(const std::vector<Member>& members) {
    for (const Member& m : members)
        set(m.name, m.value);
}

std::string Json::print(size_t level) const {
    if (kind_ == Kind::Scalar)
        return text_;
    bool isObject = kind_ == Kind::Object;
    std::string out = isObject ? "{" : "[", end = isObject ? "}" : "]";
    if (members_.empty())
        return out + end;
    for (const Member& m : members_) {
        out += (&m == &members_.front() ? "\n" : ",\n") + std::string(level + 1, ' ');
        if (isObject)
            out += quoted(m.name) + ": ";
        out += m.value.print(level + 1);
    }
    return out + "\n" + std::string(level, ' ') + end;
}
