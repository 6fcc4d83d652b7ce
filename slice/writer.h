// SPDX-License-Identifier: MIT
//
// writer: indented text for generators: templates look like their output, {name} is filled in.

#ifndef WRITER_H
#define WRITER_H

#include <string>
#include <string_view>
#include <utility>
#include <vector>

class Writer {
public:
    using Values = std::vector<std::pair<std::string_view, std::string>>;

    // `{name}` with a known name is replaced; any other brace is text. A line of code that is
    // longer than 100 columns is broken behind a comma or an operator.
    void line(std::string_view text = {}, const Values& values = {});
    template <class Body>
    void block(std::string_view head, const Values& values, Body body,
               std::string_view tail = "}") {
        line(std::string(head) + " {", values);
        ++indent_;
        body();
        --indent_;
        line(tail, values);
    }
    // A line that belongs to the one before: if (...)
    void nested(std::string_view text, const Values& values = {}) {
        ++indent_;
        line(text, values);
        --indent_;
    }
    void nestedRaw(std::string_view text) {
        ++indent_;
        raw(text);
        --indent_;
    }
    void blank() { out_ += '\n'; }
    // Lines that another writer has made; they get this one's indentation.
    void raw(std::string_view text);
    const std::string& text() const { return out_; }

private:
    static std::string fill(std::string_view text, const Values& values);

    size_t indent_ = 0;
    std::string out_;
};

#endif
