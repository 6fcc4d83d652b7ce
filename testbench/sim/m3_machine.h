// SPDX-License-Identifier: MIT
//
// m3_machine: runs the firmware's ARM binary on a SocModel: the Cortex-M3, its FSMC on the RTL's
// pins.

#pragma once

#include "checkpoints.h"
#include "gdb_stub.h"
#include "program_trace.h"
#include "simulated_board.h"
#include "soc_model.h"
#include "stm32f2.h"
#include <memory>

class M3Machine {
public:
    struct Config {
        std::string firmware; // ELF file
        // Processor clock (HCLK), Hz of simulated time. 120 MHz: the processor's work takes as long
        // as on the board, although the fabric is slower. 0: 6/5 of the fabric clock, as FSMC
        // accesses always are; then cycle counts are as on the board, and the processor is as much
        // slower as the fabric.
        uint32_t hclkHz = 120'000'000;
        // Written to uav_guardMs (uav.h) after each start, as a debugger would, in ms; 0: not
        // written. A program without the variable is left alone.
        uint16_t guardMs = 0;
        // Contents of flash, instead of the program, which then only provides its symbols.
        std::vector<uint8_t> flash = {};
        // Key of the link as set by the factory, 16 bytes; empty: the vehicle is open.
        std::vector<uint8_t> key = {};
        uint64_t seed = 1; // seed of the random number generator
        // Contents of the FPGA's configuration flash; empty: the FPGA needs no configuration.
        std::vector<uint8_t> fpgaFlash = {};
        bool isWired = false;                         // the jumper of PB1 (board.h)
        uint32_t address = 1;                         // address of the vehicle, also set by the
                                                      // factory
        std::vector<SimulatedBoard::Peer> peers = {}; // peers served in addition to its ground
                                                      // station
        bool isTransparent = false;                   // written to uav_transparent, as guardMs is
    };
    // `poll` is called about once per simulated millisecond; when it returns false, run() ends.
    M3Machine(SocModel& soc, const Config& config, std::function<bool()> poll);
    ~M3Machine();

    // Runs until `poll` returns false; the first call begins with power-on. Exceptions of the
    // models propagate.
    void run();
    // Runs up to this time, or an instruction beyond; the first call begins with power-on.
    void advance(uint64_t ns);
    // Prints what the processor executed, and the reason if it stopped.
    void report();

    // Runs as a debugger commands. It begins when one connects, runs freely when it detaches, and
    // obeys the next one. `canGoBack`: nothing outside of this process takes part, so the debugger
    // may run it backwards, also from its end.
    void debug(GdbStub& stub, bool canGoBack);

    Stm32F2& stm32() { return stm32_; }
    const std::vector<uint8_t>& fpgaFlash() const { return fpgaFlash_.memory; }
    CortexM3& cpu() { return stm32_.cpu(); }
    // State of the program; empty if flash was given, since that program is unknown.
    std::optional<ProgramTrace> program;

private:
    void powerOn();
    GdbStub::Target target();
    CortexM3::Stop resume(bool singleStep);
    CortexM3::Stop follow(const Checkpoints::Order& order, uint64_t from);
    bool runTo(uint64_t instructions);
    void goBack(bool singleStep);

    SocModel& soc_;
    GdbStub* stub_ = nullptr;
    std::function<bool()> poll_;
    SpiFlash fpgaFlash_;
    Stm32F2 stm32_;
    uint64_t nextPoll_ = 0, until_ = never;
    bool powered_ = false, over_ = false;
    std::unique_ptr<Checkpoints> checkpoints_; // exists while a debugger may go back
    uint64_t nextCopyNs_ = 0;
    bool isAsked_ = false; // the debugger has requested a stop
    bool isAtBegin_ = false;
};

// Stores the keys and the address of a vehicle in a board, as its factory does.
void provideKeys(SimulatedBoard& board, const M3Machine::Config& config);
