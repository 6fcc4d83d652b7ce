// SPDX-License-Identifier: MIT
//
// status: counters of a running simulation, in a file that other programs map. Little-endian.

#ifndef STATUS_H
#define STATUS_H

#include <cstdint>

struct SimStatus {
    char magic[8];         // "ICESOC1\0"
    uint64_t ns;           // simulated time
    uint64_t cycles;       // of the fabric's clock
    uint64_t bytesUp;      // payload on the air, ground to UAV
    uint64_t bytesDown;    // UAV to ground
    uint64_t packets, lost;
    uint64_t wallNs;       // since the start, sleeping not counted: speed = cycles / wallNs
    // Registers as the processor last wrote or read them, [slot * 16 + word]; looking disturbs nothing.
    uint32_t registers[1024];
    uint8_t seen[1024];    // 0: never, 1: read, 2: written
};

#endif
