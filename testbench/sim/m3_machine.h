// SPDX-License-Identifier: MIT
//
// m3_machine: runs the firmware's ARM binary on a SocModel: the Cortex-M3, its FSMC on the RTL's pins.

#ifndef M3_MACHINE_H
#define M3_MACHINE_H

#include "soc_model.h"
#include "gdb_stub.h"
#include "stm32f2.h"

class M3Machine {
public:
    struct Config {
        std::string firmware; // ELF file
        // HCLK in simulated time. 120 MHz: what the processor does takes as long as on the board, though
        // the fabric is slower. 0: in the board's ratio to the fabric's clock, 6 to 5, as FSMC accesses
        // always are; then cycles are as on the board, and the processor is slower by the fabric's scale.
        uint32_t hclkHz = 120'000'000;
        // As a debugger would write uav_guardMs (uav.h) after each start, in ms; 0: it is left alone.
        uint16_t guardMs = 0;
    };
    // `poll` is called about once a simulated millisecond; when it returns false, run() ends.
    M3Machine(SocModel& soc, const Config& config, std::function<bool()> poll);
    ~M3Machine();

    // Runs until poll says so; the first call begins with power-on. Exceptions of the models come through.
    void run();

    // As run(), but a debugger commands; it begins when one connects, and goes on freely when it detaches.
    void debug(GdbStub& stub);

    Stm32F2& stm32() { return stm32_; }
    CortexM3& cpu() { return stm32_.cpu(); }

private:
    void powerOn();

    SocModel& soc_;
    GdbStub* stub_ = nullptr;
    std::function<bool()> poll_;
    Stm32F2 stm32_;
    uint64_t nextPoll_ = 0;
    bool powered_ = false, over_ = false;
};

#endif
