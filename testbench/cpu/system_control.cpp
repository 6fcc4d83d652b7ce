// SPDX-License-Identifier: MIT
//
// system_control: models the system registers of a Cortex-M3 (ARMv7-M ARM). SysTick is modelled as
// the time at which it is next due. The registers of NVIC and SCB (B3.2) read and write the class
// Exceptions. The MPU (B3.5) is a list of regions.

#include "system_control.h"
#include <cstdio>

namespace {

constexpr uint32_t dwt = 0xE0001000, scs = 0xE000E000;
constexpr uint32_t keyIn = 0x05FA, keyOut = 0xFA05;

// Returns true if the exception has a configurable priority. These are all interrupts, and those
// exceptions 4..15 that exist (SHPR1..3).
bool hasPriority(unsigned number) {
    return number >= FirstInterrupt || (number >= MemManage && number <= UsageFault) ||
           number == SupervisorCall || number == DebugMonitor || number == PendSv ||
           number == SysTick;
}

// Bits of ICSR that set or clear the pending state of an exception.
constexpr struct {
    unsigned bit, number;
    bool on;
} pends[] = {{31, NonMaskable, true},
             {28, PendSv, true},
             {27, PendSv, false},
             {26, SysTick, true},
             {25, SysTick, false}};

std::string hex(uint32_t value) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%08X", value);
    return text;
}

constexpr uint32_t traceEnabled = 1u << 24; // TRCENA in DEMCR
constexpr uint32_t comparators = 4u << 28;  // number of comparators in DWT_CTRL
constexpr uint32_t rasrBits = 0x173FFF3F;   // bits of RASR that are not reserved

// Returns true if RASR.AP forbids the access to privileged code: AP 0 forbids every access, AP 5 to
// 7 forbid writes.
bool forbids(uint32_t rasr, bool write) {
    uint32_t access = rasr >> 24 & 7;
    return access == 0 || (write && access >= 5);
}

// Returns true if RASR forbids execution, either by XN or because the region cannot be read.
bool forbidsToExecute(uint32_t rasr) {
    return (rasr >> 28 & 1) || forbids(rasr, false);
}

// Returns whether an address is in CFSR.
bool isStatus(uint32_t address) {
    return address >= scs + 0xD28 && address < scs + 0xD2C;
}

// Returns whether a register can be accessed by bytes and halfwords: the priority registers and
// CFSR (B3.1.1, B3.2.15).
bool hasBytes(uint32_t address) {
    return (address >= scs + 0x400 && address < scs + 0x4F0) ||
           (address >= scs + 0xD18 && address < scs + 0xD24) || isStatus(address);
}

} // namespace

// Registers that only store the written value. The bits in `unknown` are not modelled: the model
// reports a program that sets one of them.
struct SystemControl::Stored {
    uint32_t at;
    uint32_t SystemControl::* value;
    uint32_t kept = ~0u, unknown = 0;
    bool clears = false; // true: writing 1 to a bit clears it
};
const SystemControl::Stored SystemControl::stored[] = {
    {0x008, &SystemControl::actlr_, ~0u, ~2u}, // only the bit DISDEFWBUF is modelled
    // The vector table has 97 entries, so its address is a multiple of 512.
    {0xD08, &SystemControl::vtor_, 0x3FFFFF80, 0x1FF},
    {0xD10, &SystemControl::scr_, 0, 0x16}, // not modelled: SLEEPONEXIT, SLEEPDEEP, SEVONPEND
    // not modelled: NONBASETHRDENA, USERSETMPEND, UNALIGN_TRP, DIV_0_TRP, BFHFNMIGN
    {0xD14, &SystemControl::ccr_, 0x200, 0x11B},
    {0xD28, &SystemControl::cfsr_, 0, 0, true},
    {0xD2C, &SystemControl::hfsr_, 0, 0, true},
    {0xD34, &SystemControl::mmfar_},
    {0xD38, &SystemControl::bfar_}};

