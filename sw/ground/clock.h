// SPDX-License-Identifier: MIT
//
// clock: an engine's time: the machine's, or a simulated modem's, so that a slow machine makes a
// mission slow and no time-out early. A simulator gives the programs that it starts the name of its
// counters' file (sim_status.h) in the environment variable XBEEAT_CLOCK.

#pragma once

#include <cstddef>
#include <cstdint>
#include <poll.h>
#include <string>

struct SimStatus;

namespace XBeeAT {

class Clock {
public:
    // Uses the file that XBEEAT_CLOCK names, or else the machine's clock.
    Clock();
    // Uses this file; an empty name is the machine's clock. Throws std::system_error.
    explicit Clock(const std::string& file);
    ~Clock();
    Clock(const Clock&) = delete;
    Clock& operator=(const Clock&) = delete;

    static constexpr uint32_t forever = 0xFFFFFFFFu;
    uint32_t nowUs() const; // wraps around
    // Works as poll does: returns when a descriptor is ready or `us` have passed by this clock.
    int wait(pollfd* fds, nfds_t count, uint32_t us);

    // From now on simulated time waits for this thread: it stands still except during `wait`, and
    // until all that `serial` was given has been read. Has no effect with the machine's clock, or
    // where the simulator's modem is not on `device`.
    void keepStep(int serial, const std::string& device);
    void leaveStep();
    // Count the bytes read from and written to `serial`.
    void hasRead(size_t bytes);
    void hasWritten(size_t bytes);
    // Returns the bytes written that a simulated line has yet to carry.
    size_t waiting() const;

private:
    uint64_t nowNs() const;
    bool inStep() const;
    void sleepUntil(uint64_t ns, bool reads);
    void work();

    SimStatus* simulation_ = nullptr;
    uint64_t token_ = 0; // as SimStatus::keeper; 0: does not keep step
    uint64_t taken_ = 0;
    int serial_ = -1;
};

} // namespace XBeeAT
