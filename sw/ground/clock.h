// SPDX-License-Identifier: MIT
//
// clock: the time that an engine lives by: the machine's, or that of a simulated modem, so that a
// slow machine makes a mission slow and no time-out early. A simulator names its file of counters
// (testbench/sim/status.h) to the programs it starts in the environment variable XBEEAT_CLOCK.

#ifndef GROUND_CLOCK_H
#define GROUND_CLOCK_H

#include <cstdint>
#include <poll.h>
#include <string>

struct SimStatus;

namespace XBeeAT {

class Clock {
public:
    // As the environment says.
    Clock();
    // By this file; empty: by the machine. Throws std::system_error.
    explicit Clock(const std::string& file);
    ~Clock();
    Clock(const Clock&) = delete;
    Clock& operator=(const Clock&) = delete;

    static constexpr uint32_t forever = 0xFFFFFFFFu;
    uint32_t nowUs() const; // wraps around
    // As poll, until something is ready or `us` have passed by this clock.
    int wait(pollfd* fds, nfds_t count, uint32_t us) const;

private:
    const SimStatus* simulation_ = nullptr;
};

} // namespace XBeeAT

#endif
