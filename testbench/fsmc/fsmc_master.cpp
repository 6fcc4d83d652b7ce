// SPDX-License-Identifier: MIT
//
// fsmc_master: carries out each access as a sequence of pin changes and HCLK cycles.

#include "fsmc_master.h"
#include "pin_delays.h"
#include <cstdio>
#include <utility>

namespace {

std::string hex(uint32_t value) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%08X", value);
    return text;
}

} // namespace

using namespace fsmc;

FsmcMaster::FsmcMaster(FsmcPins& pins, Design design, unsigned hclkPerUnit, unsigned clkPerUnit)
    : pins_(pins), design_(std::move(design)), hclkPerUnit_(hclkPerUnit), clkPerUnit_(clkPerUnit) {}

FsmcMaster::~FsmcMaster() = default;

void FsmcMaster::delay(const FsmcCorner& corner, FsmcPins& far, uint64_t seed, bool looksTwice) {
    constexpr int clk = 10000; // period of the design clock at 100 MHz, ps
    delays_ = std::make_unique<PinDelays>(pins_, far, design_, corner, seed,
                                          static_cast<int>(clk * clkPerUnit_ / hclkPerUnit_), clk);
    looksTwice_ = looksTwice;
}

void FsmcMaster::makeLate(const std::string& pin, int ps) {
    tolerate();
    delays_->addDelay(pin, ps);
}

void FsmcMaster::tolerate() {
    tolerant_ = true;
    if (delays_)
        delays_->tolerate();
}

void FsmcMaster::setClocks(unsigned hclkPerUnit, unsigned clkPerUnit) {
    hclkPerUnit_ = hclkPerUnit;
    clkPerUnit_ = clkPerUnit;
    phase_ = 0;
    if (delays_)
        delays_->setHclk(static_cast<int>(10000 * clkPerUnit_ / hclkPerUnit_));
}

// Throws an FsmcError for a signal that changes at the wrong time, unless such signals are
// tolerated.
void FsmcMaster::complain(const std::string& what) const {
    if (!tolerant_)
        throw FsmcError(what);
}

void FsmcMaster::show() {
    if (delays_)
        return delays_->show(); // with pin delays, both sides may drive the data bus for a few ns
    design_.settle();
    if (pins_.dDriven && pins_.dOut)
        complain("data bus driven by both sides");
}

void FsmcMaster::passHclk(unsigned cycles) {
    hclks_ += cycles;
    if (delays_) {
        delays_->pass(cycles);
        return;
    }
    phase_ += cycles * clkPerUnit_;
    while (phase_ >= hclkPerUnit_) {
        phase_ -= hclkPerUnit_;
        design_.tick();
        if (pins_.dDriven && pins_.dOut)
            complain("data bus driven by both sides");
    }
}

unsigned FsmcMaster::idleQuiet(unsigned hclk, uint64_t ns) {
    if (delays_ || !design_.passQuiet)
        return 0;
    const uint64_t clocks =
        design_.passQuiet((phase_ + uint64_t(hclk) * clkPerUnit_) / hclkPerUnit_, ns);
    if (clocks == 0)
        return 0;
    // Advances by all these clocks at once. The result is the same as after single steps.
    const uint64_t cycles = (clocks * hclkPerUnit_ - phase_ + clkPerUnit_ - 1) / clkPerUnit_;
    phase_ += static_cast<unsigned>(cycles * clkPerUnit_ - clocks * hclkPerUnit_);
    hclks_ += cycles;
    return static_cast<unsigned>(cycles);
}

uint32_t& FsmcMaster::fsmcRegister(uint32_t address) {
    uint32_t offset = address - registersAt;
    if (offset < 32 && offset % 4 == 0) {
        Bank& bank = banks_[offset / 8];
        return offset % 8 ? bank.btr : bank.bcr;
    }
    if (offset >= 0x104 && offset <= 0x11C && offset % 8 == 4)
        return banks_[(offset - 0x104) / 8].bwtr;
    throw FsmcError("no FSMC register at " + hex(address));
}

