// SPDX-License-Identifier: MIT
//
// clock: implements the clock of the machine, and loads another clock from a library.

#include "clock.h"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <dlfcn.h>
#include <system_error>

namespace XBeeAT {

namespace {

[[noreturn]] void refuse(int code, const std::string& why) {
    throw std::system_error(code, std::generic_category(), "XBEEAT_CLOCK: " + why);
}

} // namespace

uint32_t SystemClock::nowUs() const {
    using namespace std::chrono;
    return static_cast<uint32_t>(
        duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count());
}

int SystemClock::wait(pollfd* fds, nfds_t count, uint32_t us) {
    timespec limit{static_cast<time_t>(us / 1000000), static_cast<long>(us % 1000000 * 1000)};
    return ppoll(fds, count, us == forever ? nullptr : &limit, nullptr);
}

// Loads the clock from a library, which is never unloaded because it contains the code of the
// clock.
std::unique_ptr<Clock> makeClock() {
    const char* variable = std::getenv("XBEEAT_CLOCK");
    const std::string wanted = variable ? variable : "";
    if (wanted.empty())
        return std::make_unique<SystemClock>();
    const size_t colon = wanted.find(':');
    if (colon == std::string::npos)
        refuse(EINVAL, "expected LIBRARY:ARGUMENT, got '" + wanted + "'");
    void* library = dlopen(wanted.substr(0, colon).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library)
        refuse(ENOENT, dlerror());
    auto* create =
        reinterpret_cast<decltype(&createXBeeATClock)>(dlsym(library, "createXBeeATClock"));
    if (!create)
        refuse(EINVAL, dlerror());
    return std::unique_ptr<Clock>(create(wanted.c_str() + colon + 1));
}

} // namespace XBeeAT
