// SPDX-License-Identifier: MIT
//
// clock: the time base of an engine, normally the clock of the machine. A simulator provides
// another clock: if the machine is too slow, the mission runs slower, but no time-out expires too
// early.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <poll.h>
#include <string>

namespace XBeeAT {

class Clock {
public:
    virtual ~Clock() = default;

    static constexpr uint32_t forever = 0xFFFFFFFFu;
    virtual uint32_t nowUs() const = 0; // wraps around
    // Works like the system call poll: returns when a descriptor is ready, or when this clock has
    // advanced by `us` microseconds.
    virtual int wait(pollfd* fds, nfds_t count, uint32_t us) = 0;

    // The following functions synchronise a simulated clock with this program. The clock of the
    // machine ignores them.
    //
    // keepStep makes simulated time wait for this thread until leaveStep. Time then only passes
    // during `wait`, and only after all bytes that the simulator has sent to `serial` were read.
    // keepStep has no effect if `device` is not connected to the simulator's modem.
    virtual void keepStep(int serial, const std::string& device) { (void)serial, (void)device; }
    virtual void leaveStep() {}
    // Report how many bytes were read from `serial`, or written to it.
    virtual void hasRead(size_t bytes) { (void)bytes; }
    virtual void hasWritten(size_t bytes) { (void)bytes; }
    // Returns the number of written bytes that the simulator has not transmitted yet.
    virtual size_t waiting() const { return 0; }
};

class SystemClock : public Clock {
public:
    uint32_t nowUs() const override;
    int wait(pollfd* fds, nfds_t count, uint32_t us) override;
};

// Returns the clock that the environment variable XBEEAT_CLOCK names, or the clock of the machine
// if the variable is not set. The variable has the form LIBRARY:ARGUMENT. LIBRARY is a shared
// library with a function createXBeeATClock; ARGUMENT is passed to this function. Throws
// std::system_error.
std::unique_ptr<Clock> makeClock();

} // namespace XBeeAT

// Creates a clock, which the caller owns. The library named in XBEEAT_CLOCK defines this function.
// May throw std::system_error.
extern "C" XBeeAT::Clock* createXBeeATClock(const char* argument);
