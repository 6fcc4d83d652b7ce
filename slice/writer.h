// SPDX-License-Identifier: MIT
//
// writer: indented text for generators: templates look like their output, {name} is filled in.

#ifndef WRITER_H
#define WRITER_H

#include <functional>
#include <map>
#include <string>

class Writer {
public:
    using Values = std::map<std::string, std::string>;

    explicit Writer(Values values = {}) : values_(std::move(values)) {}

    // `{name}` with a known name is replaced; any other brace is text.
    void line(const std::string& text = "", const Values& values = {}) {
        std::string filled = fill(text, values);
        out_ += filled.empty() ? "\n" : std::string(static_cast<size_t>(indent_) * 4, ' ') + filled + "\n";
    }
    void block(const std::string& head, const Values& values, const std::function<void()>& body,
               const std::string& tail = "}") {
        line(head + " {", values);
        ++indent_;
        body();
        --indent_;
        line(tail, values);
    }
    const std::string& text() const { return out_; }

private:
    std::string fill(const std::string& text, const Values& values) const {
        std::string result;
        for (size_t i = 0; i < text.size(); ++i) {
            size_t close = text[i] == '{' ? text.find('}', i) : std::string::npos;
            if (close != std::string::npos) {
                std::string name = text.substr(i + 1, close - i - 1);
                auto it = values.find(name);
                auto own = values_.find(name);
                if (it != values.end() || own != values_.end()) {
                    result += it != values.end() ? it->second : own->second;
                    i = close;
                    continue;
                }
            }
            result += text[i];
        }
        return result;
    }

    Values values_;
    int indent_ = 0;
    std::string out_;
};

#endif
