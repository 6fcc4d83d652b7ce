// SPDX-License-Identifier: MIT
//
// os_host: the kernel's port to a host process: tasks are coroutines of the calling thread.
//
// A machine (the simulator, or a test) determines how time passes. Interrupts are delivered by
// OsHost::interruptPoint(), which the machine calls wherever simulated time has passed.

#pragma once

#include <functional>

namespace OsHost {

struct Machine {
    // Lets time pass up to the next interrupt: no task is ready.
    std::function<void()> idle;
    // Returns true while an interrupt is pending; then `serve` runs its handler (between OSIntEnter
    // and OSIntExit), which must make `pending` return false or the handler is entered again.
    std::function<bool()> pending;
    std::function<void()> serve;
};

// Sets the machine, which must outlive run(). To be called before OSInit.
void setMachine(Machine machine);

// Runs the tasks like OSStart, but returns: when stop() is called, or with the exception that left
// a task.
void run();

// Leaves run() from within a task, an interrupt or idle. Tasks do not continue afterwards.
[[noreturn]] void stop();

// Serves pending interrupts, if they are enabled and none is being served.
void interruptPoint();

} // namespace OsHost
