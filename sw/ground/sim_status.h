// SPDX-License-Identifier: MIT
//
// sim_status: counters of a running simulation, in a file that programs on the ground map.
// Little-endian.
//
// A program may keep step with simulated time (clock.h). Time then stands still while the program
// works, and until it has read what its serial port was given.

#pragma once

#include <cstdint>
#include <cstring>

constexpr char simMagic[8] = "ICESOC1";

struct SimStatus {
    char magic[8];      // simMagic
    uint64_t ns;        // simulated time
    uint64_t cycles;    // of the fabric's clock
    uint64_t bytesUp;   // payload on the air, ground to UAV
    uint64_t bytesDown; // the same, UAV to ground
    uint64_t packets, lost;
    uint64_t wallNs; // since the start, without sleep: speed = cycles / wallNs
    // Registers as the processor last wrote or read them, [slot * 16 + word]: a look here disturbs
    // nothing.
    uint32_t registers[1024];
    uint8_t seen[1024]; // 0: never, 1: read, 2: written
    // Keeping step. The simulator writes:
    char device[64];   // the serial port of the ground's modem
    uint64_t toGround; // session of the keeper, and bytes given to the port since
    uint64_t carried;  // of fromGround, what the line has carried
    // The program writes:
    uint64_t keeper;     // who keeps step: process id in the low 32 bits; 0: nobody
    uint64_t untilNs;    // it sleeps until then; 0: it works
    uint64_t taken;      // bytes that it has read; all ones: it does not want to read now
    uint64_t fromGround; // bytes it has written
};

inline bool isSimStatus(const void* bytes) {
    return std::memcmp(bytes, simMagic, sizeof simMagic) == 0;
}

// Upper 24 bits of toGround, from `keeper`: bytes given to the one before do not count for the
// next.
constexpr int simCountBits = 40;
constexpr uint64_t simCount(uint64_t toGround) {
    return toGround & ((uint64_t(1) << simCountBits) - 1);
}
constexpr uint64_t simSession(uint64_t keeper) {
    return keeper * 0x9E3779B97F4A7C15u >> simCountBits << simCountBits;
}
