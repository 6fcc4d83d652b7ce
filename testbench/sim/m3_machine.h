// SPDX-License-Identifier: MIT
//
// m3_machine: runs the firmware's ARM binary on a SocModel: the Cortex-M3, with its FSMC connected
// to the pins of the RTL.

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
        // Processor clock (HCLK), Hz in simulated time. With 120 MHz, the processor's work takes as
        // long as on the board, although the FPGA's clock is slower. With 0, HCLK is 6/5 of the
        // FPGA's clock, as it always is for FSMC accesses: cycle counts are then as on the board,
        // and the processor is slowed down by the same factor as the FPGA.
        uint32_t hclkHz = 120'000'000;
        // Guard time in ms, written to uav_guardMs (uav.h) after each start, as a debugger would
        // do; 0: not written. A program without this variable is not changed.
        uint16_t guardMs = 0;
        // Contents of the flash; empty: the flash contains the program. With contents, the program
        // only provides its symbols.
        std::vector<uint8_t> flash = {};
        // Key of the link that the factory has set, 16 bytes; empty: the vehicle is open.
        std::vector<uint8_t> key = {};
        uint64_t seed = 1; // seed of the random number generator
        // Contents of the FPGA's configuration flash; empty: the FPGA needs no configuration.
        std::vector<uint8_t> fpgaFlash = {};
        bool isWired = false; // true if the jumper of PB1 is set (board.h)
        // address of the vehicle, as the factory sets it
        uint32_t address = 1;
        // peers that the vehicle serves in addition to its ground station
        std::vector<SimulatedBoard::OtherPeer> peers = {};
        // value written to uav_transparent, in the same way as guardMs
        bool isTransparent = false;
    };
    // `poll` is called about once per simulated millisecond; when it returns false, run() ends.
    M3Machine(SocModel& soc, const Config& config, std::function<bool()> poll);
    ~M3Machine();

    // Runs until `poll` returns false. The first call begins with power-on. Exceptions of the
    // models are passed to the caller.
    void run();
    // Runs up to this time, or one instruction longer. The first call begins with power-on.
    void advance(uint64_t ns);
    // Prints which instructions the processor executed, and the reason if it stopped.
    void report();

    // Runs as a debugger commands. Execution begins when a debugger connects. After it detaches,
    // the program runs freely until the next debugger connects. `canGoBack` is true if nothing
    // outside of this process takes part: the debugger may then run the program backwards, even
    // from its end.
    void debug(GdbStub& stub, bool canGoBack);

    Stm32F2& stm32() { return stm32_; }
    const std::vector<uint8_t>& fpgaFlash() const { return fpgaFlash_.memory; }
    CortexM3& cpu() { return stm32_.cpu(); }
    // state of the program; empty if a flash was given, because that program is unknown
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
