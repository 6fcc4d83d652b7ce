// SPDX-License-Identifier: MIT
//
// instruction: determines the length, the cycles and the kind of a Thumb or Thumb-2 instruction.

#include "instruction.h"

namespace {

unsigned ones(unsigned value) {
    return static_cast<unsigned>(__builtin_popcount(value));
}

Instruction narrowInstruction(uint16_t op) {
    Instruction i;
    auto takes = [&](unsigned cycles) {
        i.cycles = static_cast<uint8_t>(cycles);
        return i;
    };
    if ((op & 0xFF00) == 0xBF00) { // the IT instruction and the hints (NOP, YIELD, WFE, WFI, SEV)
        if (op & 0xF) {
            i.kind = Instruction::If;
            i.conditional = static_cast<uint8_t>(4 - __builtin_ctz(op & 0xF));
        } else if (op == 0xBF30) {
            i.kind = Instruction::Sleep;
        } else if (op == 0xBF10 || op == 0xBF20 || op == 0xBF40) {
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
        return takes(2); // load or store with a register as offset
    case 6:
    case 7:
    case 8:
    case 9:
        // load or store with an immediate offset; a store takes one cycle, since it
        // goes to the write buffer
        return takes(op & 0x0800 ? 2 : 1);
    case 12: // LDM, STM
        i.base = static_cast<uint8_t>(op >> 8 & 7);
        i.alignment = 3;
        return takes(1 + ones(op & 0xFF));
    default:
        return i;
    }
}

unsigned wideCycles(uint16_t first, uint16_t second) {
    if ((first & 0xFE40) == 0xE800) // LDM, STM
        return 1 + ones(second);
    if ((first & 0xFFF0) == 0xE8D0 && (second & 0xFFE0) == 0xF000) // TBB, TBH
        return 2;
    if ((first & 0xFE40) == 0xE840) // LDRD, STRD, and exclusive accesses
        return (first & 0x0120) ? 3 : 2;
    if ((first & 0xFE00) == 0xF800) { // load or store of one register
        bool load = first & 0x0010, registerOffset = !(first & 0x0080) && !(second & 0x0800);
        return load || registerOffset ? 2 : 1;
    }
    if ((first & 0xFF80) == 0xFB00) // MUL takes 1 cycle, MLA and MLS take 2
        return second >> 12 == 15 ? 1 : 2;
    // cycles by the TRM: SMULL, UMULL 3..5; SDIV, UDIV 2..12; SMLAL, UMLAL 4..7
    if ((first & 0xFF80) == 0xFB80)
        return (first & 0x0070) == 0x10 || (first & 0x0070) == 0x30 ? 7 : first & 0x0040 ? 6 : 4;
    return 1;
}

// Sets the alignment that LDM, STM, LDRD, STRD, LDREX, STREX and similar instructions demand. Only
// the base register has to be checked at run time, because the offsets of these instructions are
// multiples of the alignment and SP is always aligned.
void decodeAligned(Instruction& i, uint16_t first, uint16_t second) {
    const bool isTable = (first & 0xFFF0) == 0xE8D0 && (second & 0xFFE0) == 0xF000; // TBB, TBH
    const bool isMultiple = !(first & 0x0040), isDouble = !isMultiple && (first & 0x0120);
    const bool isShort = !isMultiple && !isDouble && (first & 0x0080); // byte, halfword
    if (isTable)
        return;
    if (!isMultiple && !isDouble && (first & 0x0010))
        i.kind = Instruction::Exclusive;
    const uint8_t base = first & 0xF;
    i.alignment = !isShort ? 3 : (second & 0xF0) == 0x50 ? 1 : 0;
    i.base = base == 13 ? Instruction::noBase : base;
}

} // namespace

Instruction decodeInstruction(uint16_t first, uint16_t second) {
    if (first >> 11 < 0x1D)
        return narrowInstruction(first);
    Instruction i;
    i.bytes = 4;
    i.cycles = static_cast<uint8_t>(wideCycles(first, second));
    if ((first & 0xFFE0) == 0xF380 && (second & 0xD000) == 0x8000) { // MSR
        i.kind = Instruction::Masks;
        i.cycles = 2;
        i.special = static_cast<uint8_t>(second);
    }
    if (first == 0xF3AF && (second & 0xFF00) == 0x8000) // hints
        i.kind = (second & 0xFF) == 3                      ? Instruction::Sleep
                 : (second & 0xFF) && (second & 0xFF) <= 4 ? Instruction::Refused
                                                           : Instruction::Plain;
    // LDRT, STRT and similar instructions; if the base is PC, the instruction is a load of a
    // literal instead
    if ((first & 0xFE80) == 0xF800 && (second & 0x0F00) == 0x0E00 && (first & 0xF) != 15)
        i.kind = Instruction::Unprivileged;
    if ((first & 0xFE00) == 0xE800)
        decodeAligned(i, first, second);
    if (first == 0xF3BF && (second & 0xFFE0) == 0x8F40)
        i.kind = Instruction::Barrier;
    return i;
}
