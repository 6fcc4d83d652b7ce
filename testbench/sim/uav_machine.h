// SPDX-License-Identifier: MIT
//
// uav_machine: runs the firmware's host build on a SocModel: bus accesses, interrupts, the tick. A
// table of entrances selects the firmware, by default the UAV's application.

#pragma once

#include "os_host.h"
#include "simulated_board.h"
#include "soc_model.h"
#include <functional>
#include <stdexcept>
#include <vector>

extern "C" {
#include "fsmc.h"
#include "uav.h"
}

class UavMachine {
public:
    // The entrances, as in uav.h: one is called at boot (it creates the tasks), one at the FPGA's
    // interrupt.
    struct Firmware {
        std::function<void(const FSMC_Port*, void*)> start = [](const FSMC_Port* port, void* soc) {
            if (UAV_start(port, soc) == UAV_NO_KEY)
                throw std::runtime_error("the vehicle was neither given a key nor opened");
        };
        std::function<void()> irqHandler = UAV_irqHandler;
        std::function<bool()> irqEnabled = [] { return UAV_irqEnabled() != 0; };
    };

    // `poll` is called about once per simulated millisecond; when it returns false, run() ends.
    UavMachine(SocModel& soc, std::function<bool()> poll)
        : UavMachine(soc, std::move(poll), Firmware()) {}
    UavMachine(SocModel& soc, std::function<bool()> poll, Firmware firmware);

    // Boots the firmware and runs it until `poll` returns false; exceptions of the models
    // propagate.
    void run();

    SimulatedBoard board; // board of the UAV's application

    // Runs the clock of the firmware this many times as fast as the clock of the fabric, to shorten
    // periods in which only time-outs of the firmware run. Meanwhile the modem is too slow for it.
    void hurry(unsigned times);

private:
    void idle();
    bool pending() const;
    void serve();

    SocModel& soc_;
    std::function<bool()> poll_;
    Firmware firmware_;
    uint64_t nextTick_ = 0, tickCycles_;
};

// Boots the UAV's application and flies until the script is done, or until this simulated second.
// Returns whether it is done.
inline bool flies(
    SocModel& soc, const std::function<bool()>& script, double until,
    const std::function<void(UavMachine&)>& prepare = [](UavMachine&) {}) {
    bool done = false;
    UavMachine machine(soc, [&] {
        done = script();
        return !done && static_cast<double>(soc.now()) < until * 1e9;
    });
    prepare(machine);
    machine.run();
    return done;
}

// The firmware that the simulator runs on the host; each program that links sim_main defines it.
// `modemKey`: 16 bytes of the modem's AES key, or empty; `isSecure`: the link has a key. Throws if
// the firmware cannot encrypt.
UavMachine::Firmware simulatedFirmware(const std::vector<uint8_t>& modemKey, bool isSecure);