void SystemControl::reset() {
    uint64_t cycles = cycles_;
    *this = SystemControl(*exceptions_, calibration_);
    cycles_ = cycles;
    exceptions_->reset();
}

void SystemControl::startSysTick(uint64_t ticks) {
    period_ = ticks;
    tickDue_ = ticks ? cycles_ + ticks * tickUnit() : ~0ull;
}

void SystemControl::tick() {
    while (cycles_ >= tickDue_) {
        countFlag_ = true;
        if (control_ & 2)
            exceptions_->pend(SysTick);
        period_ = reload();
        tickDue_ = load_ ? tickDue_ + period_ * tickUnit() : ~0ull;
        stoppedAt_ = 0;
    }
}

uint32_t SystemControl::currentTicks() const {
    if (!(control_ & 1) || tickDue_ == ~0ull)
        return stoppedAt_;
    const uint64_t ticks = (tickDue_ - cycles_ + tickUnit() - 1) / tickUnit();
    return ticks >= period_ && period_ == uint64_t(load_) + 1 ? 0 : static_cast<uint32_t>(ticks);
}

uint32_t SystemControl::read(uint32_t address, unsigned size) {
    uint32_t word = 0;
    if (address % size)
        throw NotModelled("an unaligned access to the system register " + hex(address));
    if (size < 4 && !hasBytes(address))
        throw NotModelled("a read of " + std::to_string(8 * size) +
                          " bits from the system register " + hex(address));
    if (!accessWord(address & ~3u, false, word))
        throw NotModelled("a read of the system register " + hex(address & ~3u));
    word >>= 8 * (address & 3);
    return size < 4 ? word & ((1u << 8 * size) - 1) : word;
}

void SystemControl::write(uint32_t address, unsigned size, uint32_t value) {
    auto refuse = [&] {
        throw NotModelled("a write of " + std::to_string(8 * size) + " bits, " + hex(value) +
                          ", to the system register " + hex(address));
    };
    if (address % size)
        refuse();
    if (size == 4) {
        if (!accessWord(address, true, value))
            refuse();
        return;
    }
    uint32_t word = 0;
    if (!hasBytes(address) || !accessWord(address & ~3u, false, word))
        refuse();
    const uint32_t mask = ((1u << 8 * size) - 1) << 8 * (address & 3);
    word = ((isStatus(address) ? 0 : word) & ~mask) | (value << 8 * (address & 3) & mask);
    accessWord(address & ~3u, true, word);
}

// CYCCNT counts while DEMCR.TRCENA and DWT_CTRL.CYCCNTENA are set.
uint64_t SystemControl::countedCycles() const {
    return (demcr_ & traceEnabled) && (dwtControl_ & 1) ? cycles_ - cycleCountFrom_ : stoppedCount_;
}

void SystemControl::controlCycleCounter(uint32_t demcr, uint32_t control) {
    stoppedCount_ = static_cast<uint32_t>(countedCycles());
    demcr_ = demcr;
    dwtControl_ = control;
    cycleCountFrom_ = cycles_ - stoppedCount_;
}

