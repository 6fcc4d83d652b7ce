// SPDX-License-Identifier: MIT
//
// writer: indented text for generators: templates look like their output, {name} is filled in.

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

    // Replaces `{name}` for a known name; any other brace is text. A line of code longer than 100
    // columns is broken after a comma or an operator.
    void line(std::string_view text = {}, const Values& values = {});
    // Writes `body` one step to the right.
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
    // Writes a block after an empty line.
    template <class Body> void function(std::string_view head, const Values& values, Body body) {
        blank();
        block(head, values, body);
    }
    // Writes `typedef KIND NAME { ... } NAME;`.
    template <class Body> void type(const std::string& kind, const std::string& name, Body body) {
        block("typedef " + kind + " " + name, {}, body, "} " + name + ";");
    }
    // The one statement of an `if` or a loop.
    void nested(std::string_view text, const Values& values = {}) {
        indented([&] { line(text, values); });
    }
    // An `if`, a loop or a case with its one statement.
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
