// SPDX-License-Identifier: MIT
//
// instruction: decodes a Thumb-2 instruction as far as the CPU model needs it.

#pragma once

#include <cstdint>

// A decoded Thumb-2 instruction: length, cycles, and effects that matter to the CPU model. Source:
// the tables of the ARMv7-M Architecture Reference Manual, chapter A5. A load takes 2 cycles here
// even if the pipeline would hide one of them. Divisions and long products take the middle of the
// range in the TRM, because the real number depends on their operands.
struct Instruction {
    enum Kind : uint8_t {
        Plain,
        If,        // IT; the model executes it and the next `conditional` instructions as one unit
        Sleep,     // WFI
        Barrier,   // DSB, DMB: wait for the write buffer
        Masks,     // CPS or MSR; may change PRIMASK, BASEPRI, FAULTMASK or CONTROL
        Exclusive, // LDREX; opens the exclusive monitor
        Refused    // WFE, SEV, YIELD: not supported, because the model has no event register
    };
    static constexpr uint8_t noBase = 15;
    uint8_t bytes = 2; // length, bytes: 2 or 4
    // cycles by table 3-1 of the Cortex-M3 TRM r2p1, without the refill after a taken branch
    uint8_t cycles = 1;
    uint8_t conditional = 0; // number of conditional instructions after an IT, 1..4
    Kind kind = Plain;
    // For checking the alignment of an access (A3.2.1): number of the base register, and mask of
    // the address bits that must be zero.
    uint8_t base = noBase, alignment = 0;
    uint8_t special = 0; // number of the special register of an MSR (SYSm)
};

// Cycles for refilling the pipeline after a taken branch (P in the TRM, 1 to 3).
constexpr unsigned refillCycles = 2;

// Decodes the instruction in `first`, the halfword at its address, and `second`, the next halfword.
Instruction decodeInstruction(uint16_t first, uint16_t second);
