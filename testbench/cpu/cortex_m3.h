// SPDX-License-Identifier: MIT
//
// cortex_m3: models a Cortex-M3. libunicorn executes the instructions; this class adds exceptions,
// their priorities, the system registers, cycles and faults. docs/simulation.md describes its
// contract and its limits.

#pragma once

#include "cpu_memory.h"
#include "flash_writes.h"
#include "instruction.h"
#include "masked_time.h"
#include "system_control.h"
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <unicorn/unicorn.h>
#include <vector>

// Interface to everything around the processor. Addresses are the addresses that the program uses.
class CpuBus {
public:
    virtual ~CpuBus() = default;
    // Exception that the bus throws for a failed access. The processor takes a BusFault with this
    // text.
    class Error : public std::runtime_error {
    public:
        using std::runtime_error::runtime_error;
    };
    // `bytes` is the size of the access: 1, 2 or 4
    virtual uint32_t read(uint32_t address, unsigned bytes) = 0;
    virtual void write(uint32_t address, unsigned bytes, uint32_t value) = 0;
    // Lets `cycles` of HCLK pass without an access. The model does not call pass() while a call of
    // pass() is in progress.
    virtual void pass(unsigned cycles) = 0;
    // Lets up to `limit` cycles pass while the processor sleeps; returns earlier if an interrupt
    // line changes. Returns the number of cycles that passed, at least 1.
    virtual unsigned sleep(unsigned limit) {
        pass(1);
        return limit ? 1 : 0;
    }
    // Handles a store of the program to flash, at this offset in flash.
    virtual void writeFlash(uint32_t, unsigned, uint32_t) {
        throw Error("flash is not written by stores");
    }
    // Returns the HCLK cycles that the processor waited for the last access.
    virtual unsigned takeWaited() = 0;
};

class CortexM3 {
public:
    struct Config {
        uint32_t flashBase = 0x08000000,
                 flashBytes = 0x100000; // size of flash; flash can also be read at address 0
        uint32_t ramBase = 0x20000000, ramBytes = 0x20000;
        uint32_t calibration = 15000; // value of SYST_CALIB: ticks of HCLK/8 in a millisecond
    };
    // Address ranges mapped to the bus.
    struct Window {
        uint32_t base, bytes;
    };

    CortexM3(CpuBus& bus, const Config& config, const std::vector<Window>& windows);
    ~CortexM3();
    CortexM3(const CortexM3&) = delete;
    CortexM3& operator=(const CortexM3&) = delete;

    // Read and write flash and RAM without side effects. They return false if part of the range is
    // not memory.
    bool readMemory(uint32_t address, void* data, uint32_t bytes) const {
        return memory_.read(address, data, bytes);
    }
    bool writeMemory(uint32_t address, const void* data, uint32_t bytes);
    void loadFlash(uint32_t address, const std::vector<uint8_t>& bytes);
    // Read and write on behalf of a debugger. Memory is accessed directly. Registers and windows
    // are accessed over the bus, in the same way as by the processor.
    bool debugRead(uint32_t address, void* data, uint32_t bytes);
    bool debugWrite(uint32_t address, const void* data, uint32_t bytes);
    uint8_t* flash() { return memory_.flash(); }
    // Reports that bytes of flash have changed; called by the bus.
    void flashChanged(uint32_t offset, uint32_t bytes);
    // Makes instruction fetches from flash wait for this many cycles; called by the bus.
    void stallFlash(uint64_t cycles) { flashFree_ = this->cycles() + cycles; }
    // Returns the word at `address`; 0 if the address is not memory.
    uint32_t word(uint32_t address) const;

    // Performs a power-on or system reset: loads SP and PC from the vector table, and keeps the
    // contents of RAM.
    void reset();
    // Runs until stop() is called, a breakpoint is reached, or the bus throws an exception other
    // than CpuBus::Error.
    enum class Stop { Asked, Breakpoint, Stepped };
    Stop run(bool singleStep = false);
    // Makes run() also stop, with Stop::Stepped, when `instructions()` reaches this number; 0
    // disables the limit. If the number is reached within an IT block, the processor stops after
    // the block.
    void setLimit(uint64_t instructions) { limit_ = instructions; }
    // Returns the last value of instructions() before the current value at which the processor
    // could have stopped.
    uint64_t lastStop() const { return boundaries_[0]; }
    // Makes run() return before the next instruction; called by the bus or by a listener.
    void stop() { stopAsked_ = attention_ = true; }
    // Requests a reset from outside the processor, for example by a watchdog. The reset takes
    // effect before the next instruction.
    void requestReset() { resetAsked_ = attention_ = true; }

    // Sets the level of an interrupt line; called by the bus.
    void setInterrupt(unsigned number, bool high);
    void pendInterrupt(unsigned number);

    // Register numbers: 0 to 16 are R0..R12, SP, LR, PC and xPSR; then follow MSP, PSP, PRIMASK,
    // BASEPRI, FAULTMASK and CONTROL.
    enum Register {
        Sp = 13,
        Lr,
        Pc,
        Xpsr,
        Msp,
        Psp,
        Primask,
        Basepri,
        Faultmask,
        Control,
        Registers
    };
    uint32_t reg(int number) const;
    void setReg(int number, uint32_t value);

