// SPDX-License-Identifier: MIT
//
// app_hang: selects firmware with an interrupt routine that never ends, for hang.sh.

#include "uav_machine.h"

// Computes without end. The simulator's message must contain the name of this function.
extern "C" __attribute__((noinline)) void computesWithoutEnd() {
    for (volatile unsigned work = 0;; work = work + 1) {
    }
}

UavMachine::Firmware simulatedFirmware(const std::vector<uint8_t>&, bool) {
    UavMachine::Firmware firmware;
    firmware.irqHandler = [] {
        computesWithoutEnd();
        asm volatile(""); // prevents a tail call
    };
    return firmware;
}
