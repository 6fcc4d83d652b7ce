// SPDX-License-Identifier: MIT
//
// keep_step: accesses the members of SimStatus with which a program keeps step with simulated time.
//
// Simulated time stops while the program works. It also stops until the program has read all
// bytes that its serial port has received.

#pragma once

#include "sim_status.h" // generated from sim_status.toml

#include <cstdint>
#include <cstring>

inline bool isSimStatus(const void* bytes) {
    return std::memcmp(bytes, SIM_MAGIC, sizeof SIM_MAGIC) == 0;
}

// The upper 24 bits of toGround are the number of the session, so that bytes given to one program
// are not counted for the next program.
constexpr int simCountBits = 40;
constexpr uint64_t simCount(uint64_t toGround) {
    return toGround & ((uint64_t(1) << simCountBits) - 1);
}
constexpr uint64_t simSession(uint64_t keeper) {
    return keeper * 0x9E3779B97F4A7C15u >> simCountBits << simCountBits;
}