bool SystemControl::accessWord(uint32_t address, bool write, uint32_t& value) {
    const bool isTraced = demcr_ & traceEnabled; // without TRCENA, DWT ignores writes
    if (address == dwt) {
        if (write && isTraced && (value & 0x0FFFFFFE))
            return false; // the other counters and PC sampling are not modelled
        if (write && isTraced)
            controlCycleCounter(demcr_, value & 1);
        else if (!write)
            value = dwtControl_ | comparators;
        return true;
    }
    if (address == dwt + 4) {
        if (write && isTraced)
            cycleCountFrom_ = cycles_ - value, stoppedCount_ = value;
        else if (!write)
            value = static_cast<uint32_t>(countedCycles());
        return true;
    }
    if (address < scs)
        return false;
    uint32_t at = address - scs;
    if (at >= 0x100 && at < (write ? 0x300 : 0x380)) // ISER, ICER, ISPR, ICPR, IABR
        return accessInterrupts(at - 0x100, write, value);
    if (at >= 0x300 && at < 0x380)
        return true; // IABR is read-only, so a write to it is ignored
    if (at >= 0x400 && at < 0x4F0)
        return accessPriorities(FirstInterrupt + at - 0x400, write, value);
    if (at >= 0xD18 && at < 0xD24)
        return accessPriorities(at - 0xD14, write, value);
    if (at >= 0xD90 && at < 0xDBC)
        return accessMpu(at - 0xD90, write, value);
    for (const Stored& r : stored)
        if (r.at == at) {
            uint32_t& own = this->*r.value;
            const bool isKnown = !write || !(value & r.unknown);
            if (write && isKnown)
                own = r.clears ? own & ~value : value & r.kept;
            else if (!write)
                value = own;
            return isKnown;
        }
    return accessOther(at, write, value);
}

bool SystemControl::accessInterrupts(uint32_t at, bool write, uint32_t& value) {
    const unsigned first = FirstInterrupt + (at & 0x7F) * 8, kind = at / 0x80;
    const bool on = !(kind & 1);
    uint32_t shown = 0;
    for (unsigned b = 0; b < 32 && first + b < Exceptions::count; ++b) {
        const Exceptions::State& s = (*exceptions_)[first + b];
        shown |= uint32_t(kind < 2 ? s.enabled : kind < 4 ? s.pending : s.active) << b;
        if (write && (value >> b & 1))
            kind < 2 ? exceptions_->enable(first + b, on) : exceptions_->pend(first + b, on);
    }
    value = write ? value : shown;
    return true;
}

bool SystemControl::accessPriorities(unsigned first, bool write, uint32_t& value) {
    uint32_t shown = 0;
    for (unsigned b = 0; b < 4 && first + b < Exceptions::count; ++b) {
        if (write && hasPriority(first + b))
            exceptions_->setPriority(first + b, static_cast<uint8_t>(value >> 8 * b));
        shown |= uint32_t((*exceptions_)[first + b].priority) << 8 * b;
    }
    value = write ? value : shown;
    return true;
}

bool SystemControl::takeResetRequest() {
    bool was = resetRequested_;
    resetRequested_ = false;
    return was;
}

void SystemControl::setFaultAddress(uint32_t cfsrBits, uint32_t address) {
    cfsr_ |= cfsrBits;
    (cfsrBits & mmfarValid ? mmfar_ : bfar_) = address;
}

uint32_t SystemControl::interruptState() const {
    const Exceptions& all = *exceptions_;
    // ISRPENDING of ICSR: true if an interrupt is pending (exceptions 0 to 15 do not count)
    bool isPending = false;
    for (unsigned n = FirstInterrupt; n < Exceptions::count; ++n)
        isPending = isPending || all[n].pending;
    return all.current() | uint32_t(all.activeCount() <= 1) << 11 | all.firstPending() << 12 |
           uint32_t(isPending) << 22 | uint32_t(all[SysTick].pending) << 26 |
           uint32_t(all[PendSv].pending) << 28 | uint32_t(all[NonMaskable].pending) << 31;
}

uint32_t SystemControl::handlerState() const {
    uint32_t shown = 0;
    auto flag = [&](unsigned number, unsigned bit, bool Exceptions::State::* what) {
        shown |= uint32_t((*exceptions_)[number].*what) << bit;
    };
    constexpr auto active = &Exceptions::State::active, pending = &Exceptions::State::pending,
                   enabled = &Exceptions::State::enabled;
    flag(MemManage, 0, active), flag(BusFault, 1, active), flag(UsageFault, 3, active);
    flag(SupervisorCall, 7, active), flag(PendSv, 10, active), flag(SysTick, 11, active);
    flag(UsageFault, 12, pending), flag(MemManage, 13, pending), flag(BusFault, 14, pending);
    flag(MemManage, 16, enabled), flag(BusFault, 17, enabled), flag(UsageFault, 18, enabled);
    return shown;
}

