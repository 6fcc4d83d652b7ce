// SPDX-License-Identifier: MIT
//
// app_hang: selects a firmware with an interrupt routine that does not end, for hang.sh.

#include "uav_machine.h"

// Computes without end; its name appears in the simulator's message.
extern "C" __attribute__((noinline)) void computesWithoutEnd() {
    for (volatile unsigned work = 0;; work = work + 1) {
    }
}

UavMachine::Firmware simulatedFirmware(const std::vector<uint8_t>&, bool) {
    UavMachine::Firmware firmware;
    firmware.irqHandler = [] {
        computesWithoutEnd();
        asm volatile(""); // no tail call
    };
    return firmware;
}
