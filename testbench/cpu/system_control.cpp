// SPDX-License-Identifier: MIT
//
// system_control: SysTick as a due time, NVIC and SCB (ARMv7-M ARM, B3.2) as views of Exceptions,
// the MPU (B3.5) as a list of guards.

#include "system_control.h"

namespace {

constexpr uint32_t dwt = 0xE0001000, scs = 0xE000E000;
constexpr uint32_t keyIn = 0x05FA, keyOut = 0xFA05;

// Exceptions 4..15 have their priorities in SHPR1..3; those that exist, and interrupts:
bool hasPriority(unsigned number) {
    return number >= FirstInterrupt || (number >= MemManage && number <= UsageFault) ||
           number == SupervisorCall || number == DebugMonitor || number == PendSv ||
           number == SysTick;
}

// Bits of ICSR that make an exception pending, or take that back.
constexpr struct {
    unsigned bit, number;
    bool on;
} pends[] = {{31, NonMaskable, true},
             {28, PendSv, true},
             {27, PendSv, false},
             {26, SysTick, true},
             {25, SysTick, false}};

// RASR.AP for privileged code: 0 no access; 5 to 7 read only.
bool forbids(uint32_t rasr, bool write) {
    uint32_t access = rasr >> 24 & 7;
    return access == 0 || (write && access >= 5);
}

} // namespace

// Registers that store what is written to them. A value with unknown bits is refused.
struct SystemControl::Stored {
    uint32_t at;
    uint32_t SystemControl::* value;
    uint32_t kept = ~0u, unknown = 0;
    bool clears = false; // ones that are written
};
const SystemControl::Stored SystemControl::stored[] = {
    {0x008, &SystemControl::actlr_, ~0u, ~2u}, // DISDEFWBUF is modelled
    {0x014, &SystemControl::load_, 0xFFFFFF},
    {0xD08, &SystemControl::vtor_, 0x3FFFFF80},
    {0xD10, &SystemControl::scr_, ~0u, 2}, // SLEEPONEXIT is not
    // Traps of unaligned accesses and divisions by zero are not modelled.
    {0xD14, &SystemControl::ccr_, ~0u, 0x18},
    {0xD28, &SystemControl::cfsr_, 0, 0, true},
    {0xD2C, &SystemControl::hfsr_, 0, 0, true},
    {0xD34, &SystemControl::mmfar_},
    {0xD38, &SystemControl::bfar_},
    {0xDFC, &SystemControl::demcr_}};

void SystemControl::reset() {
    uint64_t cycles = cycles_;
    *this = SystemControl(*exceptions_, calibration_);
    cycles_ = cycles;
    exceptions_->reset();
}

void SystemControl::startSysTick(uint64_t ticks) {
    tickDue_ = cycles_ + ticks * tickUnit();
}

void SystemControl::tick() {
    while (cycles_ >= tickDue_) {
        countFlag_ = true;
        if (control_ & 2)
            exceptions_->pend(SysTick);
        tickDue_ = load_ ? tickDue_ + (uint64_t(load_) + 1) * tickUnit() : ~0ull;
    }
}

uint32_t SystemControl::currentTicks() const {
    if (!(control_ & 1) || tickDue_ == ~0ull)
        return stoppedAt_;
    return static_cast<uint32_t>((tickDue_ - cycles_) / tickUnit()) & 0xFFFFFF;
}

bool SystemControl::read(uint32_t address, unsigned size, uint32_t& value) {
    uint32_t word;
    if (!accessWord(address & ~3u, false, word))
        return false;
    value = word >> 8 * (address & 3);
    if (size < 4)
        value &= (1u << 8 * size) - 1;
    return true;
}

bool SystemControl::write(uint32_t address, unsigned size, uint32_t value) {
    if (size == 4)
        return accessWord(address, true, value);
    // Only the priority registers may be written in bytes (B3.1.1).
    uint32_t at = address & 0xFFF;
    bool priorities = (at >= 0x400 && at < 0x4F0) || (at >= 0xD18 && at < 0xD24);
    uint32_t word;
    if (address < scs || !priorities || !accessWord(address & ~3u, false, word))
        return false;
    uint32_t mask = ((1u << 8 * size) - 1) << 8 * (address & 3);
    word = (word & ~mask) | (value << 8 * (address & 3) & mask);
    return accessWord(address & ~3u, true, word);
}

