// SPDX-License-Identifier: MIT
//
// standstill: samples simulated time with a timer of CPU time, so that a process that only waits is
// not sampled.

#include "standstill.h"
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <dlfcn.h>
#include <execinfo.h>
#include <fmt/format.h>
#include <sys/time.h>
#include <ucontext.h>
#include <unistd.h>

namespace {

Standstill* theOne = nullptr;

constexpr size_t mostFrames = 40, shownFunctions = 4;

void setTimer(double seconds) {
    itimerval timer{};
    timer.it_interval.tv_sec = static_cast<time_t>(seconds);
    timer.it_interval.tv_usec =
        static_cast<suseconds_t>((seconds - static_cast<double>(timer.it_interval.tv_sec)) * 1e6);
    timer.it_value = timer.it_interval;
    setitimer(ITIMER_PROF, &timer, nullptr);
}

// Returns the program counter at which the signal interrupted the program.
void* interruptedAt(const void* context) {
    const mcontext_t& machine = static_cast<const ucontext_t*>(context)->uc_mcontext;
#if defined(__x86_64__)
    return reinterpret_cast<void*>(machine.gregs[REG_RIP]);
#else
    return reinterpret_cast<void*>(machine.pc);
#endif
}

// Returns the program counter of the interrupted code, and the return addresses of its callers.
std::vector<void*> interruptedCode(const void* context) {
    void* frames[mostFrames];
    void** end = frames + backtrace(frames, mostFrames);
    void** at = std::find(frames, end, interruptedAt(context));
    std::vector<void*> code(at, end);
    if (!code.empty())
        // functionsAt() subtracts 1 from each address, because it expects return addresses; 1 is
        // added to the program counter to cancel this
        code[0] = static_cast<char*>(code[0]) + 1;
    return code;
}

} // namespace

std::vector<std::string> functionsAt(const std::vector<void*>& addresses) {
    Dl_info program{};
    dladdr(reinterpret_cast<void*>(&setTimer), &program);
    std::string command = "addr2line -f -C -e /proc/" + std::to_string(getpid()) + "/exe";
    for (void* address : addresses) {
        Dl_info info{};
        if (dladdr(address, &info) && info.dli_fbase == program.dli_fbase)
            command += fmt::format(" {:#x}", static_cast<char*>(address) -
                                                 static_cast<char*>(program.dli_fbase) - 1);
    }
    std::vector<std::string> names;
    FILE* output = popen((command + " 2>/dev/null").c_str(), "r");
    char line[1000];
    for (unsigned number = 0; output && std::fgets(line, sizeof line, output); ++number) {
        line[std::strcspn(line, "\n")] = 0;
        // addr2line prints two lines per address: the name of the function, then the file
        if (number % 2 == 0 && line[0] != '?')
            names.push_back(line);
    }
    if (output)
        pclose(output);
    return names;
}

Standstill::Standstill(std::function<uint64_t()> now, double seconds) : now_(std::move(now)) {
    theOne = this;
    void* first[1];
    // loads the library that backtrace needs, because a signal handler must not load it
    backtrace(first, 1);
    struct sigaction action{};
    action.sa_sigaction = [](int, siginfo_t*, void* context) { theOne->onTick(context); };
    action.sa_flags = SA_RESTART | SA_SIGINFO;
    sigaction(SIGPROF, &action, nullptr);
    setTimer(seconds / ticks);
}

Standstill::~Standstill() {
    setTimer(0);
    std::signal(SIGPROF, SIG_IGN);
    theOne = nullptr;
}

// The functions called here need not be safe in a signal handler, because the program hangs anyway.
void Standstill::onTick(const void* context) {
    const uint64_t now = now_();
    same_ = now == last_ ? same_ + 1 : 0;
    last_ = now;
    if (same_ != ticks)
        return;
    reports_ = reports_ + 1;
    std::vector<std::string> names = functionsAt(interruptedCode(context));
    if (names.size() > shownFunctions)
        names.resize(shownFunctions);
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : ", called by ") + name;
    fmt::print(stderr,
               "icesoc-sim: simulated time has stopped at {:.6f} s; the firmware is in {}; Ctrl-C "
               "ends the flight\n",
               static_cast<double>(now) / 1e9,
               text.empty() ? "an unknown function: addr2line (binutils) finds no name" : text);
    // The flight's signal handler only sets a flag, which hanging firmware never reads. With the
    // default handler, a signal ends the process.
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        std::signal(signal, SIG_DFL);
}
