// SPDX-License-Identifier: MIT
//
// os_host: runs tasks as coroutines (ucontext), delivers interrupts at defined points, and passes
// exceptions from a task to the caller of run().

#include "os_host.h"

extern "C" {
#include "os_core.h"
}

#include <deque>
#include <exception>
#include <stdexcept>
#include <ucontext.h>
#include <vector>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif

namespace {

// Stack size of a task on the host, bytes. The firmware's stacks are sized for a Cortex-M3; host
// functions that the firmware calls need larger ones.
constexpr size_t stackBytes = 256 * 1024;

struct Coroutine {
    ucontext_t context{};
    std::vector<char> stack;
    void (*task)(void*) = nullptr;
    void* argument = nullptr;
    void* fakeStack = nullptr; // AddressSanitizer's
    const void* bottom = nullptr;
    size_t size = 0;
};

struct Port {
    OsHost::Machine machine;
    std::deque<Coroutine> coroutines;
    Coroutine caller; // coroutine that has called run()
    Coroutine* active = nullptr;
    std::exception_ptr failure;
    bool masked = false, serving = false;
};

Port port;

void switchTo(Coroutine& to) {
    Coroutine& from = *port.active;
    port.active = &to;
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_start_switch_fiber(&from.fakeStack, to.bottom, to.size);
#endif
    swapcontext(&from.context, &to.context);
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_finish_switch_fiber(from.fakeStack, nullptr, nullptr);
#endif
}

void entry() {
    Coroutine& self = *port.active;
#if defined(__SANITIZE_ADDRESS__)
    const void* bottom = nullptr;
    size_t size = 0;
    __sanitizer_finish_switch_fiber(nullptr, &bottom, &size);
    if (!port.caller.bottom) {
        port.caller.bottom = bottom;
        port.caller.size = size;
    }
#endif
    port.masked = false;
    try {
        self.task(self.argument);
        throw std::logic_error("a task returned; tasks loop for ever");
    } catch (...) {
        port.failure = std::current_exception();
    }
    switchTo(port.caller);
}

Coroutine* coroutineOf(const OS_Task* task) {
    return reinterpret_cast<Coroutine*>(task->stack);
}

} // namespace

namespace OsHost {

void setMachine(Machine machine) {
    port.machine = std::move(machine);
    port.coroutines.clear();
    port.failure = nullptr;
    port.masked = port.serving = false;
    port.caller = Coroutine();
}

void run() {
    port.active = &port.caller;
    OSStart();
    if (port.failure) {
        auto failure = port.failure;
        port.failure = nullptr;
        std::rethrow_exception(failure);
    }
}

void stop() {
    switchTo(port.caller);
    std::terminate(); // never reached, because nothing resumes a task after stop
}

void interruptPoint() {
    if (port.masked || port.serving || !os_kernel.running)
        return;
    while (port.machine.pending()) {
        port.serving = true;
        OSIntEnter();
        port.machine.serve();
        port.serving = false;
        OSIntExit(); // another task may run first; this task continues here later
    }
}

} // namespace OsHost

extern "C" {

OS_CPU_SR OS_CPU_SR_Save(void) {
    OS_CPU_SR was = port.masked;
    port.masked = true;
    return was;
}

void OS_CPU_SR_Restore(OS_CPU_SR cpu_sr) {
    port.masked = cpu_sr != 0;
}

OS_STK* OSTaskStkInit(void (*task)(void*), void* p_arg, OS_STK* ptos, INT16U opt) {
    (void)ptos; // the given stack is not used, because the port allocates larger stacks
    (void)opt;
    port.coroutines.emplace_back();
    Coroutine& c = port.coroutines.back();
    c.stack.resize(stackBytes);
    c.bottom = c.stack.data();
    c.size = c.stack.size();
    c.task = task;
    c.argument = p_arg;
    getcontext(&c.context);
    c.context.uc_stack.ss_sp = c.stack.data();
    c.context.uc_stack.ss_size = c.stack.size();
    c.context.uc_link = nullptr;
    makecontext(&c.context, entry, 0);
    return reinterpret_cast<OS_STK*>(&c);
}

void OSStartHighRdy(void) {
    switchTo(*coroutineOf(os_kernel.current));
}

void OSCtxSw(OS_Task* from, OS_Task* to) {
    (void)from;
    switchTo(*coroutineOf(to));
}

void OSTaskIdleHook(void) {
    port.machine.idle();
    OsHost::interruptPoint();
}
}
