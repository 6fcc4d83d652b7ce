// SPDX-License-Identifier: MIT
//
// fuzz_rights: libFuzzer target of the gateway's file of rights. It is read, or refused in our
// words, and gives no right that it does not name.

#include "rights.h"
#include <cstdlib>
#include <sys/mman.h>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const int fd = memfd_create("rights", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(fd);
    if (ftruncate(fd, 0) != 0 || pwrite(fd, data, size, 0) != static_cast<ssize_t>(size))
        std::abort();
    const std::string text(data, data + size);
    const auto names = [&](const char* what) { return text.find(what) != std::string::npos; };
    try {
        const gateway::Rights rights(path);
        const bool isWhole = names("who") && names("identities") && names("operations");
        if (!isWhole && !names("\\") && rights.permit("CN=pilot", "uav", "ice_ping"))
            std::abort();
    } catch (const std::runtime_error& e) {
        const std::string message = e.what();
        if (message.find("the file of rights '" + path + "' must") != 0 ||
            message.find("json.") != std::string::npos)
            std::abort();
    }
    return 0;
}
