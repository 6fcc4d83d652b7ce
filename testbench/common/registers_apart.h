// SPDX-License-Identifier: MIT
//
// registers_apart: values written to two registers of a third-party core are read back from both,
// as far as they can be written. It finds a lost write, and an address whose words are taken for
// bytes or bytes for words: then neighbours are one register. A core with fewer registers than
// addresses repeats them at a distance.

#ifndef REGISTERS_APART_H
#define REGISTERS_APART_H

#include "core_slot.h"
#include <cstdlib>
#include <iostream>
#include <vector>
extern "C" {
#include "hw_registers.h"
}

template <class Module, size_t N>
void expectRegistersApart(CoreSlot<Module>& slot, const Hw_Register (&table)[N],
                          unsigned pageWord) {
    struct Register {
        const Hw_Register& is;
        U32 value; // differs from those of the others
    };
    auto access = [&](bool isWrite, const Register& r) {
        slot.bus_.write(pageWord, static_cast<U32>(r.is.page));
        return slot.bus_.transfer(isWrite, static_cast<unsigned>(r.is.word), r.value);
    };
    std::vector<Register> hold;
    for (const Hw_Register& is : table) {
        if (is.word < 8)
            continue; // the slot's own
        const U32 mask = is.width < 32 ? (1u << is.width) - 1 : ~0u;
        const Register r{is, (0x5A5A0001u + 0x01010101u * static_cast<U32>(&is - table)) & mask};
        const bool refused = access(true, r).error;
        const auto answer = access(false, r);
        if (!refused && !answer.error && (answer.data & mask) == r.value)
            hold.push_back(r);
        else
            std::cout << is.name.data << " cannot be written and read: 0x" << std::hex << r.value
                      << " was written, " << (answer.error ? "an error" : "0x")
                      << (answer.error ? 0 : answer.data & mask) << " read\n"
                      << std::dec;
    }
    for (const Register& r : hold)
        access(true, r);
    for (const Register& r : hold) {
        const U32 data = access(false, r).data;
        for (const Register& other : hold) {
            const auto distance = &other.is - &r.is;
            if (distance == 0 || other.value == r.value || data != other.value)
                continue;
            EXPECT_GT(std::abs(distance), 1)
                << r.is.name.data << " has what was written to " << other.is.name.data
                << ": does its address count words, or bytes? ADDRESS=words|bytes says it";
            std::cout << "the core has fewer registers: " << r.is.name.data << " is "
                      << other.is.name.data << " again\n";
        }
    }
    std::cout << hold.size() << " registers can be written and read\n";
}

#endif
