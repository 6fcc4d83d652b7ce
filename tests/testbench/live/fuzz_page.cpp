// SPDX-License-Identifier: MIT
//
// fuzz_page: libFuzzer target of the page's requests. Nothing may crash; only our own names of this
// address see what is there; each answer has the length that it says.
//
// An input is a request's head. Every second one gets a right Host, so that the rest is reached.

#include "page_server.h"
#include <cstdint>
#include <cstdlib>

namespace {

constexpr int port = 80;
const std::string secret = "what only our page may see";

void expect(bool condition) {
    if (!condition)
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const Pages pages = [] {
        Pages made;
        made.add("/", "text/html", [] { return secret; });
        made.add("/none", "text/html", [] { return std::string(); });
        return made;
    }();
    std::string head(data, data + size);
    if (size % 2)
        head += "\r\nHost: 127.0.0.1:80";
    const std::string answer = pages.answer(head, port), length = "Content-Length: ";
    const size_t at = answer.find(length), body = answer.find("\r\n\r\n") + 4;
    expect(answer.rfind("HTTP/1.1 ", 0) == 0 && at < body);
    expect(std::stoul(answer.substr(at + length.size())) == answer.size() - body);
    expect(answer.find(secret) == std::string::npos || head.find(":80") != std::string::npos);
    return 0;
}
