// SPDX-License-Identifier: MIT
//
// hw_map: which register of a slot each value of a [":hw"] interface is in (docs/hw-mapping.md).

#ifndef HW_MAP_H
#define HW_MAP_H

#include "ast.h"
#include <string>
#include <vector>

namespace hw {

constexpr unsigned firstWord = 3, slotWords = 16; // ID, EVENT and MASK come before
constexpr unsigned control = 3, status = 4;
constexpr unsigned mostOperations = 16, refusedLsb = 16, resetBit = 31;

// A scalar, or half of one of 64 bits: a field of a word, and bits of a port.
struct Piece {
    Type type;
    std::string name; // a_x: of parameter a, member x
    std::string c;    // as the servant's function has it: a->x
    unsigned lsb = 0, width = 0;
    unsigned portLsb = 0, portWidth = 0;
};

struct Word {
    unsigned number = 0;
    std::string name; // ADD_IN0
    bool isOut = false;
    std::vector<Piece> pieces;
    unsigned width() const { return pieces.back().lsb + pieces.back().width; }
};

struct Call {
    const Operation* operation = nullptr;
    std::string name; // snake_case
    unsigned bit = 0; // in CONTROL, STATUS, EVENT and MASK
    bool isLong = false;
    unsigned timeout = 0; // milliseconds
    std::vector<Word> words;
};

struct Block {
    const Declaration* interface = nullptr;
    std::string name; // snake_case
    unsigned type = 0, version = 0;
    std::vector<Call> calls;

    bool hasLong() const { return events() != 0; }
    unsigned events() const; // bits of EVENT that are used, from bit 0
    // Every word between CONTROL and the slot's end, by number.
    std::vector<const Word*> words() const;
};

// All hardware interfaces of the unit's main file; errors are in `diagnostics`.
std::vector<Block> mapHardware(const Unit& unit, Diagnostics& diagnostics);

std::string snakeCase(const std::string& name);
std::string upperCase(std::string text);

} // namespace hw

#endif
