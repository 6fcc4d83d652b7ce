// SPDX-License-Identifier: MIT
//
// clock: the time base of an engine, normally the clock of the machine. A simulator provides
// another clock: on a slow machine the mission then runs slower, but no time-out expires early.

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
    // Works like poll: returns when a descriptor is ready or `us` have passed by this clock.
    virtual int wait(pollfd* fds, nfds_t count, uint32_t us) = 0;

    // The next four functions keep a simulated clock in step with this program; the machine clock
    // ignores them.
    //
    // keepStep makes simulated time wait for this thread until leaveStep: time stops except during
    // `wait`, and until all bytes given to `serial` have been read. Has no effect if the
    // simulator's modem is not on `device`.
    virtual void keepStep(int serial, const std::string& device) { (void)serial, (void)device; }
    virtual void leaveStep() {}
    // Report the number of bytes that were read from or written to `serial`.
    virtual void hasRead(size_t bytes) { (void)bytes; }
    virtual void hasWritten(size_t bytes) { (void)bytes; }
    // Returns the number of written bytes that the simulated line has not carried yet.
    virtual size_t waiting() const { return 0; }
};

class SystemClock : public Clock {
public:
    uint32_t nowUs() const override;
    int wait(pollfd* fds, nfds_t count, uint32_t us) override;
};

// Returns the clock named by the environment variable XBEEAT_CLOCK, or the machine clock if the
// variable is not set. Its value is LIBRARY:ARGUMENT. LIBRARY is a shared library with a function
// createXBeeATClock, which gets ARGUMENT. Throws std::system_error.
std::unique_ptr<Clock> makeClock();

} // namespace XBeeAT

// The function that the library in XBEEAT_CLOCK defines. The caller owns the clock. May throw
// std::system_error.
extern "C" XBeeAT::Clock* createXBeeATClock(const char* argument);