bool SystemControl::accessOther(uint32_t at, bool write, uint32_t& value) {
    const uint32_t given = write ? value : 0;
    uint32_t shown = 0;
    switch (at) {
    case 0x004: // ICTR
        shown = (Exceptions::interrupts - 1) / 32;
        break;
    case 0x010: // SysTick
        shown = control_ | uint32_t(countFlag_) << 16;
        if (write)
            controlSysTick(given);
        else
            countFlag_ = false;
        break;
    case 0x014:
        shown = load_;
        if (write)
            loadSysTick(given & 0xFFFFFF);
        break;
    case 0x018: // writing any value clears the counter; it is reloaded at the next tick
        shown = currentTicks();
        if (!write)
            break;
        stoppedAt_ = 0;
        countFlag_ = false;
        if (control_ & 1)
            startSysTick(reload());
        break;
    case 0x01C:
        shown = calibration_;
        break;
    case 0xD00: // CPUID of an STM32F2: r2p0
        shown = 0x412FC230;
        break;
    case 0xD04: // ICSR
        shown = interruptState();
        for (const auto& [bit, number, on] : pends)
            if (given >> bit & 1)
                exceptions_->pend(number, on);
        break;
    case 0xD0C:
        shown = keyOut << 16 | exceptions_->grouping() << 8;
        if (given >> 16 != keyIn)
            break; // without the key, the write is ignored
        if (given & 3)
            // VECTRESET and VECTCLRACTIVE are reserved for debuggers, so they are not modelled
            return false;
        exceptions_->setGrouping(given >> 8);
        resetRequested_ = resetRequested_ || (given & 4);
        break;
    case 0xD24:
        shown = handlerState();
        if (write && ((given ^ shown) & 0xFFFF))
            // a program that changes the pending or active state of system exceptions is not
            // modelled
            return false;
        for (unsigned number : {MemManage, BusFault, UsageFault})
            if (write)
                exceptions_->enable(number, given >> (12 + number) & 1);
        break;
    case 0xD3C: // AFSR has no implemented bits
        break;
    case 0xDFC: // DEMCR; only TRCENA is modelled, because the other bits are for debuggers
        shown = demcr_;
        if (given & ~traceEnabled)
            return false;
        if (write)
            controlCycleCounter(given, dwtControl_);
        break;
    case 0xF00: // STIR
        if (write && (given & 0x1FF) < Exceptions::interrupts)
            exceptions_->pend(FirstInterrupt + (given & 0x1FF));
        return write;
    default:
        return false;
    }
    value = write ? value : shown; // a write to a read-only register has no effect
    return true;
}

// A new reload value takes effect when the counter reaches zero the next time, or at once if the
// counter is zero.
void SystemControl::loadSysTick(uint32_t value) {
    load_ = value;
    if ((control_ & 1) && tickDue_ == ~0ull && stoppedAt_ == 0 && value)
        startSysTick(uint64_t(value) + 1);
}

void SystemControl::controlSysTick(uint32_t value) {
    const uint32_t before = currentTicks();
    const bool wasOn = control_ & 1, isSameClock = !((control_ ^ value) & 4);
    control_ = value & 7;
    if (wasOn && (control_ & 1) && isSameClock)
        return;
    stoppedAt_ = before;
    if (control_ & 1)
        startSysTick(before ? before : reload());
    else
        tickDue_ = ~0ull;
}

