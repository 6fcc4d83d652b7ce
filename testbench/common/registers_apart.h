// SPDX-License-Identifier: MIT
//
// registers_apart: checks that each writable register of a third-party core keeps a separate value.
// This finds lost writes. It also finds a wrong address unit (words instead of bytes, or bytes
// instead of words), because two neighbouring addresses then access the same register. If a core
// has fewer registers than addresses, addresses at a regular distance may access the same register;
// this is not an error.
//
// For each register, the test prints a note that reports whether the value could be read back. It
// prints another note, with the names of the signals that change, if the core is active although
// nothing calls it (icesoc.regress.ctest prints notes).

#pragma once

#include "core_slot.h"
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>
extern "C" {
#include "hw_registers.h"
}

// Returns the slot's output idle_o, which is high if the clock of the slot may stop; returns false
// if the slot has no such output.
template <class Module> auto saysIdle(Module& top, int) -> decltype(bool(top.idle_o)) {
    return top.idle_o;
}
template <class Module> bool saysIdle(Module&, long) {
    return false;
}

// A signal in the state of a model; its name is its path in the slot. V<core>_slot_state.h lists
// the signals of a core; state_members.awk generates this file.
struct StateMember {
    template <class Root, class T>
    StateMember(const Root& root, const T& member, const char* name)
        : offset(reinterpret_cast<const char*>(&member) - reinterpret_cast<const char*>(&root)),
          size(sizeof member), path(name) {}
    std::ptrdiff_t offset;
    size_t size;
    const char* path;
};
template <class Root> std::vector<StateMember> stateOf(const Root&) {
    return {};
}

// Prints a note if the core is active although nothing calls it. In an idle core only counters
// should change: a simulated flight can then skip clocks (docs/simulation.md). The generated test
// includes the header that describes the state of the model.
template <class Module> void noteWhetherItRests(Bench<Module>& bench) {
    constexpr unsigned settling = 64, clocks = 1000, named = 3;
    const auto& state = *bench.top().rootp;
    const auto* now = reinterpret_cast<const unsigned char*>(&state);
    const std::vector<StateMember> members = stateOf(state);
    std::map<std::string, unsigned> movers; // number of clocks in which each signal changed
    for (unsigned i = 0; i < settling; ++i)
        bench.tick();
    unsigned moved = 0;
    for (unsigned i = 0; i < clocks; ++i) {
        const std::vector<unsigned char> before(now, now + sizeof state);
        bench.tick();
        moved += std::memcmp(before.data(), now, sizeof state) != 0;
        for (const StateMember& m : members)
            if (std::memcmp(before.data() + m.offset, now + m.offset, m.size) != 0)
                ++movers[m.path];
    }
    if (moved <= clocks / 10 || saysIdle(bench.top(), 0))
        return;
    std::vector<std::pair<unsigned, std::string>> most;
    for (const auto& [path, times] : movers)
        most.emplace_back(clocks - times, path); // sorts the most active signal first
    std::sort(most.begin(), most.end());
    std::string which;
    for (size_t i = 0; i < most.size() && i < named; ++i)
        which += (i ? ", " : " (most often ") + most[i].second;
    which += most.size() > named ? ", ...)" : most.empty() ? "" : ")";
    std::cout << "note: active in " << moved << " of " << clocks << " idle clocks" << which
              << ", so a flight evaluates each clock: about 2 to 5 million per second instead of "
              << "600 million. If the clock may stop between calls, give the core idle_o "
              << "(docs/hw-mapping.md#idle); otherwise make run CLK_HZ=2000000 is faster\n";
}

template <class Module, size_t N>
void expectRegistersApart(CoreSlot<Module>& slot, const Hw_Register (&table)[N],
                          unsigned pageWord) {
    struct Register {
        const Hw_Register& is;
        U32 value; // value written to the register; different for each register
    };
    auto access = [&](bool isWrite, const Register& r) {
        slot.bus_.write(pageWord, static_cast<U32>(r.is.page));
        return slot.bus_.transfer(isWrite, static_cast<unsigned>(r.is.word), r.value);
    };
    std::vector<Register> hold;
    for (const Hw_Register& is : table) {
        if (is.word < 8)
            continue; // words 0 to 7 of a slot are registers of the wrapper, not of the core
        const U32 mask = is.width < 32 ? (1u << is.width) - 1 : ~0u;
        const Register r{is, (0x5A5A0001u + 0x01010101u * static_cast<U32>(&is - table)) & mask};
        const bool refused = access(true, r).error;
        const auto answer = access(false, r);
        const bool holds = !refused && !answer.error && (answer.data & mask) == r.value;
        std::cout << "note: " << is.name.data << ": " << std::hex;
        if (holds)
            std::cout << "written and read back\n";
        else if (refused || answer.error)
            std::cout << "not read back: its " << (refused ? "write" : "read") << " is refused\n";
        else
            std::cout << "not read back: 0x" << r.value << " was written, 0x"
                      << (answer.data & mask) << " read\n";
        std::cout << std::dec;
        if (holds)
            hold.push_back(r);
    }
    if (hold.empty())
        std::cout << "note: no register keeps what is written: either all are write-only, or the "
                     "core is in reset because its reset has the other polarity\n";
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
                << ": set ADDRESS=words or ADDRESS=bytes, the unit of the core's address";
            std::cout << "note: " << r.is.name.data << " is " << other.is.name.data << " again\n";
        }
    }
}
