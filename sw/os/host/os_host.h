// SPDX-License-Identifier: MIT
//
// os_host: runs the kernel in a process of the host: each task is a coroutine of the calling
// thread.
//
// A machine (the simulator, or a test) determines how time passes. It calls
// OsHost::interruptPoint() after simulated time has passed; pending interrupts are served there.

#pragma once

#include <functional>

namespace OsHost {

struct Machine {
    // Called when no task is ready; lets time pass until the next interrupt.
    std::function<void()> idle;
    // Returns true while an interrupt is pending. `serve` then runs the interrupt handler between
    // OSIntEnter and OSIntExit. The handler must clear the cause, so that `pending` returns false;
    // otherwise it is called again.
    std::function<bool()> pending;
    std::function<void()> serve;
};

// Sets the machine, which must outlive run(). Call this before OSInit.
void setMachine(Machine machine);

// Runs the tasks like OSStart. Returns after stop() was called; rethrows an exception that a task
// has thrown.
void run();

// Leaves run(), called from a task, an interrupt or idle. No task runs afterwards.
[[noreturn]] void stop();

// Serves pending interrupts, if they are enabled and none is being served.
void interruptPoint();

} // namespace OsHost
