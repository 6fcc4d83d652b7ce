// SPDX-License-Identifier: MIT
//
// json: writes JSON. A library for JSON took half of slice2c's compile time.

#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

// A value: text, a number, a boolean, an array, or an object whose members keep their order.
class Json {
public:
    struct Member;

    Json(const std::string& text);
    Json(const char* text) : Json(std::string(text)) {}
    Json(double number);
    template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
    Json(Integer number) : text_(integer(number)) {}
    Json(bool value) : text_(value ? "true" : "false") {}
    Json(const std::vector<std::string>& texts);
    static Json array(const std::vector<Json>& elements = {});
    static Json object(std::vector<Member> members = {});

    // Adds an element to an array.
    void add(const Json& element);
    // Adds a member to an object, or replaces the member of the same name.
    void set(const std::string& name, const Json& value);
    void set(const std::vector<Member>& members);

    // Returns the value as text, each element and member on its own line, indented by one column
    // per level. Bytes that are not UTF-8 are replaced by U+FFFD.
    std::string print(size_t level = 0) const;

private:
    enum class Kind { Scalar, Array, Object };

    explicit Json(Kind kind) : kind_(kind) {}
    static std::string integer(int64_t number) { return std::to_string(number); }

    Kind kind_ = Kind::Scalar;
    std::string text_;            // Scalar
    std::vector<Member> members_; // Array (without names) or Object
};

struct Json::Member {
    std::string name;
    Json value;
};
