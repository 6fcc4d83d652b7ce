// SPDX-License-Identifier: MIT
//
// standstill: reports firmware that computes without end. Simulated time passes only in bus
// accesses and while the firmware is idle, so such a flight would stand still without any message.

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

// Watches simulated time as long as this object exists. Only one such object may exist at a time.
class Standstill {
public:
    // `now` returns simulated time, ns. `seconds` is a CPU time of this process (default 10): if
    // simulated time does not change for that long, a report is printed on stderr. After a report,
    // Ctrl-C ends the process at once.
    explicit Standstill(std::function<uint64_t()> now, double seconds = 10);
    ~Standstill();
    Standstill(const Standstill&) = delete;
    Standstill& operator=(const Standstill&) = delete;

    // Returns the number of reports. Simulated time that stops and later continues is reported
    // once.
    unsigned reports() const { return reports_; }

private:
    static constexpr unsigned ticks = 10; // number of samples in `seconds`

    void onTick(const void* context);

    const std::function<uint64_t()> now_;
    uint64_t last_ = 0;
    // same_: number of successive samples in which simulated time had not changed
    volatile unsigned same_ = 0, reports_ = 0;
};

// Returns the names of the functions at the return addresses, found by addr2line. Functions of
// libraries are omitted.
std::vector<std::string> functionsAt(const std::vector<void*>& addresses);
