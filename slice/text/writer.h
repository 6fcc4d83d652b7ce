// SPDX-License-Identifier: MIT
//
// writer: writes indented text for generators. Templates look like their output; a value
// replaces {name}.

#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct GeneratedFile {
    std::string name, text;
};

class Writer {
public:
    using Values = std::vector<std::pair<std::string_view, std::string>>;

    // Writes a line. Replaces `{name}` if the name is known; any other brace is plain text. Breaks
    // a line of code longer than 100 columns after a comma or an operator.
    void line(std::string_view text = {}, const Values& values = {});
    // Writes `body` with one more level of indentation.
    template <class Body> void indented(Body body) {
        ++indent_;
        body();
        --indent_;
    }
    template <class Body>
    void block(std::string_view head, const Values& values, Body body,
               std::string_view tail = "}") {
        line(std::string(head) + " {", values);
        indented(body);
        line(tail, values);
    }
    // Writes an empty line, then a block.
    template <class Body> void function(std::string_view head, const Values& values, Body body) {
        blank();
        block(head, values, body);
    }
    // Writes `typedef KIND NAME { ... } NAME;`.
    template <class Body> void type(const std::string& kind, const std::string& name, Body body) {
        block("typedef " + kind + " " + name, {}, body, "} " + name + ";");
    }
    // Writes the only statement of an `if` or a loop, indented.
    void nested(std::string_view text, const Values& values = {}) {
        indented([&] { line(text, values); });
    }
    // Writes an `if`, a loop or a case with its only statement.
    void single(std::string_view head, std::string_view statement, const Values& values = {}) {
        line(head, values);
        nested(statement, values);
    }
    void blank() { out_ += '\n'; }
    const std::string& text() const { return out_; }

private:
    static std::string fill(std::string_view text, const Values& values);

    size_t indent_ = 0;
    std::string out_;
};
