// SPDX-License-Identifier: MIT
//
// clock: the time that an engine lives by: the machine's, or that of a simulated modem, so that a
// slow machine makes a mission slow and no time-out early. A simulator names its file of counters
// (sim_status.h) to the programs it starts in the environment variable XBEEAT_CLOCK.

#ifndef GROUND_CLOCK_H
#define GROUND_CLOCK_H

#include <cstddef>
#include <cstdint>
#include <poll.h>
#include <string>

struct SimStatus;

namespace XBeeAT {

class Clock {
public:
    // Lives by the file that XBEEAT_CLOCK names, or else by the machine.
    Clock();
    // Lives by this file; an empty name is the machine. Throws std::system_error.
    explicit Clock(const std::string& file);
    ~Clock();
    Clock(const Clock&) = delete;
    Clock& operator=(const Clock&) = delete;

    static constexpr uint32_t forever = 0xFFFFFFFFu;
    uint32_t nowUs() const; // wraps around
    // Works as poll does: returns when something is ready or `us` have passed by this clock.
    int wait(pollfd* fds, nfds_t count, uint32_t us);

    // Makes simulated time wait for this thread from now on: it stands still except during `wait`,
    // and until all has been read that `serial` was given. Has no effect by the machine's clock, or
    // if the simulator's modem is not on `device`.
    void keepStep(int serial, const std::string& device);
    void leaveStep();
    // Count the bytes that went through `serial`.
    void hasRead(size_t bytes);
    void hasWritten(size_t bytes);

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

#endif
