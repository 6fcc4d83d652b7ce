// SPDX-License-Identifier: MIT
//
// ground_step: makes simulated time wait for a ground program that keeps step with simulated time
// (keep_step.h). The flight then does not depend on how often a busy machine runs the program.

#pragma once

#include "keep_step.h"
#include "serial_line.h"
#include "status_file.h"
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <sched.h>
#include <string>
#include <sys/types.h>
#include <unistd.h>

class GroundStep {
public:
    // `goOn` is called about every 10 ms while simulated time stands still; if it returns false,
    // the wait ends. The wait also ends after `patience` seconds of the wall clock, unless a
    // debugger has stopped the program. In both cases simulated time no longer waits for the
    // program; after `patience` seconds, a message on stderr names the program.
    GroundStep(SimStatus& status, PtyLine& pty, std::function<bool()> goOn, double patience = 60)
        : status_(status), pty_(pty), goOn_(std::move(goOn)), patience_(patience) {
        std::strncpy(status_.device, pty.path().c_str(), sizeof status_.device - 1);
        pty.keepCount({[this] { return load(status_.keeper); },
                       [this](uint64_t keeper, size_t bytes) { given(keeper, bytes); },
                       [this] { return load(status_.fromGround); }});
    }
    GroundStep(const GroundStep&) = delete;
    GroundStep& operator=(const GroundStep&) = delete;

    // Returns when the program allows simulated time to pass beyond `now`. Returns at once if
    // simulated time does not wait for a program.
    void wait(uint64_t now) {
        __atomic_store_n(&status_.carried, pty_.carried(), __ATOMIC_RELEASE);
        if (!holds(now))
            return;
        const auto begin = std::chrono::steady_clock::now();
        for (unsigned turn = 1; holds(now); ++turn) {
            if (turn < turnsAtOnce)
                sched_yield();
            else
                usleep(napUs);
            if (turn % turnsBetweenQuestions != 0)
                continue;
            const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
            const uint64_t keeper = load(status_.keeper);
            if (!goOn_()) {
                dismiss(keeper);
            } else if (waited.count() > patience_ && !isHeld(processOf(keeper))) {
                std::fprintf(
                    stderr,
                    "simulated time stood still for %.0f s: process %d keeps step with it, but "
                    "neither sleeps nor reads %s; the simulator no longer waits for it\n",
                    patience_, static_cast<int>(processOf(keeper)), status_.device);
                dismiss(keeper);
            }
            dismissTheDead();
        }
        waitedNs_ += static_cast<uint64_t>((std::chrono::steady_clock::now() - begin).count());
    }
    // Returns whether a program keeps step.
    bool keeps() const { return load(status_.keeper) != 0; }
    // Returns the simulated time at which the program wakes up, ns.
    uint64_t nextEvent() const { return keeps() ? load(status_.untilNs) : never; }
    uint64_t waitedNs() const { return waitedNs_; } // wall-clock time

private:
    static constexpr unsigned turnsAtOnce = 50, napUs = 50, turnsBetweenQuestions = 200;

    static uint64_t load(const uint64_t& field) {
        return __atomic_load_n(&field, __ATOMIC_ACQUIRE);
    }
    static pid_t processOf(uint64_t keeper) { return static_cast<pid_t>(keeper & 0xFFFFFFFFu); }
    // Returns true if a debugger or SIGSTOP has stopped the process. /proc/PID/stat then contains
    // "PID (NAME) T ...".
    static bool isHeld(pid_t process) {
        std::ifstream file("/proc/" + std::to_string(process) + "/stat");
        std::string text;
        std::getline(file, text);
        const size_t name = text.rfind(") ");
        return name != std::string::npos && (text[name + 2] == 'T' || text[name + 2] == 't');
    }
    // Adds `bytes` to the number of bytes given to the program, unless another program keeps step
    // now.
    void given(uint64_t keeper, size_t bytes) {
        uint64_t is = load(status_.toGround);
        while (is - simCount(is) == simSession(keeper) &&
               !__atomic_compare_exchange_n(&status_.toGround, &is, is + bytes, false,
                                            __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST)) {
        }
    }
    bool holds(uint64_t now) const {
        return load(status_.keeper) != 0 &&
               (load(status_.untilNs) <= now ||
                load(status_.taken) < simCount(load(status_.toGround)));
    }
    // Stops waiting for a program that was killed and therefore could not sign off.
    void dismissTheDead() {
        uint64_t keeper = load(status_.keeper);
        if (keeper && kill(processOf(keeper), 0) != 0 && errno == ESRCH)
            dismiss(keeper);
    }
    void dismiss(uint64_t keeper) {
        __atomic_compare_exchange_n(&status_.keeper, &keeper, uint64_t(0), false, __ATOMIC_SEQ_CST,
                                    __ATOMIC_SEQ_CST);
    }

    SimStatus& status_;
    PtyLine& pty_;
    std::function<bool()> goOn_;
    double patience_;
    uint64_t waitedNs_ = 0;
};
