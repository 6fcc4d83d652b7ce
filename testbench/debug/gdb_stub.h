// SPDX-License-Identifier: MIT
//
// gdb_stub: lets a debugger on this machine control a CortexM3. It serves GDB's remote serial
// protocol over TCP on the loopback interface: registers, memory, breakpoints, step, continue,
// interrupt, and `monitor reset`.

#pragma once

#include "cortex_m3.h"
#include <cstdint>
#include <functional>
#include <string>

class GdbStub {
public:
    // What the debugger controls. `run` returns when the processor stops or when the simulation has
    // ended; isOver() is true after the latter. `describe` returns the answer to `monitor info`.
    struct Target {
        CortexM3& cpu;
        std::function<CortexM3::Stop(bool singleStep)> run;
        std::function<void()> reset;
        std::function<bool()> isOver;
        std::function<std::string()> describe;
        // Goes back by one instruction (`singleStep`) or to the last breakpoint; empty if not
        // supported. Returns if there is nothing before; otherwise the process that continues
        // returns from `run`.
        std::function<void(bool singleStep)> back = nullptr;
        // Returns the end of the recording that a reversible run has reached: "begin", "end", or
        // "".
        std::function<std::string()> edge = [] { return ""; };
        // called after the debugger has written registers or memory
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
    // peer that does not speak the protocol. Returns true if the program must continue. Returns
    // false if the debugger has killed the program, the simulation has ended, or no debugger has
    // connected.
    bool serve(const Target& target, const std::function<bool()>& mayWait);
    // Returns true if the running processor must stop: the debugger has sent Ctrl-C or
    // disconnected, or another debugger waits.
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