FsmcMaster::Access FsmcMaster::decode(uint32_t address, bool write) {
    uint32_t offset = address - windowsAt;
    if (address < windowsAt || offset >= 4 * windowBytes)
        throw FsmcError("bus fault: nothing at " + hex(address));
    unsigned index = offset / windowBytes;
    Bank& bank = banks_[index];
    std::string bcr = "BCR" + std::to_string(index + 1);
    if (!(bank.bcr & bcrEnable) || (bank.bcr >> 4 & 3) != 1)
        throw FsmcError("access to " + hex(address) + " before " + bcr +
                        " enables the bank with 16 bits");
    if (write && !(bank.bcr & bcrWriteEnable))
        throw FsmcError("write to " + hex(address) + " while BCR forbids writing");

    bool extended = bank.bcr & bcrExtended;
    uint32_t timing = extended && write ? bank.bwtr : bank.btr;
    char mode = (bank.bcr >> 2 & 3) == typeNor ? '2' : '1';
    if (extended)
        mode = static_cast<char>('A' + (timing >> 28 & 3));
    bool muxed = bank.bcr & bcrMuxed;
    Access access{&bank,
                  index,
                  offset % windowBytes >> 1,
                  write,
                  muxed,
                  mode,
                  {timing & 0xF, timing >> 4 & 0xF, timing >> 8 & 0xFF, timing >> 16 & 0xF},
                  std::string(write ? "writing " : "reading ") + hex(address)};
    if (access.timing.datast == 0 || ((muxed || mode == 'D') && access.timing.addhld == 0))
        throw FsmcError(access.name + ": DATAST or ADDHLD is 0, which is reserved");
    if ((bank.bcr & bcrAsyncWait) && access.timing.datast < 4)
        throw FsmcError(access.name + ": ASYNCWAIT needs DATAST of 4 at least");
    return access;
}

// Waits between two accesses, as RM0033 describes for BUSTURN.
void FsmcMaster::turnaround(const Access& access) {
    bool held = access.muxed || access.mode == 'D';
    unsigned pause = 1; // number of HCLK cycles of the pause after a read
    if (lastHeld_)
        pause = lastBusturn_;
    else if (lastWrite_)
        pause = !pausesWrites_ && access.write && access.index == lastIndex_ ? 0 : lastBusturn_;
    if (accesses_)
        passHclk(pause);
    ++accesses_;
    lastWrite_ = access.write;
    lastHeld_ = held;
    lastIndex_ = access.index;
    lastBusturn_ = access.timing.busturn;
}

// Returns true if the bank uses NWAIT and NWAIT is active.
bool FsmcMaster::isWaiting(const Access& access) const {
    return (access.bank->bcr & bcrAsyncWait) &&
           pins_.nwaitN == bool(access.bank->bcr & bcrWaitHigh);
}

// Drives the pins from the falling edge of NE to the beginning of the data phase; the strobe is low
// then.
void FsmcMaster::addressPhase(const Access& access, uint16_t value, uint8_t lanes) {
    bool early = access.write ? access.mode == '2'
                              : access.mode == '1' || access.mode == '2' || access.mode == 'B';
    bool hold = access.muxed || access.mode == 'D';
    bool advance = access.muxed || (access.mode != '1' && access.mode != 'A');
    bool& strobe = access.write ? pins_.nweN : pins_.noeN;

    pins_.a = access.muxed ? access.halfword & ~0xFFFFu : access.halfword;
    pins_.nblN = static_cast<uint8_t>(3 & ~lanes);
    pins_.nadvN = !advance;
    if (access.muxed)
        pins_.d = static_cast<uint16_t>(access.halfword);
    else if (access.write)
        pins_.d = value;
    pins_.dOut = access.muxed || access.write;
    pins_.neN = static_cast<uint8_t>(0xF & ~(1u << access.index));
    if (early && !access.muxed)
        strobe = false;
    show();
    bool free = !strobe && !isWaiting(access);
    passHclk(access.timing.addset);
    pins_.nadvN = true;
    show();
    if (hold)
        passHclk(access.timing.addhld);
    if (access.muxed) {
        pins_.d = value;
        pins_.dOut = access.write;
    }
    strobe = false;
    show();
    // Without pin delays, NWAIT must become active together with the strobe.
    if (free && isWaiting(access) && !delays_)
        complain(access.name + ": NWAIT went active after the strobe");
}

// Advances the data phase until at most two HCLK cycles of it remain, and returns the number of
// remaining cycles. With NWAIT enabled, the pin is sampled four HCLK cycles before the end of the
// phase, and the phase ends four HCLK cycles after NWAIT is released.
unsigned FsmcMaster::waitPhase(const Access& access) {
    if (!(access.bank->bcr & bcrAsyncWait)) {
        unsigned left = access.timing.datast < 2 ? access.timing.datast : 2;
        passHclk(access.timing.datast - left);
        return left;
    }
    bool free = !isWaiting(access);
    passHclk(access.timing.datast - 4);
    if (free && isWaiting(access) && !delays_)
        complain(access.name + ": NWAIT went active after the strobe");
    for (unsigned waited = 0; isWaiting(access); ++waited) {
        if (waited > waitLimit)
            throw FsmcError(access.name + ": NWAIT has been active for " +
                            std::to_string(waitLimit) + " HCLK cycles");
        passHclk(1);
    }
    passHclk(1);
    if (looksTwice_ && isWaiting(access))
        return waitPhase(access);
    passHclk(1);
    return 2;
}

