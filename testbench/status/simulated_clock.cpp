// SPDX-License-Identifier: MIT
//
// simulated_clock: reads the simulated time, which the simulator writes to shared memory.

#include "simulated_clock.h"
#include "keep_step.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <sys/mman.h>
#include <system_error>
#include <unistd.h>

namespace {

constexpr uint32_t shortestUs = 50; // shortest interval between two reads of simulated time, us
// longest interval between two reads while simulated time waits for this program, us
constexpr uint32_t longestUs = 500;
constexpr uint64_t endOfTime = ~uint64_t(0);

std::string whole(const std::string& path) {
    char* resolved = realpath(path.c_str(), nullptr);
    std::string result = resolved ? resolved : path;
    std::free(resolved);
    return result;
}

void store(uint64_t& field, uint64_t value) {
    __atomic_store_n(&field, value, __ATOMIC_RELEASE);
}

} // namespace

SimulatedClock::SimulatedClock(const std::string& file) {
    int fd = open(file.c_str(), O_RDWR | O_CLOEXEC);
    void* at = fd < 0 ? MAP_FAILED
                      : mmap(nullptr, sizeof(SimStatus), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    int error = errno;
    bool isWhole = fd >= 0 && lseek(fd, 0, SEEK_END) >= static_cast<off_t>(sizeof(SimStatus));
    if (fd >= 0)
        close(fd);
    if (at == MAP_FAILED)
        throw std::system_error(error, std::generic_category(),
                                "cannot map the simulator's counters '" + file + "'");
    simulation_ = static_cast<SimStatus*>(at);
    if (!isWhole || !isSimStatus(simulation_)) {
        munmap(at, sizeof(SimStatus));
        throw std::system_error(EINVAL, std::generic_category(),
                                "'" + file +
                                    "': expected a file of counters that a simulator writes");
    }
}

SimulatedClock::~SimulatedClock() {
    SimulatedClock::leaveStep();
    munmap(simulation_, sizeof(SimStatus));
}

uint64_t SimulatedClock::nowNs() const {
    return __atomic_load_n(&simulation_->ns, __ATOMIC_RELAXED);
}

uint32_t SimulatedClock::nowUs() const {
    return static_cast<uint32_t>(nowNs() / 1000);
}

// Waits for file descriptors, or until a simulated time. Simulated time rarely runs faster than
// real time. Therefore the program first sleeps in real time for as long as the remaining simulated
// time, and then reads simulated time again.
int SimulatedClock::wait(pollfd* fds, nfds_t count, uint32_t us) {
    const uint64_t begin = nowNs() / 1000;
    // A program that keeps step waits at least shortestUs. If it waited for 0 us, simulated time
    // would stop, and the program might wait for ever for this time to pass.
    const uint64_t end =
        us == forever ? endOfTime : begin + (inStep() ? std::max(us, shortestUs) : us);
    const bool reads = std::any_of(fds, fds + count, [this](const pollfd& p) {
        return p.fd == serial_ && (p.events & POLLIN);
    });
    for (;;) {
        const uint64_t now = nowNs() / 1000;
        const bool due = now >= end;
        uint32_t nap = us == forever ? forever
                       : due         ? 0
                                     : std::max(static_cast<uint32_t>(end - now), shortestUs);
        if (inStep()) {
            sleepUntil(us == forever ? endOfTime : end * 1000, reads);
            nap = us == forever ? forever : std::min(nap, longestUs);
        }
        int ready = machine_.wait(fds, count, nap);
        if (ready != 0 || due) {
            work();
            return ready;
        }
    }
}

// ---- keeping step ----

void SimulatedClock::keepStep(int serial, const std::string& device) {
    static std::atomic<uint32_t> steps{0};
    leaveStep();
    if (whole(device) != simulation_->device)
        return;
    serial_ = serial;
    taken_ = 0;
    token_ = static_cast<uint64_t>(++steps) << 32 | static_cast<uint32_t>(getpid());
    store(simulation_->untilNs, 0);
    store(simulation_->fromGround, 0);
    store(simulation_->taken, 0);
    store(simulation_->toGround, simSession(token_));
    store(simulation_->keeper, token_);
}

// Clears SimStatus::keeper only if it names this program, because another program on the same port
// may keep step now.
void SimulatedClock::leaveStep() {
    uint64_t mine = token_;
    if (mine)
        __atomic_compare_exchange_n(&simulation_->keeper, &mine, uint64_t(0), false,
                                    __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);
    token_ = 0;
    serial_ = -1;
}

bool SimulatedClock::inStep() const {
    return token_ && __atomic_load_n(&simulation_->keeper, __ATOMIC_ACQUIRE) == token_;
}

void SimulatedClock::sleepUntil(uint64_t ns, bool reads) {
    store(simulation_->taken, reads ? taken_ : endOfTime);
    store(simulation_->untilNs, ns);
}

void SimulatedClock::work() {
    if (inStep())
        store(simulation_->untilNs, 0);
}

void SimulatedClock::hasRead(size_t bytes) {
    taken_ += bytes;
}

void SimulatedClock::hasWritten(size_t bytes) {
    if (inStep())
        __atomic_add_fetch(&simulation_->fromGround, bytes, __ATOMIC_RELEASE);
}

size_t SimulatedClock::waiting() const {
    if (!inStep())
        return 0;
    const uint64_t carried = __atomic_load_n(&simulation_->carried, __ATOMIC_ACQUIRE);
    const uint64_t written = simulation_->fromGround;
    return carried < written ? written - carried : 0;
}

// ---- the library named by XBEEAT_CLOCK ----

extern "C" XBeeAT::Clock* createXBeeATClock(const char* argument) {
    return new SimulatedClock(argument);
}
