// SPDX-License-Identifier: MIT
//
// ground_step: the simulator's side of keeping step.

#include "ground_step.h"
#include "sim_status.h"
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sched.h>
#include <unistd.h>

namespace {

constexpr unsigned turnsAtOnce = 50, napUs = 50, turnsBetweenQuestions = 200;

uint64_t load(const uint64_t& field) {
    return __atomic_load_n(&field, __ATOMIC_ACQUIRE);
}

pid_t processOf(uint64_t keeper) {
    return static_cast<pid_t>(keeper & 0xFFFFFFFFu);
}

// True if a debugger or SIGSTOP holds the process: "PID (NAME) T ..." in its stat.
bool isHeld(pid_t process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    std::getline(file, text);
    const size_t name = text.rfind(") ");
    return name != std::string::npos && (text[name + 2] == 'T' || text[name + 2] == 't');
}

} // namespace

GroundStep::GroundStep(SimStatus& status, PtyLine& pty, std::function<bool()> goOn, double patience)
    : status_(status), goOn_(std::move(goOn)), patience_(patience) {
    std::strncpy(status_.device, pty.path().c_str(), sizeof status_.device - 1);
    pty.keepCount({[this] { return load(status_.keeper); },
                   [this](uint64_t keeper, size_t bytes) { given(keeper, bytes); },
                   [this] { return load(status_.fromGround); }});
}

// When a byte is counted its reader may have left, and another one begun.
void GroundStep::given(uint64_t keeper, size_t bytes) {
    uint64_t is = load(status_.toGround);
    while (is - simCount(is) == simSession(keeper) &&
           !__atomic_compare_exchange_n(&status_.toGround, &is, is + bytes, false, __ATOMIC_SEQ_CST,
                                        __ATOMIC_SEQ_CST)) {
    }
}

bool GroundStep::holds(uint64_t now) const {
    return load(status_.keeper) != 0 &&
           (load(status_.untilNs) <= now || load(status_.taken) < simCount(load(status_.toGround)));
}

// A killed program has not signed off.
void GroundStep::dismissTheDead() {
    uint64_t keeper = load(status_.keeper);
    if (keeper && kill(processOf(keeper), 0) != 0 && errno == ESRCH)
        dismiss(keeper);
}

void GroundStep::dismiss(uint64_t keeper) {
    __atomic_compare_exchange_n(&status_.keeper, &keeper, uint64_t(0), false, __ATOMIC_SEQ_CST,
                                __ATOMIC_SEQ_CST);
}

void GroundStep::wait(uint64_t now) {
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

uint64_t GroundStep::nextEvent() const {
    return load(status_.keeper) ? load(status_.untilNs) : never;
}
