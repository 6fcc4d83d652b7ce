// SPDX-License-Identifier: MIT
//
// wave_window: the waveform that the environment requests: WAVE=file, WAVE_FROM and WAVE_TO in
// clocks.

#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

// Returns a number from the environment; `otherwise` if the variable is not set.
inline uint64_t environmentNumber(const char* variable, uint64_t otherwise) {
    const char* text = std::getenv(variable);
    return text && *text ? std::strtoull(text, nullptr, 0) : otherwise;
}

struct WaveWindow {
    std::string file; // empty: no waveform
    uint64_t from = environmentNumber("WAVE_FROM", 0), to = environmentNumber("WAVE_TO", ~0ull);

    WaveWindow() {
        if (const char* name = std::getenv("WAVE"))
            file = name;
    }
};
