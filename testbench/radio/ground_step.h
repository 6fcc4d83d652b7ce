// SPDX-License-Identifier: MIT
//
// ground_step: makes simulated time wait for the program on the ground that keeps step with it
// (keep_step.h), however seldom a busy machine lets that program run.

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
    // Calls `goOn` about each 10 ms while time stands still, and stops waiting when it returns
    // false. A program that holds time for `patience` seconds of the wall clock without a debugger
    // is no longer waited for; stderr names it.
    GroundStep(SimStatus& status, PtyLine& pty, std::function<bool()> goOn, double patience = 60)
        : status_(status), pty_(pty), goOn_(std::move(goOn)), patience_(patience) {
        std::strncpy(status_.device, pty.path().c_str(), sizeof status_.device - 1);
        pty.keepCount({[this] { return load(status_.keeper); },
                       [this](uint64_t keeper, size_t bytes) { given(keeper, bytes); },
                       [this] { return load(status_.fromGround); }});
    }
    GroundStep(const GroundStep&) = delete;
    GroundStep& operator=(const GroundStep&) = delete;

    // Returns when the program lets time pass beyond `now`; at once if none keeps step.
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
                    "simulated time stood still for %.0f s: process %d keeps step with it, and "
                    "neither sleeps nor reads %s; it is waited for no longer\n",
                    patience_, static_cast<int>(processOf(keeper)), status_.device);
                dismiss(keeper);
            }
            dismissTheDead();
        }
        waitedNs_ += static_cast<uint64_t>((std::chrono::steady_clock::now() - begin).count());
    }
    // Returns when the program wakes up, in simulated ns.
    uint64_t nextEvent() const { return load(status_.keeper) ? load(status_.untilNs) : never; }
    uint64_t waitedNs() const { return waitedNs_; } // wall-clock time

private:
    static constexpr unsigned turnsAtOnce = 50, napUs = 50, turnsBetweenQuestions = 200;

    static uint64_t load(const uint64_t& field) {
        return __atomic_load_n(&field, __ATOMIC_ACQUIRE);
    }
    static pid_t processOf(uint64_t keeper) { return static_cast<pid_t>(keeper & 0xFFFFFFFFu); }
    // True if a debugger or SIGSTOP has stopped the process: "PID (NAME) T ..." in its stat.
    static bool isHeld(pid_t process) {
        std::ifstream file("/proc/" + std::to_string(process) + "/stat");
        std::string text;
        std::getline(file, text);
        const size_t name = text.rfind(") ");
        return name != std::string::npos && (text[name + 2] == 'T' || text[name + 2] == 't');
    }
    // When a byte is counted, its reader may have left and another one may have begun.
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
    // A killed program has not signed off.
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
