// SPDX-License-Identifier: MIT
//
// masked_time: the longest time in which PRIMASK, FAULTMASK or BASEPRI block interrupts.

#pragma once

#include <cstdint>

class MaskedTime {
public:
    // Longest time since start() in which the masks blocked interrupts of the watched priority and
    // below, in cycles, and the end of that time.
    struct Longest {
        uint64_t cycles = 0;
        uint32_t from = 0, to = 0; // addresses of the instructions that masked and unmasked
    };

    void start(uint8_t priority) {
        priority_ = priority;
        longest_ = Longest();
        isMasked_ = false;
    }
    void reset() { isMasked_ = false; }
    // Called after an instruction at `executed` has changed a mask; `next` follows it.
    void update(bool blocksAll, uint32_t basepri, uint64_t cycles, uint32_t executed,
                uint32_t next) {
        const bool isMasked = blocksAll || (basepri && basepri <= priority_);
        if (isMasked && !isMasked_) {
            since_ = cycles;
            from_ = executed;
        } else if (!isMasked && isMasked_ && cycles - since_ > longest_.cycles) {
            longest_ = {cycles - since_, from_, next};
        }
        isMasked_ = isMasked;
    }
    const Longest& longest() const { return longest_; }

private:
    uint8_t priority_ = 0xFF;
    bool isMasked_ = false;
    uint64_t since_ = 0; // cycle count
    uint32_t from_ = 0;
    Longest longest_;
};
