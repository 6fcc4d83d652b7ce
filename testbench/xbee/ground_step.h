// SPDX-License-Identifier: MIT
//
// ground_step: makes simulated time wait for the program on the ground that keeps step with it
// (sim_status.h), however seldom a busy machine lets that program run.

#ifndef GROUND_STEP_H
#define GROUND_STEP_H

#include "serial_line.h"
#include <functional>

struct SimStatus;

class GroundStep {
public:
    // `goOn`: called about each 10 ms while time stands still; false: stop waiting. A program that
    // holds time for `patience` seconds of the wall clock without a debugger is no longer waited
    // for, and stderr says so.
    GroundStep(SimStatus& status, PtyLine& pty, std::function<bool()> goOn, double patience = 60);
    GroundStep(const GroundStep&) = delete;
    GroundStep& operator=(const GroundStep&) = delete;

    // Returns when the program lets time pass beyond `now`; at once if none keeps step.
    void wait(uint64_t now);
    // Returns when the program wakes up, in simulated ns.
    uint64_t nextEvent() const;
    uint64_t waitedNs() const { return waitedNs_; } // of the wall clock

private:
    void given(uint64_t keeper, size_t bytes);
    bool holds(uint64_t now) const;
    void dismissTheDead();
    void dismiss(uint64_t keeper);

    SimStatus& status_;
    std::function<bool()> goOn_;
    double patience_;
    uint64_t waitedNs_ = 0;
};

#endif
