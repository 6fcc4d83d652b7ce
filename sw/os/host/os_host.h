// SPDX-License-Identifier: MIT
//
// os_host: runs the kernel in a process of the host. Each task is a coroutine of the calling
// thread.
//
// A machine (the simulator, or a test) determines how time passes. After simulated time has passed,
// it calls OsHost::interruptPoint(), which serves pending interrupts.

#pragma once

#include <functional>

namespace OsHost {

struct Machine {
    // Called when no task is ready. Must let time pass until the next interrupt.
    std::function<void()> idle;
    // pending: returns true while an interrupt is pending. serve: runs the interrupt handler,
    // between OSIntEnter and OSIntExit. The handler must clear the cause of the interrupt, so that
    // `pending` returns false; otherwise it is called again.
    std::function<bool()> pending;
    std::function<void()> serve;
};

// Sets the machine. Everything to which its functions refer must exist until run() has returned.
// Call this before OSInit.
void setMachine(Machine machine);

// Runs the tasks, as OSStart does. Returns after a call of stop(); rethrows an exception that a
// task has thrown.
void run();

// Makes run() return; may be called by a task, an interrupt handler or `idle`. No task runs
// afterwards.
[[noreturn]] void stop();

// Serves pending interrupts, if they are enabled and none is being served.
void interruptPoint();

} // namespace OsHost
