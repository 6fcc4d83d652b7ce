// SPDX-License-Identifier: MIT
//
// app_paper: selects the program of the paper's Figure 5 as the firmware of a simulator.

#include "uav_machine.h"
#include <stdexcept>

extern "C" {
#include "paper.h"
#include "uav.h"
}

UavMachine::Firmware simulatedFirmware(const std::vector<uint8_t>& modemKey, bool isSecure) {
    if (!modemKey.empty() || isSecure)
        throw std::runtime_error(
            "--key and --modem-key are not possible: the paper's firmware does not encrypt");
    return {PAPER_start, UAV_irqHandler, [] { return PAPER_irqEnabled() != 0; }};
}
