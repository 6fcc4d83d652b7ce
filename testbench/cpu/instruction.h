// SPDX-License-Identifier: MIT
//
// instruction: decodes those properties of a Thumb-2 instruction that the CPU model needs.

#pragma once

#include <cstdint>

// A decoded Thumb-2 instruction: its length, its cycles, and its effects on the CPU model. Source:
// the tables of the ARMv7-M Architecture Reference Manual, chapter A5. A load always takes 2 cycles
// here, although the pipeline can hide one of them. The real duration of a division or long product
// depends on its operands; this model uses the middle of the TRM's range.
struct Instruction {
    enum Kind : uint8_t {
        Plain,
        // IT; the model executes IT together with the next `conditional` instructions, without an
        // interruption
        If,
        Sleep,       // WFI
        Barrier,     // DSB or DMB; waits until the write buffer is empty
        Masks,       // CPS or MSR; may change PRIMASK, BASEPRI, FAULTMASK or CONTROL
        Exclusive,   // LDREX; opens the exclusive monitor
        Refused,     // WFE, SEV, YIELD: not supported, because the model has no event register
        Unprivileged // LDRT, STRT and similar instructions: not supported
    };
    static constexpr uint8_t noBase = 15;
    uint8_t bytes = 2; // length, bytes: 2 or 4
    // cycles by table 3-1 of the Cortex-M3 TRM r2p1, without the refill after a taken branch
    uint8_t cycles = 1;
    uint8_t conditional = 0; // number of conditional instructions after an IT, 1..4
    Kind kind = Plain;
    // number of the base register, and mask of the address bits that must be zero, for the
    // alignment check of an access (A3.2.1)
    uint8_t base = noBase, alignment = 0;
    uint8_t special = 0; // number (SYSm) of the special register that an MSR accesses
};

// Cycles for refilling the pipeline after a taken branch (P in the TRM, 1 to 3).
constexpr unsigned refillCycles = 2;

// Decodes the instruction in `first`, the halfword at its address, and `second`, the next halfword.
Instruction decodeInstruction(uint16_t first, uint16_t second);
