// SPDX-License-Identifier: MIT
//
// gdb_stub: lets a debugger on the same machine control a CortexM3. It serves GDB's remote serial
// protocol over TCP on the loopback interface: registers, memory, breakpoints, step, continue,
// interrupt, and `monitor reset`.

#pragma once

#include "cortex_m3.h"
#include <cstdint>
#include <functional>
#include <string>

class GdbStub {
public:
    // Functions of the program that the debugger controls. `run` returns when the processor stops
    // or when the simulation has ended; in the second case isOver() returns true afterwards.
    // `describe` returns the answer to `monitor info`.
    struct Target {
        CortexM3& cpu;
        std::function<CortexM3::Stop(bool singleStep)> run;
        std::function<void()> reset;
        std::function<bool()> isOver;
        std::function<std::string()> describe;
        // Goes back by one instruction (if `singleStep` is true) or to the last breakpoint. `back`
        // is empty if going back is not supported. `back` returns only if no earlier place
        // exists; otherwise another process continues, in which `run` returns.
        std::function<void(bool singleStep)> back = nullptr;
        // Returns "begin" or "end" if a reversible run has reached the beginning or the end of its
        // recording; otherwise returns "".
        std::function<std::string()> edge = [] { return ""; };
        // called after the debugger has written a register or memory
        std::function<void()> changed = [] {};
    };
    // Listens on 127.0.0.1; port 0 selects a free one. Throws std::system_error if the port is
    // taken.
    explicit GdbStub(uint16_t port);
    ~GdbStub();
    GdbStub(const GdbStub&) = delete;
    GdbStub& operator=(const GdbStub&) = delete;
    uint16_t port() const { return port_; }

    // Waits for a debugger while `mayWait` returns true, and executes its commands. Disconnects a
    // peer that does not use GDB's protocol. Returns true if the program must continue. Returns
    // false if the debugger has killed the program, the simulation has ended, or no debugger has
    // connected.
    bool serve(const Target& target, const std::function<bool()>& mayWait);
    // Returns true if the running processor must stop, because the debugger has sent Ctrl-C or has
    // disconnected, or because another debugger is waiting.
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
