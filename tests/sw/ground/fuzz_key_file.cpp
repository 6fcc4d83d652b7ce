// SPDX-License-Identifier: MIT
//
// fuzz_key_file: libFuzzer target of the key file. It is read, or refused with a message in which
// there is no key.

#include "key_file.h"
#include <cstdint>
#include <cstdlib>
#include <regex>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const int fd = memfd_create("keys", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(fd);
    static const std::regex key("[0-9a-fA-F]{16}");
    if (fchmod(fd, 0600) != 0 || ftruncate(fd, 0) != 0 ||
        pwrite(fd, data, size, 0) != static_cast<ssize_t>(size))
        std::abort();
    try {
        const XBeeAT::KeyFile keys(path);
        for (int address : {0, 1, 0xFFFF})
            if (keys.of(address).empty() || keys.of(address).size() > 2)
                std::abort();
    } catch (const std::runtime_error& e) {
        const std::string message = e.what();
        if (message.find("key file '" + path + "'") != 0 || std::regex_search(message, key))
            std::abort();
    }
    return 0;
}
