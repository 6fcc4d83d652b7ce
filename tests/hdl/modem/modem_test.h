// SPDX-License-Identifier: MIT
//
// modem_test: the fixtures of the modem controller's tests: the XBee model at its pins.

#pragma once

#include "VModem.h"
#include "modem_rig.h"

class ModemTest : public ModemRig<VModem, 500> {
protected:
    static constexpr unsigned bitClocks = 18; // at 111,111 baud

    void ready() {
        power(quick());
        configure();
        takeEvents();
    }
};

// The end of one packet and the beginning of another in the same clock of a ring, and in those
// around it; some rounds, since the baud rate's ticks move against the bus.
class ModemRingsMeet : public ModemTest {
protected:
    static constexpr unsigned rounds = 4;
    void readyAtOnce() {
        ready();
        memory_.setStall(0);
    }
    void tickUntil(uint64_t cycle) {
        while (bench_.cycles() < cycle)
            bench_.tick();
    }
    Random random_{testSeed()};
};
