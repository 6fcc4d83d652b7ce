// SPDX-License-Identifier: MIT
//
// fsmc_pins: the pins between the FSMC and the design, and the functions that clock the design.

#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>

// The pins between processor and FPGA. The bench sets the design's side.
struct FsmcPins {
    uint32_t a = 0; // halfword address, 25 bits; multiplexed: only bits 24..16 are meant
    uint16_t d = 0; // driven by the processor while dOut
    bool dOut = false;
    uint8_t neN = 0xF, nblN = 3; // NE1 in bit 0 .. NE4 in bit 3
    bool noeN = true, nweN = true, nadvN = true;
    // driven by the design
    uint16_t dFromDesign = 0;
    bool dDriven = false, nwaitN = true;
};

// Port to the design: `tick` clocks it once with the current pins; `settle` shows it pins that
// changed between two clock edges. Both update the pins that the design drives. `passQuiet` skips
// at most the given clocks and ns while the design is idle, and returns the number of clocks
// skipped; a design without this function is never idle.
struct FsmcDesign {
    std::function<void()> tick, settle;
    std::function<uint64_t(uint64_t clocks, uint64_t ns)> passQuiet = nullptr;
};

class FsmcError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};
