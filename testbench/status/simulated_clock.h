// SPDX-License-Identifier: MIT
//
// simulated_clock: lets a ground engine use simulated time as its clock. A simulator sets the
// environment variable XBEEAT_CLOCK (clock.h) for the programs that it starts: the variable
// contains the path of this library and, as the library's argument, the simulator's SimStatus file.

#pragma once

#include "clock.h"

struct SimStatus;

class SimulatedClock : public XBeeAT::Clock {
public:
    // Maps a SimStatus file into memory. Throws std::system_error if this fails.
    explicit SimulatedClock(const std::string& file);
    ~SimulatedClock() override;
    SimulatedClock(const SimulatedClock&) = delete;
    SimulatedClock& operator=(const SimulatedClock&) = delete;

    uint32_t nowUs() const override;
    int wait(pollfd* fds, nfds_t count, uint32_t us) override;
    void keepStep(int serial, const std::string& device) override;
    void leaveStep() override;
    void hasRead(size_t bytes) override;
    void hasWritten(size_t bytes) override;
    size_t waiting() const override;

private:
    uint64_t nowNs() const;
    bool inStep() const;
    void sleepUntil(uint64_t ns, bool reads);
    void work();

    SimStatus* simulation_ = nullptr;
    XBeeAT::SystemClock machine_;
    uint64_t token_ = 0; // value of SimStatus::keeper while this program keeps step; otherwise 0
    uint64_t taken_ = 0;
    int serial_ = -1;
};
