// SPDX-License-Identifier: MIT
//
// checkpoints: makes frozen copies of this process (fork), which let a debugger step backwards.
//
// A copy contains everything: processor, chip, radio, air. To go back to a place, the running
// process wakes the last copy before that place, gives it an order, and ends. The frozen copy
// forks, and the new process carries out the order; the copy itself stays frozen and can be used
// again. All processes share the connections, so the debugger does not notice the change. The first
// process waits for the last running process and ends with the same exit status. All other
// processes end when their parent ends.

#pragma once

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <optional>
#include <set>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <system_error>
#include <unistd.h>

class Checkpoints {
public:
    // Order that a woken copy carries out. A place is a number of executed instructions.
    struct Order {
        enum Goal {
            Stop, // run to `place`, and stop there
            // find the last place before `place` at which the processor could have stopped
            LastStop,
            LastBreakpoint // find the last breakpoint before `place`
        } goal;
        uint64_t place;
        std::set<uint32_t> breakpoints; // breakpoint addresses, at most 250
    };

    Checkpoints()
        : shared_(static_cast<Shared*>(mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE,
                                            MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
        if (shared_ == MAP_FAILED)
            throw std::system_error(errno, std::generic_category(), "no memory for checkpoints");
        shared_->first = shared_->active = getpid();
    }
    // In a woken process, the destructor must not end other processes. The first process ends them,
    // after it has waited for the exit status.
    ~Checkpoints() {
        if (getpid() != shared_->first)
            return;
        forgetBehind(0);
        munmap(shared_, sizeof(Shared));
    }
    Checkpoints(const Checkpoints&) = delete;
    Checkpoints& operator=(const Checkpoints&) = delete;

    // Forks a frozen copy, unless a copy at or after this place exists or the maximum number of
    // copies is reached. In the process that continues, returns nothing. In a copy that is woken
    // later, returns the order that this copy has received.
    std::optional<Order> freeze(uint64_t place) {
        Shared& s = *shared_;
        if (s.count == mostCopies || (s.count && s.copies[s.count - 1].place >= place))
            return std::nullopt;
        const pid_t copy = forkChild();
        if (copy == 0)
            return sleep();
        s.copies[s.count++] = {place, copy};
        hasCopies_ = true;
        return std::nullopt;
    }
    // Wakes the last copy at or before `before`; such a copy must exist. Does not return.
    [[noreturn]] void wake(uint64_t before, const Order& order) {
        Shared& s = *shared_;
        s.goal = order.goal;
        s.place = order.place;
        s.breakpointCount = 0;
        for (uint32_t address : order.breakpoints)
            if (s.breakpointCount < mostBreakpoints)
                s.breakpoints[s.breakpointCount++] = address;
        s.active = 0;
        unsigned last = s.count - 1;
        while (last && s.copies[last].place > before)
            --last;
        std::cout.flush();
        std::fflush(nullptr);
        kill(s.copies[last].process, SIGUSR1);
        if (getpid() == s.first)
            waitForTheEnd();
        // The copies end together with their parent, so this process must not end while it has
        // copies.
        while (hasCopies_)
            pause();
        _exit(0);
    }
    // Ends the copies after this place, because the run may be different after it.
    void forgetBehind(uint64_t place) {
        for (Shared& s = *shared_; s.count && s.copies[s.count - 1].place > place; --s.count)
            kill(s.copies[s.count - 1].process, SIGKILL);
    }
    // Returns true if no copy exists before this place.
    bool isFirst(uint64_t place) const {
        return shared_->count == 0 || place <= shared_->copies[0].place;
    }

private:
    static constexpr unsigned mostCopies = 64, mostBreakpoints = 250;

    // Forks a process that is ended when this process ends. Returns 0 in the new process.
    static pid_t forkChild() {
        const pid_t parent = getpid();
        std::cout.flush();
        std::fflush(nullptr);
        const pid_t child = fork();
        if (child < 0)
            throw std::system_error(errno, std::generic_category(), "cannot make a checkpoint");
        if (child == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            if (getppid() != parent)
                _exit(1);
        }
        return child;
    }

    struct Shared {
        struct Copy {
            uint64_t place;
            pid_t process;
        } copies[mostCopies]; // copies, ordered by place
        unsigned count;
        Order::Goal goal;
        uint64_t place;
        unsigned breakpointCount;
        uint32_t breakpoints[mostBreakpoints];
        // process ids of the first and of the running process; `active` is 0 while a copy is being
        // woken
        pid_t first, active;
        bool over; // true if the running process has ended normally
        int status;
    };

    // Keeps this copy frozen. Each time it is woken, it forks; only the forked process returns
    // the order.
    std::optional<Order> sleep() {
        sigset_t all, wakes, before;
        sigfillset(&all);
        sigemptyset(&wakes);
        sigaddset(&wakes, SIGUSR1);
        sigprocmask(SIG_SETMASK, &all, &before); // Ctrl-C must not end a frozen copy
        signal(SIGCHLD, SIG_IGN);
        do {
            int number;
            sigwait(&wakes, &number);
        } while (forkChild() != 0);
        signal(SIGCHLD, SIG_DFL);
        sigprocmask(SIG_SETMASK, &before, nullptr);
        Shared& s = *shared_;
        hasCopies_ = false;
        s.active = getpid();
        on_exit(
            [](int status, void* shared) {
                static_cast<Shared*>(shared)->status = status;
                static_cast<Shared*>(shared)->over = true;
            },
            shared_);
        return Order{s.goal, s.place, {s.breakpoints, s.breakpoints + s.breakpointCount}};
    }
    [[noreturn]] void waitForTheEnd() {
        const Shared& s = *shared_;
        for (int number : {SIGINT, SIGTERM, SIGHUP})
            signal(number, SIG_DFL);
        for (;;) {
            const pid_t active = s.active;
            usleep(20'000);
            if (s.over)
                _exit(s.status);
            if (active && active == s.active && kill(active, 0) != 0 && errno == ESRCH && !s.over) {
                std::fputs("icesoc-sim: the process of the earlier moment, to which the debugger "
                           "went back, has ended\n",
                           stderr);
                _exit(1);
            }
        }
    }

    Shared* shared_; // memory shared by all these processes
    bool hasCopies_ = false;
};
