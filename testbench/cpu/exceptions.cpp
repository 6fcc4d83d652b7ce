// SPDX-License-Identifier: MIT
//
// exceptions: computes the next exception when something changes; each instruction only reads it.

#include "exceptions.h"
#include <algorithm>

void Exceptions::reset() {
    *this = Exceptions(), update();
}

int Exceptions::priorityOf(unsigned number) const {
    switch (number) {
    case NonMaskable:
        return -2;
    case HardFault:
        return -1;
    default:
        return states_[number].priority;
    }
}

int Exceptions::groupOf(int priority) const {
    return priority < 0 ? priority : priority & ~((2 << group_) - 1) & 0xFF;
}

void Exceptions::pend(unsigned number, bool pending) {
    states_[number].pending = pending;
    update();
}

void Exceptions::enable(unsigned number, bool enabled) {
    states_[number].enabled = enabled;
    update();
}

void Exceptions::setPriority(unsigned number, uint8_t priority) {
    states_[number].priority = priority & priorityBits;
    update();
}

void Exceptions::setGrouping(unsigned group) {
    group_ = group & 7;
    update();
}

void Exceptions::setLine(unsigned number, bool high) {
    State& s = states_[number];
    if (high && !s.level)
        s.pending = true;
    s.level = high;
    update();
}

void Exceptions::enter(unsigned number) {
    states_[number].pending = false;
    states_[number].active = true;
    ++activeCount_;
    update();
}

void Exceptions::leave(unsigned number) {
    State& s = states_[number];
    if (s.active)
        --activeCount_;
    s.active = false;
    s.pending = s.pending || s.level;
    update();
}

void Exceptions::setMasks(uint32_t primask, uint32_t basepri, uint32_t faultmask) {
    primask_ = primask & 1;
    basepri_ = basepri & priorityBits;
    faultmask_ = faultmask & 1;
    updateMasks();
}

void Exceptions::update() {
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

void Exceptions::updateMasks() {
    sleepPriority_ = activePriority_;
    if (basepri_)
        sleepPriority_ = std::min(sleepPriority_, groupOf(static_cast<int>(basepri_)));
    if (faultmask_)
        sleepPriority_ = std::min(sleepPriority_, -1);
    runningPriority_ = primask_ ? std::min(sleepPriority_, 0) : sleepPriority_;
}
