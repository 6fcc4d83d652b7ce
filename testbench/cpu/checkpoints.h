// SPDX-License-Identifier: MIT
//
// checkpoints: frozen copies of this process (fork), to which a debugger goes back.
//
// A copy has everything: processor, chip, radio, air. To go back, a process wakes the last copy
// before that place, with an order, and ends. The woken process is a copy of the frozen one, which
// stays. Connections are shared, so the debugger notices nothing. The first process ends when the
// last one does, with its status; all others end with their parent.

#ifndef CHECKPOINTS_H
#define CHECKPOINTS_H

#include <cstdint>
#include <optional>
#include <set>

class Checkpoints {
public:
    // The task of a woken copy. Places are counts of instructions.
    struct Order {
        enum Goal {
            Stop,          // run to `place`, and stop there
            LastStop,      // find the last place before `place` where the processor can stop
            LastBreakpoint // find the last breakpoint before `place`
        } goal;
        uint64_t place;
        std::set<uint32_t> breakpoints; // at most 250
    };

    Checkpoints();
    ~Checkpoints();
    Checkpoints(const Checkpoints&) = delete;
    Checkpoints& operator=(const Checkpoints&) = delete;

    // Leaves a frozen copy behind, unless there is one at or behind this place, or there are too
    // many. Returns an order in a woken process, none where the run continues.
    std::optional<Order> freeze(uint64_t place);
    // Wakes the last copy at or before `before`; there must be one. Does not return.
    [[noreturn]] void wake(uint64_t before, const Order& order);
    // Ends the copies behind this place: the run from here on will differ.
    void forgetBehind(uint64_t place);
    // True if there is no copy to go back to.
    bool isFirst(uint64_t place) const;

private:
    struct Shared;
    std::optional<Order> sleep();
    [[noreturn]] void waitForTheEnd();

    Shared* shared_; // by all these processes
    bool hasCopies_ = false;
};

#endif