    uint64_t cycles() const { return control_.cycles(); }
    uint64_t instructions() const { return instructions_; }
    uint64_t sleepingCycles() const { return sleeping_; }
    // Returns the number of cycles that the processor has waited for accesses to windows.
    uint64_t busCycles() const { return waited_; }
    bool isLockedUp() const { return lockedUp_; }
    unsigned currentException() const;
    Exceptions& exceptions() { return exceptions_; }

    // Starts to measure the longest time for which the mask registers block interrupts of
    // `priority` and of less urgent priorities.
    void countMasked(uint8_t priority) { masked_.start(priority); }
    const MaskedTime::Longest& longestMasked() const { return masked_.longest(); }

    std::set<uint32_t> breakpoints; // breakpoint addresses, with bit 0 clear
    // true while a debugger is connected (DHCSR.C_DEBUGEN): a BKPT instruction then stops run();
    // otherwise it is a hard fault
    bool hasDebugger = true;
    std::string lastFault; // text of the last fault, for a message to the user

    // Functions that are called when an exception is entered or left, and before a system reset is
    // carried out.
    struct Listener {
        std::function<void(unsigned number)> entered, left;
        std::function<void()> systemReset;
        std::function<void(uint32_t address)> instruction; // called before each instruction; slow
    } listener;

private:
    friend struct UnicornCalls;
    void onInstruction(uint32_t address);
    void execute(uint32_t address, const Instruction& i);
    void onRaised(uint32_t number);
    template <class Store> void store(uint32_t address, unsigned bytes, Store store);
    void drainStore();
    void reportStoreFault(const std::string& text);
    uint32_t onRead(uint32_t address, unsigned bytes);
    void onWrite(uint32_t address, unsigned bytes, uint32_t value);
    void onFlashWrite(uint32_t offset, unsigned bytes, uint32_t value);
    void waitForFlash();
    void passWaited();
    bool mayExecute(uint32_t address, const Instruction& i);
    void setSynchronous(uint32_t address, unsigned number, uint32_t cfsrBits, const char* text);
    void clearExclusive();
    void fixBasepri();
    void fixFaultmask();
    // Returns true in the handlers of HardFault and NMI, and while FAULTMASK is set. The MPU does
    // not check accesses of such code (B3.5.1).
    bool isMpuOff() const { return exceptions_.runningPriority() < 0; }
    bool isSplit(uint32_t address, unsigned bytes);
    uint32_t readBit(uint32_t address);
    void writeBit(uint32_t address, uint32_t value);
    bool onGuarded(uint32_t address, unsigned bytes, bool write);
    template <class Access> uint32_t guardedAccess(uint32_t address, unsigned bytes, Access access);
    bool debugAccess(uint32_t address, uint8_t* data, uint32_t bytes, bool writes);
    const Instruction& instructionAt(uint32_t address);
    void pass(unsigned cycles);
    template <class Time> void passing(Time time);
    void sleep();
    void updateMasks(uint32_t address);
    void updateAttention();
    void enter(unsigned number);
    void leave();
    void jumpTo(unsigned number);
    void fault(unsigned number, uint32_t cfsrBits, const std::string& text);
    void handleUnicorn(uc_err error);
    void handleRaised();
    void fetchFault();
    void undefinedAt(uint32_t address);

    CpuBus& bus_;
    Config config_;
    uc_engine* uc_ = nullptr;
    CpuMemory memory_;
    FlashWrites flashWrites_;
    Instruction scratch_; // decoded instruction at an address outside flash
    struct MappedWindow {
        CortexM3* cpu;
        uint32_t base;
    };
    std::vector<std::unique_ptr<MappedWindow>> windows_;
    Exceptions exceptions_;
    SystemControl control_{exceptions_, 0};

    uint32_t pc_ = 0, executing_ = 0, expected_ = 0, unitEnd_ = 0;
    // number of instructions of the current IT block that must still be executed or skipped
    unsigned skipped_ = 0;
    bool masksChanged_ = false;
    uint8_t special_ = 0;     // number of the special register that the last MSR instruction wrote
    bool exclusive_ = false;  // true if the exclusive monitor may be open
    bool isClearing_ = false; // true while a CLREX that the model has inserted is executed
    bool attention_ = false, stopAsked_ = false, resetAsked_ = false, stepped_ = false,
         breakpointHit_ = false;
    bool singleStep_ = false, passBreakpoint_ = false;
    bool lockedUp_ = false, asleep_ = false;
    uint32_t raised_ = 0;
    struct {
        unsigned number = 0;
        uint32_t cfsrBits = 0;
        std::string text;
    } synchronous_; // fault that the current instruction caused
    // Write buffer with one entry (TRM r2p1, 3.5): it holds a store to a window until the store is
    // carried out.
    struct BufferedStore {
        uint32_t address = 0, value = 0;
        unsigned bytes = 0; // size of the stored data, bytes; 0 means that the buffer is empty
        uint64_t due = 0;   // cycle count
    } store_;
    std::exception_ptr failure_;
    uint64_t instructions_ = 0, sleeping_ = 0, waited_ = 0;
    uint64_t flashFree_ = 0;
    uint64_t limit_ = 0, boundaries_[2] = {0, 0};
    MaskedTime masked_;
};
