// SPDX-License-Identifier: MIT
//
// exceptions: which exception of a Cortex-M3 is pending, active, enabled, and which may run now.
//
// ARMv7-M Architecture Reference Manual, B1.5. Numbers: 1 Reset .. 15 SysTick, 16 + n is interrupt
// n.

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

enum Exception : unsigned {
    NonMaskable = 2,
    HardFault = 3,
    MemManage = 4,
    BusFault = 5,
    UsageFault = 6,
    SupervisorCall = 11,
    DebugMonitor = 12,
    PendSv = 14,
    SysTick = 15,
    FirstInterrupt = 16
};

class Exceptions {
public:
    static constexpr unsigned interrupts = 81; // of an STM32F2 (RM0033, table 61)
    static constexpr unsigned count = FirstInterrupt + interrupts;
    static constexpr uint8_t priorityBits = 0xF0; // four bits are there
    static constexpr int none = 256;              // priority of thread mode

    struct State {
        bool pending = false, active = false, enabled = false;
        bool level = false; // state of the line: the interrupt pends again while it is high
        uint8_t priority = 0;
    };

    void reset() { *this = Exceptions(), update(); }
    void pend(unsigned number, bool pending = true) {
        states_[number].pending = pending;
        update();
    }
    void enable(unsigned number, bool enabled) {
        states_[number].enabled = enabled;
        update();
    }
    void setPriority(unsigned number, uint8_t priority) {
        states_[number].priority = priority & priorityBits;
        update();
    }
    // Sets PRIGROUP.
    void setGrouping(unsigned group) {
        group_ = group & 7;
        update();
    }
    unsigned grouping() const { return group_; }
    void setLine(unsigned number, bool high) {
        State& s = states_[number];
        if (high && !s.level)
            s.pending = true;
        s.level = high;
        update();
    }
    // Makes a pending exception active.
    void enter(unsigned number) {
        states_[number].pending = false;
        states_[number].active = true;
        ++activeCount_;
        update();
    }
    void leave(unsigned number) {
        State& s = states_[number];
        if (s.active)
            --activeCount_;
        s.active = false;
        s.pending = s.pending || s.level;
        update();
    }
    const State& operator[](unsigned number) const { return states_[number]; }
    unsigned activeCount() const { return activeCount_; }

    // The masks of the processor.
    void setMasks(uint32_t primask, uint32_t basepri, uint32_t faultmask) {
        primask_ = primask & 1;
        basepri_ = basepri & priorityBits;
        faultmask_ = faultmask & 1;
        updateMasks();
    }

    // Returns the exception that must be entered now; 0: none.
    unsigned deliverable() const { return bestPriority_ < runningPriority_ ? best_ : 0; }
    // Returns the priority that the processor runs at, with masks; `none` in thread mode without
    // them.
    int runningPriority() const { return runningPriority_; }
    // Returns the pending one of the highest priority, masked or not; 0: none.
    unsigned firstPending() const { return best_; }
    // WFI wakes by an exception that would preempt with PRIMASK 0 (B1.5.19).
    bool wakes() const { return bestPriority_ < sleepPriority_; }
    int priorityOf(unsigned number) const {
        switch (number) {
        case NonMaskable:
            return -2;
        case HardFault:
            return -1;
        default:
            return states_[number].priority;
        }
    }

private:
    int groupOf(int priority) const {
        return priority < 0 ? priority : priority & ~((2 << group_) - 1) & 0xFF;
    }
    void update() {
        activePriority_ = none;
        best_ = 0;
        bestPriority_ = none;
        int bestExact = none;
        for (unsigned n = NonMaskable; n < count; ++n) {
            const State& s = states_[n];
            if (s.active)
                activePriority_ = std::min(activePriority_, groupOf(priorityOf(n)));
            bool possible =
                n < MemManage || n == SupervisorCall || n == PendSv || n == SysTick || s.enabled;
            if (s.pending && possible && priorityOf(n) < bestExact) {
                best_ = n;
                bestExact = priorityOf(n);
            }
        }
        if (best_)
            bestPriority_ = groupOf(bestExact);
        updateMasks();
    }
    void updateMasks() {
        sleepPriority_ = activePriority_;
        if (basepri_)
            sleepPriority_ = std::min(sleepPriority_, groupOf(static_cast<int>(basepri_)));
        if (faultmask_)
            sleepPriority_ = std::min(sleepPriority_, -1);
        runningPriority_ = primask_ ? std::min(sleepPriority_, 0) : sleepPriority_;
    }

    std::array<State, count> states_;
    unsigned group_ = 0, activeCount_ = 0;
    uint32_t primask_ = 0, basepri_ = 0, faultmask_ = 0;
    unsigned best_ = 0;
    int bestPriority_ = none, activePriority_ = none, runningPriority_ = none,
        sleepPriority_ = none;
};
