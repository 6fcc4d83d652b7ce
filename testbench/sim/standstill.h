// SPDX-License-Identifier: MIT
//
// standstill: reports a firmware that computes without end. Simulated time passes in its bus
// accesses and while it is idle, so that such a flight would stand still without a message.

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

// Watches simulated time as long as it exists. There is one at a time.
class Standstill {
public:
    // `now`: simulated time, ns. `seconds`: CPU time of this process after which an unchanged time
    // is reported on stderr.
    explicit Standstill(std::function<uint64_t()> now, double seconds = 10);
    ~Standstill();
    Standstill(const Standstill&) = delete;
    Standstill& operator=(const Standstill&) = delete;

    // Number of reports: one each time that simulated time stops.
    unsigned reports() const { return reports_; }

private:
    static constexpr unsigned ticks = 10; // samples in `seconds`

    void onTick(const void* context);

    const std::function<uint64_t()> now_;
    uint64_t last_ = 0;
    volatile unsigned same_ = 0, reports_ = 0; // `same_`: samples of one time
};

// Returns the names of this program's functions at return addresses, by addr2line; functions of
// libraries are left out.
std::vector<std::string> functionsAt(const std::vector<void*>& addresses);