bool SystemControl::accessMpu(uint32_t at, bool write, uint32_t& value) {
    if (at >= 0x14) // RBAR and RASR have three aliases
        at = 0xC + (at - 0xC) % 8;
    switch (at) {
    case 0x0: // TYPE, a read-only register
        value = regions << 8;
        return true;
    case 0x4:
        // Two settings are not modelled: the MPU without the default memory map as background, and
        // the MPU in the handlers of HardFault and NMI.
        if (write && (value & 1) && (value & 6) != 4)
            return false;
        write ? mpuControl_ = value& 7 : value = mpuControl_;
        for (const Region& r : region_)
            if (write && (value & 1) && (r.rasr & 1))
                checkRegion(r);
        break;
    case 0x8:
        if (write && (value & 0xFF) >= regions)
            return false;
        write ? mpuRegion_ = value& 7 : value = mpuRegion_;
        break;
    case 0xC:
        if (write && (value & 0x10) && (value & 0xF) >= regions)
            return false;
        if (write && (value & 0x10)) // VALID is set, so the low bits contain the region number
            mpuRegion_ = value & 7;
        if (write)
            region_[mpuRegion_].rbar = value & ~0x1Fu;
        else
            value = region_[mpuRegion_].rbar | mpuRegion_;
        break;
    case 0x10:
        write ? region_[mpuRegion_].rasr = value& rasrBits : value = region_[mpuRegion_].rasr;
        if (write && (mpuControl_ & 1) && (value & 1))
            checkRegion(region_[mpuRegion_]);
        break;
    default:
        return false;
    }
    if (write)
        updateGuards();
    return true;
}

void SystemControl::updateGuards() {
    guards_ = 0;
    neverFrom_ = ~0u, neverTo_ = 0;
    for (const Region& r : region_)
        if ((mpuControl_ & 1) && (r.rasr & 1)) {
            guards_ += forbids(r.rasr, true);
            if (forbidsToExecute(r.rasr)) {
                const uint32_t rest = static_cast<uint32_t>((2ull << (r.rasr >> 1 & 0x1F)) - 1);
                neverFrom_ = std::min(neverFrom_, r.rbar & ~rest);
                neverTo_ = std::max(neverTo_, r.rbar | rest);
            }
        }
}

void SystemControl::checkRegion(const Region& r) const {
    const unsigned size = r.rasr >> 1 & 0x1F;
    if (size < 4 || (r.rasr >> 24 & 7) == 4 ||
        (size < 31 && (r.rbar & ((2u << size) - 1) & ~0x1Fu)))
        throw NotModelled("an MPU region that the manual calls unpredictable, RBAR " + hex(r.rbar) +
                          ", RASR " + hex(r.rasr));
}

// Returns the region that applies to an address: the region with the highest number of all regions
// that contain the address (B3.5.3). A region of at least 256 bytes has eight subregions, and SRD
// can disable each of them.
const SystemControl::Region* SystemControl::regionAt(uint32_t address) const {
    for (unsigned n = regions; n--;) {
        const Region& r = region_[n];
        const unsigned size = r.rasr >> 1 & 0x1F; // size of the region: 2^(size + 1) bytes
        if (!(r.rasr & 1) || (size < 31 && (address ^ r.rbar) >> (size + 1)))
            continue;
        const unsigned part = size >= 7 ? address >> (size - 2) & 7 : 0;
        if (size < 7 || !(r.rasr >> (8 + part) & 1))
            return &r;
    }
    return nullptr;
}

bool SystemControl::hitsGuard(uint32_t start, uint32_t bytes, bool write) const {
    for (uint64_t at = start; at < uint64_t(start) + bytes;
         // checks one address in each 32 bytes, the size of the smallest region
         at = (at | 0x1F) + 1) {
        const Region* r = regionAt(static_cast<uint32_t>(at));
        if (r && forbids(r->rasr, write))
            return true;
    }
    return false;
}

bool SystemControl::hitsExecuteNever(uint32_t address) const {
    const Region* r = regionAt(address);
    return r && forbidsToExecute(r->rasr);
}