bool SystemControl::accessWord(uint32_t address, bool write, uint32_t& value) {
    if (address == dwt) {
        (write ? dwtControl_ : value) = write ? value : dwtControl_;
        return true;
    }
    if (address == dwt + 4) {
        if (write)
            cycleCountFrom_ = cycles_ - value;
        else
            value = static_cast<uint32_t>(cycles_ - cycleCountFrom_);
        return true;
    }
    if (address < scs)
        return false;
    uint32_t at = address - scs;
    if (at >= 0x100 && at < (write ? 0x300 : 0x380)) // ISER, ICER, ISPR, ICPR, IABR
        return accessInterrupts(at - 0x100, write, value);
    if (at >= 0x400 && at < 0x400 + ((Exceptions::interrupts + 3) & ~3u))
        return accessPriorities(FirstInterrupt + at - 0x400, write, value);
    if (at >= 0xD18 && at < 0xD24)
        return accessPriorities(at - 0xD14, write, value);
    if (at >= 0xD90 && at < 0xDA8)
        return accessMpu(at - 0xD90, write, value);
    for (const Stored& r : stored)
        if (r.at == at) {
            uint32_t& own = this->*r.value;
            const bool isKnown = !write || !(value & r.unknown);
            if (write)
                own = r.clears ? own & ~value : value & r.kept;
            else
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
    uint32_t shown = 0;
    for (unsigned n = 1; n < Exceptions::count; ++n)
        if (all[n].active && all.priorityOf(n) <= all.runningPriority())
            shown = n;
    return shown | uint32_t(all.activeCount() <= 1) << 11 | all.firstPending() << 12 |
           uint32_t(all[SysTick].pending) << 26 | uint32_t(all[PendSv].pending) << 28 |
           uint32_t(all[NonMaskable].pending) << 31;
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
    case 0x018: // any value that is written clears it: it is loaded at the next tick
        shown = currentTicks();
        if (!write)
            break;
        stoppedAt_ = 0;
        countFlag_ = false;
        if (control_ & 1)
            startSysTick(uint64_t(load_) + 1);
        break;
    case 0x01C:
        shown = calibration_;
        break;
    case 0xD00: // CPUID: r2p0, an STM32F2's
        shown = 0x412FC230;
        break;
    case 0xD04: // ICSR; VECTACTIVE is the processor's IPSR
        shown = interruptState();
        for (const auto& [bit, number, on] : pends)
            if (given >> bit & 1)
                exceptions_->pend(number, on);
        break;
    case 0xD0C:
        shown = keyOut << 16 | exceptions_->grouping() << 8;
        if (given >> 16 != keyIn)
            break; // ignored without the key
        exceptions_->setGrouping(given >> 8);
        resetRequested_ = resetRequested_ || (given & 4);
        break;
    case 0xD24:
        shown = handlerState();
        for (unsigned number : {MemManage, BusFault, UsageFault})
            if (write)
                exceptions_->enable(number, given >> (12 + number) & 1);
        break;
    case 0xF00: // STIR
        if (write && (given & 0x1FF) < Exceptions::interrupts)
            exceptions_->pend(FirstInterrupt + (given & 0x1FF));
        return write;
    default:
        return false;
    }
    value = write ? value : shown;
    return !(write && (at == 0x004 || at == 0x01C || at == 0xD00)); // these are read only
}

void SystemControl::controlSysTick(uint32_t value) {
    stoppedAt_ = currentTicks();
    bool wasOn = control_ & 1;
    control_ = value & 7;
    if (!(control_ & 1))
        tickDue_ = ~0ull;
    else if (!wasOn)
        startSysTick(stoppedAt_ ? stoppedAt_ : uint64_t(load_) + 1);
}

bool SystemControl::accessMpu(uint32_t at, bool write, uint32_t& value) {
    Region& region = region_[mpuRegion_];
    switch (at) {
    case 0x0:
        value = regions << 8;
        return !write; // TYPE
    case 0x4:
        write ? mpuControl_ = value& 7 : value = mpuControl_;
        break;
    case 0x8:
        write ? mpuRegion_ = value& 7 : value = mpuRegion_;
        break;
    case 0xC:
        if (write && (value & 0x10)) // VALID: REGION is in the low bits
            mpuRegion_ = value & 7;
        if (write)
            region_[mpuRegion_].rbar = value & ~0x1Fu;
        else
            value = region.rbar | mpuRegion_;
        break;
    case 0x10:
        write ? region.rasr = value : value = region.rasr;
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
    if (mpuControl_ & 1)
        for (const Region& r : region_)
            guards_ += (r.rasr & 1) && forbids(r.rasr, true);
}

bool SystemControl::hitsGuard(uint32_t start, uint32_t bytes, bool write) const {
    for (const Region& r : region_) {
        if (!(r.rasr & 1) || !forbids(r.rasr, write))
            continue;
        uint64_t size = 2ull << (r.rasr >> 1 & 0x1F);
        uint64_t base = r.rbar & ~(size - 1);
        if (start < base + size && uint64_t(start) + bytes > base)
            return true;
    }
    return false;
}
