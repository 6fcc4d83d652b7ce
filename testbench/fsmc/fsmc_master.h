// SPDX-License-Identifier: MIT
//
// fsmc_master: the STM32F2's FSMC peripheral (RM0033, chapter 31), bank 1, as far as the driver uses
// it: asynchronous accesses of 16-bit memory with NWAIT, timed by what was written to BCR and BTR.
//
// An access runs the clock of the design while it lasts. HCLK and the design's clock stand in a fixed
// ratio (120 MHz to 100 MHz by default), kept exactly.

#ifndef FSMC_MASTER_H
#define FSMC_MASTER_H

#include <cstdint>
#include <functional>
#include <stdexcept>

// The pins between processor and FPGA. The design's side is filled in by whoever clocks it.
struct FsmcPins {
    uint32_t a = 0; // halfword address, 25 bits
    uint16_t d = 0; // driven by the processor
    uint8_t neN = 3, nblN = 3;
    bool noeN = true, nweN = true;
    // from the design
    uint16_t dFromDesign = 0;
    bool dDriven = false, nwaitN = true;
};

class FsmcError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class FsmcMaster {
public:
    // `tick` clocks the design once with the pins as they are, and updates the design's side.
    FsmcMaster(FsmcPins& pins, std::function<void()> tick, unsigned hclkPerUnit = 6,
               unsigned clkPerUnit = 5)
        : pins_(pins), tick_(std::move(tick)), hclkPerUnit_(hclkPerUnit), clkPerUnit_(clkPerUnit) {}

    // Loads and stores of the processor. A 32-bit one to a window is two accesses, low half first.
    uint8_t read8(uint32_t address);
    void write8(uint32_t address, uint8_t value);
    uint16_t read16(uint32_t address);
    void write16(uint32_t address, uint16_t value);
    uint32_t read32(uint32_t address);
    void write32(uint32_t address, uint32_t value);

    uint64_t accesses() const { return accesses_; }
    uint64_t cyclesInAccesses() const { return cycles_; } // of the design's clock

private:
    struct Bank {
        uint32_t bcr = 0x000030DA, btr = 0x0FFFFFFF; // reset values
    };
    struct Access {
        Bank* bank;
        unsigned index;    // 0: NE1, 1: NE2
        uint32_t halfword; // address on the pins
    };

    Access decode(uint32_t address);
    uint32_t& fsmcRegister(uint32_t address);
    uint16_t readPins(uint32_t address);
    void writePins(uint32_t address, uint16_t value, uint8_t lanes);
    void begin(const Access& access);
    void dataPhase(const Access& access, uint32_t address, const char* what);
    void end(const Access& access);
    void passHclk(unsigned cycles);

    FsmcPins& pins_;
    std::function<void()> tick_;
    unsigned hclkPerUnit_, clkPerUnit_; // in one unit of time so many cycles of each
    unsigned phase_ = 0;
    Bank banks_[4];
    uint64_t accesses_ = 0, cycles_ = 0;
};

#endif
