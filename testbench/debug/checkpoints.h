// SPDX-License-Identifier: MIT
//
// checkpoints: frozen copies of this process (fork), used by a debugger to step backwards.
//
// A copy has everything: processor, chip, radio, air. To go back to a place, a process wakes the
// last copy before this place, gives it an order, and ends. The woken process is itself a copy of
// the frozen one, which stays frozen. Connections are shared, so the debugger notices nothing. The
// first process ends together with the last one, with the same exit status; all others end with
// their parent.

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
    // The task of a woken copy. Places are counts of instructions.
    struct Order {
        enum Goal {
            Stop,          // run to `place` and stop there
            LastStop,      // find the last place before `place` at which the processor can stop
            LastBreakpoint // find the last breakpoint before `place`
        } goal;
        uint64_t place;
        std::set<uint32_t> breakpoints; // at most 250
    };

    Checkpoints()
        : shared_(static_cast<Shared*>(mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE,
                                            MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
        if (shared_ == MAP_FAILED)
            throw std::system_error(errno, std::generic_category(), "checkpoints");
        shared_->first = shared_->active = getpid();
    }
    // The destructor of a woken process does not end other processes; the first process does, which
    // waits for the exit status.
    ~Checkpoints() {
        if (getpid() != shared_->first)
            return;
        forgetBehind(0);
        munmap(shared_, sizeof(Shared));
    }
    Checkpoints(const Checkpoints&) = delete;
    Checkpoints& operator=(const Checkpoints&) = delete;

    // Forks a frozen copy, unless one exists at or after this place or there are too many. In a
    // woken process, returns the order; otherwise returns nothing, and the run continues.
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
    // Wakes the last copy at or before `before`; there must be one. Does not return.
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
        while (hasCopies_) // the copies would end with this process
            pause();
        _exit(0);
    }
    // Ends the copies after this place, because the run will be different after it.
    void forgetBehind(uint64_t place) {
        for (Shared& s = *shared_; s.count && s.copies[s.count - 1].place > place; --s.count)
            kill(s.copies[s.count - 1].process, SIGKILL);
    }
    // True if no earlier copy exists.
    bool isFirst(uint64_t place) const {
        return shared_->count == 0 || place <= shared_->copies[0].place;
    }

private:
    static constexpr unsigned mostCopies = 64, mostBreakpoints = 250;

    // Forks a process that ends when this one does. Returns 0 in it.
    static pid_t forkChild() {
        const pid_t parent = getpid();
        std::cout.flush();
        std::fflush(nullptr);
        const pid_t child = fork();
        if (child < 0)
            throw std::system_error(errno, std::generic_category(), "a checkpoint");
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
        } copies[mostCopies]; // ordered by place
        unsigned count;
        Order::Goal goal;
        uint64_t place;
        unsigned breakpointCount;
        uint32_t breakpoints[mostBreakpoints];
        pid_t first, active; // process ids; active is 0 while it is being woken
        bool over;           // the active process has ended normally
        int status;
    };

    // Holds a frozen copy, which forks each time it is woken. Returns only in the forked process.
    std::optional<Order> sleep() {
        sigset_t all, wakes, before;
        sigfillset(&all);
        sigemptyset(&wakes);
        sigaddset(&wakes, SIGUSR1);
        sigprocmask(SIG_SETMASK, &all, &before); // a Ctrl-C must not reach the frozen copy
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
