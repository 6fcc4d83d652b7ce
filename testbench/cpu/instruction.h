// SPDX-License-Identifier: MIT
//
// instruction: a Thumb-2 instruction for the CPU model: its length, its cycles, whether it stops.

#ifndef INSTRUCTION_H
#define INSTRUCTION_H

#include <cstdint>

struct Instruction {
    enum Kind : uint8_t {
        Plain,
        If,      // IT: the `conditional` instructions behind it are one unit with it
        Sleep,   // WFI
        Barrier, // DSB, DMB: wait for the write buffer
        Masks,   // CPS or MSR: may change PRIMASK, BASEPRI or FAULTMASK
        Refused  // WFE, SEV: the model has no event register
    };
    uint8_t bytes = 2;       // 2 or 4
    uint8_t cycles = 1;      // Cortex-M3 TRM r2p1, table 3-1, without the refill of a taken branch
    uint8_t conditional = 0; // of If: 1..4
    Kind kind = Plain;
};

// Cycles of refilling the pipeline after a taken branch (TRM: P is 1..3).
constexpr unsigned refillCycles = 2;

// `first` and `second` are the halfwords at the instruction's address and behind it.
Instruction decodeInstruction(uint16_t first, uint16_t second);

#endif
