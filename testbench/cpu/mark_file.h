// SPDX-License-Identifier: MIT
//
// mark_file: a waveform (VCD, nanoseconds) of what the processor is at: exception, task, sleep.
// GTKWave shows it on the same time axis as a waveform of the RTL.

#ifndef MARK_FILE_H
#define MARK_FILE_H

#include "stm32f2.h"
#include <fstream>

class MarkFile {
public:
    // Listens to `stm32` as long as it lives. `now` is simulated time in ns.
    MarkFile(const std::string& path, Stm32F2& stm32, std::function<uint64_t()> now);
    ~MarkFile();
    MarkFile(const MarkFile&) = delete;
    MarkFile& operator=(const MarkFile&) = delete;

private:
    void at();
    void mark(char id, uint32_t value, unsigned bits);
    void name(char id, const std::string& text);
    void taskMayHaveChanged();

    std::ofstream file_;
    Stm32F2& stm32_;
    std::function<uint64_t()> now_;
    CortexM3::Listener before_;
    uint64_t time_ = ~0ull;
    uint32_t task_ = ~0u, taskAddress_ = 0;
};

#endif
