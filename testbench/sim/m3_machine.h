// SPDX-License-Identifier: MIT
//
// m3_machine: runs the firmware's ARM binary on a SocModel: the FSMC of the Cortex-M3 is
// connected to the pins of the RTL.

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
        // Processor clock (HCLK) in simulated time, Hz. With 120 MHz, the processor's work takes as
        // long as on the board, even if the FPGA's clock is slower. With 0, HCLK is 6/5 of the
        // FPGA's clock; FSMC accesses use this ratio in any case. Cycle counts are then the same as
        // on the board, and the processor is slower by the same factor as the FPGA.
        uint32_t hclkHz = 120'000'000;
        // Guard time, ms; 0 keeps the program's value. The machine writes the guard time to the
        // variable uav_guardMs (uav.h) after each start, as a debugger would do. A program without
        // this variable is not changed.
        uint16_t guardMs = 0;
        // Contents of the flash. If this vector is empty, the flash is loaded from the program
        // file. Otherwise the program file is only used for its symbols.
        std::vector<uint8_t> flash = {};
        // Key of the link, 16 bytes; stored in the vehicle before the flight, as its factory does.
        // If this vector is empty, the vehicle accepts a link without a key.
        std::vector<uint8_t> key = {};
        uint64_t seed = 1; // seed of the random number generator
        // Contents of the FPGA's configuration flash. If this vector is empty, the FPGA needs no
        // configuration.
        std::vector<uint8_t> fpgaFlash = {};
        bool isWired = false; // true if the jumper of PB1 is set (board.h)
        // address of the vehicle; stored like the key
        uint32_t address = 1;
        // peers that the vehicle serves in addition to its ground station
        std::vector<SimulatedBoard::OtherPeer> peers = {};
        // value written to the variable uav_transparent after each start
        bool isTransparent = false;
    };
    // `poll` is called about once per simulated millisecond; when it returns false, run() ends.
    M3Machine(SocModel& soc, const Config& config, std::function<bool()> poll);
    ~M3Machine();

    // Runs until `poll` returns false. The first call begins with power-on. Exceptions of the
    // models propagate to the caller.
    void run();
    // Runs up to this time, or up to one instruction longer. The first call begins with power-on.
    void advance(uint64_t ns);
    // Prints what the processor has executed and, if it has stopped, the reason.
    void report();

    // Runs the program under a debugger. Execution begins when a debugger connects. After the
    // debugger has detached, the program runs freely until another debugger connects. `canGoBack`
    // is true if nothing outside of this process takes part in the flight; a debugger can then run
    // the program backwards, even from its end.
    void debug(GdbStub& stub, bool canGoBack);

    Stm32F2& stm32() { return stm32_; }
    const std::vector<uint8_t>& fpgaFlash() const { return fpgaFlash_.memory; }
    CortexM3& cpu() { return stm32_.cpu(); }
    // Returns the text about the last reset by the watchdog, which was also printed, or "".
    const std::string& watchdogReport() const { return watchdogReport_; }
    // trace of the program's tasks; empty if `flash` was given, because its program is unknown
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
    std::string watchdogReport_;
    uint64_t nextPoll_ = 0, until_ = never;
    bool powered_ = false, over_ = false;
    // frozen copies of the process; null unless a debugger may go back
    std::unique_ptr<Checkpoints> checkpoints_;
    uint64_t nextCopyNs_ = 0;
    bool isAsked_ = false; // true if the debugger has requested a stop
    bool isAtBegin_ = false;
};

// Stores the keys and the address of a vehicle in a board, as its factory does.
void provideKeys(SimulatedBoard& board, const M3Machine::Config& config);