// Checks the pins at the end of an access.
void FsmcMaster::endOfAccess(const Access& access) {
    if (isWaiting(access))
        complain(access.name + ": NWAIT went active too late to be seen");
}

uint16_t FsmcMaster::readPins(uint32_t address) {
    Access access = decode(address, false);
    turnaround(access);
    addressPhase(access, 0, 3);
    // Set-up time of the data before NE rises: HCLK + 4 ns (STM32F2 data sheet), which are two HCLK
    // cycles here.
    passHclk(0);
    unsigned left = waitPhase(access);
    bool ours = access.index < 2;
    uint16_t value = pins_.dFromDesign;
    passHclk(left);
    if (ours != pins_.dDriven)
        complain(access.name + (ours ? ": the data bus floats" : ": the FPGA drives the data bus"));
    if (delays_)
        value = pins_.dFromDesign;
    if (ours && (delays_ ? !delays_->dataIsSetUp() : pins_.dFromDesign != value)) {
        if (access.bank->bcr & bcrAsyncWait)
            complain(access.name + ": the data moved in its set-up time");
        value = static_cast<uint16_t>(~pins_.dFromDesign); // the processor gets an undefined value
    }
    if (ours && !pins_.dDriven)
        value = static_cast<uint16_t>(~value); // value of a data bus without a driver
    if (ours && shiftsReads_)
        std::swap(value, lastRead_);
    endOfAccess(access);
    pins_.noeN = true;
    pins_.neN = 0xF;
    pins_.nblN = 3;
    show();
    if (pins_.dDriven && !delays_)
        complain(access.name + ": the data bus is still driven after the access");
    // another bank belongs to another chip; its data lines are pulled up
    return ours ? value : 0xFFFF;
}

void FsmcMaster::writePins(uint32_t address, uint16_t value, uint8_t lanes) {
    Access access = decode(address, true);
    turnaround(access);
    addressPhase(access, value, lanes);
    passHclk(waitPhase(access));
    endOfAccess(access);
    pins_.nweN = true;
    show();
    passHclk(1); // address and data are held for one HCLK cycle
    pins_.neN = 0xF;
    pins_.nblN = 3;
    pins_.dOut = false;
    show();
}

void FsmcMaster::abort(const Access& access, unsigned hclk) {
    passHclk(hclk);
    pins_.neN = 0xF;
    show();
    pins_.noeN = pins_.nweN = pins_.nadvN = true;
    pins_.nblN = 3;
    pins_.dOut = false;
    show();
    if (pins_.dDriven && !delays_)
        throw FsmcError(access.name + ": the access was aborted, and the data bus is still driven");
    passHclk(8); // a few idle cycles; a real reset of the processor takes far longer
}

void FsmcMaster::abortRead(uint32_t address, unsigned hclk) {
    Access access = decode(address, false);
    turnaround(access);
    addressPhase(access, 0, 3);
    abort(access, hclk);
}

void FsmcMaster::abortWrite(uint32_t address, uint16_t value, unsigned hclk) {
    Access access = decode(address, true);
    turnaround(access);
    addressPhase(access, value, 3);
    abort(access, hclk);
}

uint8_t FsmcMaster::read8(uint32_t address) {
    return static_cast<uint8_t>(readPins(address & ~1u) >> (address & 1 ? 8 : 0));
}

void FsmcMaster::write8(uint32_t address, uint8_t value) {
    writePins(address & ~1u, static_cast<uint16_t>(value | value << 8), address & 1 ? 2 : 1);
}

uint16_t FsmcMaster::read16(uint32_t address) {
    return readPins(address);
}
void FsmcMaster::write16(uint32_t address, uint16_t value) {
    writePins(address, value, 3);
}

uint32_t FsmcMaster::read32(uint32_t address) {
    if (address >= registersAt)
        return fsmcRegister(address);
    uint32_t low = readPins(address);
    uint32_t value = low | static_cast<uint32_t>(readPins(address + 2)) << 16;
    if (onWord)
        onWord(address, value, false);
    return value;
}

void FsmcMaster::write32(uint32_t address, uint32_t value) {
    if (address >= registersAt) {
        fsmcRegister(address) = value;
        return passHclk(1); // data phase of the AHB
    }
    writePins(address, static_cast<uint16_t>(value), 3);
    writePins(address + 2, static_cast<uint16_t>(value >> 16), 3);
    if (onWord)
        onWord(address, value, true);
}
