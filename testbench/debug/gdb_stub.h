// SPDX-License-Identifier: MIT
//
// gdb_stub: lets a debugger on this machine command a CortexM3: GDB's remote serial protocol over
// TCP on the loopback interface. Registers, memory, breakpoints, step, continue, interrupt,
// `monitor reset`.

#pragma once

#include "cortex_m3.h"
#include <cstdint>
#include <functional>
#include <string>

class GdbStub {
public:
    // The target of the debugger's commands. `run` returns when the processor stops (or the
    // simulation ends: then `isOver` is true); `describe` is the answer to `monitor info`.
    struct Target {
        CortexM3& cpu;
        std::function<CortexM3::Stop(bool singleStep)> run;
        std::function<void()> reset;
        std::function<bool()> isOver;
        std::function<std::string()> describe;
        // Goes back one stop, or to the last breakpoint, if supported. Returns if there is nothing
        // before; otherwise the continuing process returns from `run`.
        std::function<void(bool singleStep)> back = nullptr;
        // Returns where a reversible run has ended: at its "begin" or "end", or "".
        std::function<std::string()> edge = [] { return ""; };
        std::function<void()> changed = [] {}; // the debugger has written registers or memory
    };
    // Listens on 127.0.0.1; port 0 selects a free one. Throws std::system_error if the port is
    // taken.
    explicit GdbStub(uint16_t port);
    ~GdbStub();
    GdbStub(const GdbStub&) = delete;
    GdbStub& operator=(const GdbStub&) = delete;
    uint16_t port() const { return port_; }

    // Waits for a debugger while `mayWait` returns true, and executes its commands. A peer that
    // does not speak the protocol is disconnected. Returns true if the program must continue; false
    // if the debugger has killed it, the simulation is over, or no debugger has connected.
    bool serve(const Target& target, const std::function<bool()>& mayWait);
    // True while the processor runs and must stop: the debugger has sent Ctrl-C, or has gone, or
    // another one waits.
    bool wantsStop();
    bool hasServed() const { return served_; }

private:
    bool accept(const std::function<bool()>& mayWait);
    bool receive(std::string& packet);
    bool talks(const Target& target);
    void patient(bool on);
    int nextByte();
    void send(const std::string& payload);
    std::string answer(const Target& target, const std::string& packet);
    std::string query(const Target& target, const std::string& packet);
    std::string readRegisters(const Target& target, int first, int last);
    std::string readMemory(const Target& target, const std::string& arguments);
    std::string writeMemory(const Target& target, const std::string& arguments);
    std::string breakpoint(const Target& target, const std::string& packet);
    std::string resume(const Target& target, bool singleStep);
    std::string back(const Target& target, const std::string& packet);

    int listener_ = -1, connection_ = -1;
    uint16_t port_ = 0;
    bool over_ = false, detached_ = false, served_ = false, noAcknowledgement_ = false;
};
