// SPDX-License-Identifier: MIT
//
// checkpoints: frozen copies of this process (fork), to which a debugger goes back.
//
// A copy is all that there is: processor, chip, radio, air. Who wants to go back wakes the last
// copy before that place, with an order, and is heard of no more; what is woken is again a copy of
// the frozen one, which stays. Connections are shared, so that the debugger notices nothing. The
// first process ends when the last one does, with its status; all others end with the one that made
// them.

#ifndef CHECKPOINTS_H
#define CHECKPOINTS_H

#include <cstdint>
#include <optional>
#include <set>

class Checkpoints {
public:
    // The task of a copy that is woken. Places are counts of instructions.
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
    // many. Returns an order in a process that was woken, none where the run goes on.
    std::optional<Order> freeze(uint64_t place);
    // Wakes the last copy at or before `before`; there must be one. Does not return.
    [[noreturn]] void wake(uint64_t before, const Order& order);
    // Ends the copies behind this place: what comes then will be something else.
    void forgetBehind(uint64_t place);
    // True if there is nothing to go back to from here.
    bool isFirst(uint64_t place) const;

private:
    struct Shared;
    std::optional<Order> sleep();
    [[noreturn]] void waitForTheEnd();

    Shared* shared_; // by all these processes
    bool hasCopies_ = false;
};

#endif
