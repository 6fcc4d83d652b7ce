// SPDX-License-Identifier: MIT
//
// fsmc_master: models the FSMC peripheral of the STM32F2, bank 1 (RM0033, chapter 31), which drives
// the pins to the FPGA.
//
// It is programmed through BCRx, BTRx and BWTRx like the real FSMC. It supports the asynchronous
// modes 1, A, 2, B, C, D and multiplexed, with ASYNCWAIT. During an access the model runs the
// design clock. HCLK and the design clock have an exact fixed ratio (120 MHz to 100 MHz by
// default). Pins change on HCLK edges, between edges of the design clock.
//
// It throws FsmcError in these cases, in which a real system would fail: both sides drive the data
// bus, no side drives it in a read, read data changes within its set-up time, NWAIT becomes active
// too late to be sampled or stays low for ever, a register contains a reserved value, or a bank is
// not enabled.

#pragma once

#include "fsmc_pins.h"
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

// Addresses and bits of the FSMC's registers (RM0033, 31.5.6).
namespace fsmc {

constexpr uint32_t registersAt = 0xA0000000, windowsAt = 0x60000000, windowBytes = 0x04000000;
// maximum number of HCLK cycles for which NWAIT may extend an access; the model reports an error
// after that
constexpr unsigned waitLimit = 20000;

// BCR
constexpr uint32_t bcrEnable = 1u << 0, bcrMuxed = 1u << 1, bcrTypePsram = 1u << 2,
                   bcrTypeNor = 2u << 2, bcrWidth16 = 1u << 4, bcrFlashAccess = 1u << 6,
                   bcrWaitHigh = 1u << 9, bcrWaitDuring = 1u << 11, bcrWriteEnable = 1u << 12,
                   bcrWaitEnable = 1u << 13, bcrExtended = 1u << 14, bcrAsyncWait = 1u << 15;
constexpr unsigned typeNor = 2;

// Returns a value for BTR or BWTR. Times are in HCLK cycles; ACCMOD 0..3 selects modes A..D.
constexpr uint32_t timing(unsigned addset, unsigned datast, unsigned busturn = 0,
                          unsigned addhld = 1, unsigned accmod = 0) {
    return addset | addhld << 4 | datast << 8 | busturn << 16 | accmod << 28;
}

} // namespace fsmc

struct FsmcCorner;
class PinDelays;

class FsmcMaster {
public:
    using Design = FsmcDesign;
    FsmcMaster(FsmcPins& pins, Design design, unsigned hclkPerUnit = 6, unsigned clkPerUnit = 5);
    ~FsmcMaster();

    // Adds delays to the pins (pin_delays.h): `far` are the pins at the design, `pins` are those at
    // the processor. `looksTwice` selects one of two interpretations of RM0033's rule about NWAIT.
    // false: the FSMC samples NWAIT only once, four HCLK cycles before the end of the data phase.
    // true: the FSMC also samples NWAIT later.
    void delay(const FsmcCorner& corner, FsmcPins& far, uint64_t seed, bool looksTwice);

    // Delays the changes of a pin by `ps`, in addition to the delays that delay() has set; delay()
    // must be called first. After this call, a signal that changes at the wrong time gives the
    // processor wrong data instead of an FsmcError.
    void makeLate(const std::string& pin, int ps);
    // Gives the processor wrong data instead of an FsmcError, as makeLate() does, but delays no
    // pin.
    void tolerate();
    // Makes each read return the halfword of the previous read, as a design with one register too
    // many in its data path does.
    void shiftReads() { shiftsReads_ = true; }
    // Sets the frequencies of HCLK and of the design clock, as cycles in the same unit of time.
    void setClocks(unsigned hclkPerUnit, unsigned clkPerUnit);

    // Sets whether the pause BUSTURN also applies between two writes to the same bank. RM0033 does
    // not define this. On an STM32F407 the pause applies between the two halves of a word, with the
    // value in BWTR if the bank uses BWTR (community.st.com, thread 309858).
    void pauseWrites(bool pauses) { pausesWrites_ = pauses; }

    // Loads and stores of the processor. A 32-bit load or store to a window makes two accesses, low
    // half first.
    uint8_t read8(uint32_t address);
    void write8(uint32_t address, uint8_t value);
    uint16_t read16(uint32_t address);
    void write16(uint32_t address, uint16_t value);
    uint32_t read32(uint32_t address);
    void write32(uint32_t address, uint32_t value);

    // called after each 32-bit access to a window; for observers
    std::function<void(uint32_t address, uint32_t value, bool isWrite)> onWord;

    // Begin an access that a reset of the processor aborts: after `hclk` cycles of the data phase,
    // first NE rises and then the strobe, whatever the level of NWAIT is. For asynchronous modes
    // only.
    void abortRead(uint32_t address, unsigned hclk);
    void abortWrite(uint32_t address, uint16_t value, unsigned hclk);
    // Lets HCLK cycles pass without an access.
    void idle(unsigned hclk) { passHclk(hclk); }
    // Skips HCLK cycles as long as the design is idle, at most `hclk` cycles and about `ns`.
    // Returns the number of skipped cycles.
    unsigned idleQuiet(unsigned hclk, uint64_t ns);

    uint64_t accesses() const { return accesses_; }
    uint64_t hclks() const { return hclks_; } // number of HCLK cycles of all accesses and pauses

private:
    struct Bank {
        // registers of a bank with their reset values
        uint32_t bcr, btr = 0x0FFFFFFF, bwtr = 0x0FFFFFFF;
    };
    struct Timing {
        unsigned addset, addhld, datast, busturn;
    };
    struct Access {
        Bank* bank;
        unsigned index;    // index of the bank: 0 for NE1 to 3 for NE4
        uint32_t halfword; // address
        bool write, muxed;
        char mode; // mode of the access: '1', 'A', '2', 'B', 'C' or 'D'
        Timing timing;
        std::string name; // name of the bank, for messages
    };

    Access decode(uint32_t address, bool write);
    uint32_t& fsmcRegister(uint32_t address);
    uint16_t readPins(uint32_t address);
    void writePins(uint32_t address, uint16_t value, uint8_t lanes);
    void turnaround(const Access& access);
    void addressPhase(const Access& access, uint16_t value, uint8_t lanes);
    bool isWaiting(const Access& access) const;
    void complain(const std::string& what) const;
    unsigned waitPhase(const Access& access);
    void endOfAccess(const Access& access);
    void abort(const Access& access, unsigned hclk);
    void show();
    void passHclk(unsigned cycles);

    FsmcPins& pins_;
    Design design_;
    // number of HCLK cycles, and of clocks of the design, in one unit of time
    unsigned hclkPerUnit_, clkPerUnit_;
    unsigned phase_ = 0;
    std::unique_ptr<PinDelays> delays_;
    bool looksTwice_ = false, pausesWrites_ = true, tolerant_ = false, shiftsReads_ = false;
    uint16_t lastRead_ = 0;
    Bank banks_[4] = {{0x000030DB}, {0x000030D2}, {0x000030D2}, {0x000030D2}};
    // State of the previous access, for the bus turnaround.
    bool lastWrite_ = false, lastHeld_ = false;
    unsigned lastIndex_ = 0, lastBusturn_ = 0;
    uint64_t accesses_ = 0, hclks_ = 0;
};
