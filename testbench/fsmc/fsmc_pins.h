// SPDX-License-Identifier: MIT
//
// fsmc_pins: the pins between the FSMC and the design, and the functions that run the design.

#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>

// Levels of the pins between processor and FPGA. The test bench sets the pins that the design
// drives.
struct FsmcPins {
    uint32_t a = 0; // halfword address, 25 bits; with a multiplexed bus, only bits 24..16 are valid
    uint16_t d = 0; // data that the processor drives while dOut is true
    bool dOut = false;
    uint8_t neN = 0xF, nblN = 3; // NE1 in bit 0 to NE4 in bit 3
    bool noeN = true, nweN = true, nadvN = true;
    // data that the design drives
    uint16_t dFromDesign = 0;
    bool dDriven = false, nwaitN = true;
};

// Connection to the design. `tick` runs one clock with the current pins. `settle` updates the
// design after pins have changed between two clock edges. Both functions also update the pins that
// the design drives. `passQuiet` skips clocks while the design is idle, at most the given numbers
// of clocks and ns, and returns the number of skipped clocks. If `passQuiet` is empty, no clocks
// are skipped.
struct FsmcDesign {
    std::function<void()> tick, settle;
    std::function<uint64_t(uint64_t clocks, uint64_t ns)> passQuiet = nullptr;
};

class FsmcError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};
