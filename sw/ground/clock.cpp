// SPDX-License-Identifier: MIT
//
// clock: simulated time is read from memory that the simulator writes.

#include "clock.h"
#include "status.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr uint32_t shortestUs = 50; // of a look at simulated time

std::string fromEnvironment() {
    const char* file = std::getenv("XBEEAT_CLOCK");
    return file ? file : "";
}

int pollUs(pollfd* fds, nfds_t count, uint32_t us) {
    timespec limit{static_cast<time_t>(us / 1000000), static_cast<long>(us % 1000000 * 1000)};
    return ppoll(fds, count, us == Clock::forever ? nullptr : &limit, nullptr);
}

} // namespace

Clock::Clock() : Clock(fromEnvironment()) {}

Clock::Clock(const std::string& file) {
    if (file.empty())
        return;
    int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    void* at = fd < 0 ? MAP_FAILED : mmap(nullptr, sizeof(SimStatus), PROT_READ, MAP_SHARED, fd, 0);
    int error = errno;
    bool whole = fd >= 0 && lseek(fd, 0, SEEK_END) >= static_cast<off_t>(sizeof(SimStatus));
    if (fd >= 0)
        close(fd);
    if (at == MAP_FAILED)
        throw std::system_error(error, std::generic_category(),
                                "the clock of XBEEAT_CLOCK, '" + file + "'");
    simulation_ = static_cast<const SimStatus*>(at);
    if (!whole || std::memcmp(simulation_->magic, "ICESOC1", 8) != 0) {
        munmap(at, sizeof(SimStatus));
        throw std::system_error(EINVAL, std::generic_category(),
                                "the clock of XBEEAT_CLOCK, '" + file +
                                    "', is no simulator's counters");
    }
}

Clock::~Clock() {
    if (simulation_)
        munmap(const_cast<SimStatus*>(simulation_), sizeof(SimStatus));
}

uint32_t Clock::nowUs() const {
    using namespace std::chrono;
    if (simulation_)
        return static_cast<uint32_t>(__atomic_load_n(&simulation_->ns, __ATOMIC_RELAXED) / 1000);
    return static_cast<uint32_t>(
        duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count());
}

// Simulated time is not faster than the machine's, as a rule: so what is left is slept, and looked
// at again.
int Clock::wait(pollfd* fds, nfds_t count, uint32_t us) const {
    if (!simulation_ || us == forever)
        return pollUs(fds, count, us);
    for (uint32_t begin = nowUs();;) {
        uint32_t passed = std::min(nowUs() - begin, us);
        int ready = pollUs(fds, count, passed == us ? 0 : std::max(us - passed, shortestUs));
        if (ready != 0 || passed == us)
            return ready;
    }
}

} // namespace XBeeAT
