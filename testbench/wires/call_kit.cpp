// SPDX-License-Identifier: MIT
//
// call_kit: connects a ground station to the vehicle by a cable, and calls it.

#include "call_kit.h"
#include "board_faults.h"
#include "ground.h"
#include "m3_machine.h"

std::string callOverCable(const std::string& firmware, const std::vector<WireFault>& faults,
                          double seconds) {
    std::string text = "STEP call: the firmware answers a call over a cable in the modem's place\n";
    GroundAndChip flight(1);
    plantFaults(flight.soc, faults);
    flight.ground.plugInto(flight.soc);
    flight.soc.reset(true);
    auto script = flight.ground.pinging(1);
    bool isAnswered = false;
    M3Machine::Config config;
    config.firmware = firmware;
    config.isWired = true;
    std::string stopped = "no answer within " + std::to_string(static_cast<int>(seconds)) + " s";
    M3Machine machine(flight.soc, config, [&] {
        isAnswered = isAnswered || script();
        return !isAnswered && flight.within(seconds);
    });
    try {
        machine.run();
    } catch (const std::exception& e) { // an access that never ends
        stopped = e.what();
    }
    if (isAnswered)
        return text +
               "PASS call: answered after ms: " + std::to_string(flight.soc.now() / 1'000'000) +
               "\nEND 0\n";
    return text + "FAIL call MODEM_TXD-MODEM_RXD silent: " + stopped +
           "; check: JUMPER_WIRED, the cable's TXD and RXD (crossed), RTS and CTS, its rate of "
           "111111 baud\nEND 1\n";
}
