// SPDX-License-Identifier: MIT
//
// instruction: a Thumb-2 instruction for the CPU model: its length, its cycles, whether it stops;
// by the tables of the ARMv7-M Architecture Reference Manual, chapter A5. Loads take 2 cycles even
// where the pipeline would hide one; divisions and long products take the middle of the range that
// the TRM gives, for the real ones depend on their operands.

#pragma once

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

inline unsigned ones(unsigned value) {
    return static_cast<unsigned>(__builtin_popcount(value));
}

inline Instruction narrowInstruction(uint16_t op) {
    Instruction i;
    auto takes = [&](unsigned cycles) {
        i.cycles = static_cast<uint8_t>(cycles);
        return i;
    };
    if ((op & 0xFF00) == 0xBF00) { // IT and hints
        if (op & 0xF) {
            i.kind = Instruction::If;
            i.conditional = static_cast<uint8_t>(4 - __builtin_ctz(op & 0xF));
        } else if (op == 0xBF30) {
            i.kind = Instruction::Sleep;
        } else if (op == 0xBF20 || op == 0xBF40) {
            i.kind = Instruction::Refused;
        }
        return i;
    }
    if ((op & 0xFFE8) == 0xB660) { // CPS
        i.kind = Instruction::Masks;
        return i;
    }
    if ((op & 0xF600) == 0xB400) // PUSH, POP
        return takes(1 + ones(op & 0x1FF));
    switch (op >> 12) {
    case 4:
        return takes(op & 0x0800 ? 2 : 1); // LDR literal
    case 5:
        return takes(2); // register offset
    case 6:
    case 7:
    case 8:
    case 9:
        return takes(op & 0x0800 ? 2 : 1); // immediate offset: a store is buffered
    case 12:
        return takes(1 + ones(op & 0xFF)); // LDM, STM
    default:
        return i;
    }
}

inline unsigned wideCycles(uint16_t first, uint16_t second) {
    if ((first & 0xFE40) == 0xE800) // LDM, STM
        return 1 + ones(second);
    if ((first & 0xFFF0) == 0xE8D0 && (second & 0xFFE0) == 0xF000) // TBB, TBH
        return 2;
    if ((first & 0xFE40) == 0xE840) // LDRD, STRD; exclusive
        return (first & 0x0120) ? 3 : 2;
    if ((first & 0xFE00) == 0xF800) { // one register
        bool load = first & 0x0010, registerOffset = !(first & 0x0080) && !(second & 0x0800);
        return load || registerOffset ? 2 : 1;
    }
    if ((first & 0xFF80) == 0xFB00) // MUL; MLA, MLS
        return second >> 12 == 15 ? 1 : 2;
    if ((first & 0xFF80) == 0xFB80) // SMULL, UMULL 3..5; SDIV, UDIV 2..12; SMLAL, UMLAL 4..7
        return (first & 0x0070) == 0x10 || (first & 0x0070) == 0x30 ? 7 : first & 0x0040 ? 6 : 4;
    return 1;
}

// `first` and `second` are the halfwords at the instruction's address and behind it.
inline Instruction decodeInstruction(uint16_t first, uint16_t second) {
    if (first >> 11 < 0x1D)
        return narrowInstruction(first);
    Instruction i;
    i.bytes = 4;
    i.cycles = static_cast<uint8_t>(wideCycles(first, second));
    if ((first & 0xFFE0) == 0xF380 && (second & 0xD000) == 0x8000) { // MSR
        i.kind = Instruction::Masks;
        i.cycles = 2;
    }
    if (first == 0xF3BF && (second & 0xFFE0) == 0x8F40)
        i.kind = Instruction::Barrier;
    return i;
}
