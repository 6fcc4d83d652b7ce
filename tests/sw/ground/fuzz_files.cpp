// SPDX-License-Identifier: MIT
//
// fuzz_files: fuzzes the parser of key files with libFuzzer; with RIGHTS, the parser of the
// gateway's rights file. An input must be accepted, or rejected with a proper message that contains
// no key. No right may be granted that the file does not contain.

#ifdef RIGHTS
#include "rights.h"
#else
#include "key_file.h"
#endif
#include <cstdint>
#include <cstdlib>
#include <regex>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

void expect(bool condition) {
    if (!condition)
        std::abort();
}

#ifdef RIGHTS
const std::string refused = "rights file '", why = "': expected";
const std::regex never("json\\.");

void read(const std::string& path, const std::string& text) {
    const gateway::Rights rights(path);
    bool isWhole = true;
    for (const char* what : {"who", "identities", "operations"})
        isWhole = isWhole && text.find(what) != std::string::npos;
    expect(isWhole || text.find('\\') != std::string::npos ||
           !rights.permit("CN=pilot", "uav", "ice_ping"));
}
#else
const std::string refused = "key file '", why = "'";
const std::regex never("[0-9a-fA-F]{16}");

void read(const std::string& path, const std::string&) {
    const XBeeAT::KeyFile keys(path);
    for (int address : {0, 1, 0xFFFF})
        expect(!keys.of(address).empty() && keys.of(address).size() <= 2);
}
#endif

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const int fd = memfd_create("fuzzed", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(fd);
    expect(fchmod(fd, 0600) == 0 && ftruncate(fd, 0) == 0 &&
           pwrite(fd, data, size, 0) == static_cast<ssize_t>(size));
    try {
        read(path, std::string(data, data + size));
    } catch (const std::runtime_error& e) {
        const std::string message = e.what();
        expect(message.find(refused + path + why) == 0 && !std::regex_search(message, never));
    }
    return 0;
}
