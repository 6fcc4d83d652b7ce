// SPDX-License-Identifier: MIT
//
// keep_step: the part of SimStatus with which a program keeps step with simulated time.
//
// Simulated time stops while the program works, and until the program has read all bytes that its
// serial port has received.

#pragma once

#include "sim_status.h" // generated from sim_status.toml

#include <cstdint>
#include <cstring>

inline bool isSimStatus(const void* bytes) {
    return std::memcmp(bytes, SIM_MAGIC, sizeof SIM_MAGIC) == 0;
}

// toGround has a session in its upper 24 bits, so that bytes given to one keeper do not count for
// the next.
constexpr int simCountBits = 40;
constexpr uint64_t simCount(uint64_t toGround) {
    return toGround & ((uint64_t(1) << simCountBits) - 1);
}
constexpr uint64_t simSession(uint64_t keeper) {
    return keeper * 0x9E3779B97F4A7C15u >> simCountBits << simCountBits;
}
