// SPDX-License-Identifier: MIT
//
// masked_time: measures the longest time during which PRIMASK, FAULTMASK or BASEPRI block
// interrupts.

#pragma once

#include <cstdint>

class MaskedTime {
public:
    // Longest time since start() for which interrupts of the measured priority, and of less urgent
    // priorities, were blocked; and the time at which it ended. Both are in cycles.
    struct Longest {
        uint64_t cycles = 0;
        // address of the instruction that blocked the interrupts, and of the instruction that
        // unblocked them
        uint32_t from = 0, to = 0;
    };

    void start(uint8_t priority) {
        priority_ = priority;
        longest_ = Longest();
        isMasked_ = false;
    }
    void reset() { isMasked_ = false; }
    // Called after the instruction at `executed` has changed a mask register; `next` is the address
    // of the next instruction.
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
