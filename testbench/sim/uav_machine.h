// SPDX-License-Identifier: MIT
//
// uav_machine: runs firmware that was built for the host on a SocModel, and provides bus accesses,
// interrupts and the tick. A table of entry points selects the firmware; the default is the UAV's
// application.

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
    // Entry points of the firmware, as in uav.h: one is called at boot and creates the tasks, the
    // other is called for each interrupt of the FPGA.
    struct Firmware {
        std::function<void(const FSMC_Port*, void*)> start = [](const FSMC_Port* port, void* soc) {
            if (UAV_start(port, soc) == UAV_NO_KEY)
                throw std::runtime_error("the vehicle has no key: expected --key FILE, or --open "
                                         "for a flight without a key");
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

    // Makes the firmware clock faster than the fabric clock by the factor `times`. This
    // shortens periods in which the firmware only waits for time-outs. The modem keeps its speed,
    // so it is too slow for the firmware during this time.
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

// Boots the UAV's application and flies until the script has ended or the simulated time reaches
// `seconds`. Returns true if the script has ended.
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

// Returns the firmware that the simulator runs on the host; each program that links sim_main
// defines this function. `modemKey` is the modem's AES key of 16 bytes, or empty. `isSecure` is
// true if the link has a key; the function throws an exception if the firmware then cannot encrypt.
UavMachine::Firmware simulatedFirmware(const std::vector<uint8_t>& modemKey, bool isSecure);
