// SPDX-License-Identifier: MIT
//
// pace: keeps simulated time from running ahead of the wall clock, and counts the simulator's
// working time.

#ifndef PACE_H
#define PACE_H

#include <chrono>
#include <cstdint>
#include <thread>

class Pace {
public:
    // `rate`: simulated seconds in one of the wall clock; 0: no limit.
    explicit Pace(double rate) : rate_(rate), anchor_(Clock::now()), begin_(anchor_) {}
    void keep(uint64_t simulatedNs) {
        if (rate_ == 0)
            return;
        auto due = anchor_ + std::chrono::nanoseconds(static_cast<int64_t>(
                                 static_cast<double>(simulatedNs - anchorNs_) / rate_));
        auto now = Clock::now();
        if (due > now) {
            std::this_thread::sleep_until(due);
            slept_ += Clock::now() - now;
        } else if (now - due > std::chrono::milliseconds(50)) {
            anchor_ = now; // too slow for a while: continue from here, without catching up
            anchorNs_ = simulatedNs;
        }
    }
    uint64_t workedNs() const {
        return static_cast<uint64_t>((Clock::now() - begin_ - slept_).count());
    }

private:
    using Clock = std::chrono::steady_clock;

    double rate_;
    Clock::time_point anchor_, begin_;
    uint64_t anchorNs_ = 0;
    Clock::duration slept_{};
};

#endif
