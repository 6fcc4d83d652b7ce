// SPDX-License-Identifier: MIT
//
// program_trace: the Cortex-M3 program's task, interrupt and function over time.
//
// They are three rows of text in WAVE.program.vcd where the environment asks for a waveform
// (wave_window.h), in the same unit of time as the RTL's: half a clock. join_waves.sh puts the two
// together. Functions are written from WAVE_FROM to WAVE_TO, tasks and interrupts a tenth of a
// second before, too.

#ifndef PROGRAM_TRACE_H
#define PROGRAM_TRACE_H

#include "stm32f2.h"
#include "wave_window.h"
#include <fstream>
#include <map>

class ProgramTrace {
public:
    // Listens to `stm32`, with the loaded program in its flash, for good. `clocks` of the fabric
    // have passed.
    ProgramTrace(Stm32F2& stm32, std::function<uint64_t()> clocks);
    ProgramTrace(const ProgramTrace&) = delete;
    ProgramTrace& operator=(const ProgramTrace&) = delete;

    // Called when another task goes on; a task's name is that of its function.
    std::function<void(const std::string& name)> onTask;

private:
    void switched();
    void look();
    void lookAt(uint32_t address);
    void write(const char* row, const std::string& text);

    Stm32F2& stm32_;
    std::function<uint64_t()> clocks_;
    const WaveWindow window_;
    std::ofstream file_;
    uint32_t taskAddress_;                  // of the pointer to the running task; 0: no kernel
    std::map<uint32_t, std::string> tasks_; // by that pointer
    std::string task_, interrupt_ = "-";
    std::map<std::string, std::string> written_; // by row
    uint64_t time_ = ~0ull;
    bool isNear_ = false; // the window has begun, or begins soon
};

#endif
