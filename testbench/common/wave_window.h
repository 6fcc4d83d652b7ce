// SPDX-License-Identifier: MIT
//
// wave_window: reads from the environment which waveform to record: WAVE is the file, WAVE_FROM and
// WAVE_TO are clocks.

#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

// Returns an environment variable as a number, or `otherwise` if the variable is not set.
inline uint64_t environmentNumber(const char* variable, uint64_t otherwise) {
    const char* text = std::getenv(variable);
    return text && *text ? std::strtoull(text, nullptr, 0) : otherwise;
}

struct WaveWindow {
    std::string file; // file for the waveform; empty if no waveform is recorded
    uint64_t from = environmentNumber("WAVE_FROM", 0), to = environmentNumber("WAVE_TO", ~0ull);

    WaveWindow() {
        if (const char* name = std::getenv("WAVE"))
            file = name;
    }
};
