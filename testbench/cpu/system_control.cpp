// SPDX-License-Identifier: MIT
//
// system_control: SysTick as a due time, NVIC and SCB (ARMv7-M ARM, B3.2) as views of Exceptions,
// the MPU (B3.5) as a list of guards.

#include "system_control.h"

namespace {

constexpr uint32_t dwt = 0xE0001000, scs = 0xE000E000;
constexpr uint32_t keyIn = 0x05FA, keyOut = 0xFA05;

// Exceptions 4..15 have their priorities in SHPR1..3; those that exist:
bool hasPriority(unsigned number) {
    return (number >= MemManage && number <= UsageFault) || number == SupervisorCall ||
           number == DebugMonitor || number == PendSv || number == SysTick;
}

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
    if (!readWord(address & ~3u, word))
        return false;
    value = word >> 8 * (address & 3);
    if (size < 4)
        value &= (1u << 8 * size) - 1;
    return true;
}

bool SystemControl::write(uint32_t address, unsigned size, uint32_t value) {
    if (size == 4)
        return writeWord(address, value);
    // Only the priority registers may be written in bytes (B3.1.1).
    uint32_t at = address & 0xFFF;
    bool priorities = (at >= 0x400 && at < 0x4F0) || (at >= 0xD18 && at < 0xD24);
    uint32_t word;
    if (address < scs || !priorities || !readWord(address & ~3u, word))
        return false;
    uint32_t mask = ((1u << 8 * size) - 1) << 8 * (address & 3);
    return writeWord(address & ~3u, (word & ~mask) | (value << 8 * (address & 3) & mask));
}

bool SystemControl::readWord(uint32_t address, uint32_t& value) {
    if (address == dwt || address == dwt + 4) {
        value = address == dwt ? dwtControl_ : static_cast<uint32_t>(cycles_ - cycleCountFrom_);
        return true;
    }
    if (address < scs)
        return false;
    uint32_t at = address - scs;
    if (at >= 0x100 && at < 0x380) { // ISER, ICER, ISPR, ICPR, IABR
        constexpr auto enabled = &Exceptions::State::enabled, pending = &Exceptions::State::pending;
        constexpr bool Exceptions::State::* views[] = {enabled, enabled, pending, pending,
                                                       &Exceptions::State::active};
        const unsigned first = (at & 0x7F) * 8;
        value = 0;
        for (unsigned b = 0; b < 32 && first + b < Exceptions::interrupts; ++b)
            value |=
                uint32_t((*exceptions_)[FirstInterrupt + first + b].*views[(at - 0x100) / 0x80])
                << b;
        return true;
    }
    if (at >= 0x400 && at < 0x400 + ((Exceptions::interrupts + 3) & ~3u)) {
        value = 0;
        for (unsigned b = 0; b < 4 && at - 0x400 + b < Exceptions::interrupts; ++b)
            value |= uint32_t(priorityByte(FirstInterrupt + at - 0x400 + b)) << 8 * b;
        return true;
    }
    switch (at) {
    case 0x004:
        value = (Exceptions::interrupts - 1) / 32;
        return true; // ICTR
    case 0x010:
        value = control_ | uint32_t(countFlag_) << 16;
        countFlag_ = false;
        return true;
    case 0x018:
        value = currentTicks();
        return true;
    case 0x01C:
        value = calibration_;
        return true;
    }
    if (at >= 0xD90 && at < 0xDA8)
        return accessMpu(at - 0xD90, false, value);
    for (const Stored& r : stored)
        if (r.at == at) {
            value = this->*r.value;
            return true;
        }
    return readScb(at, value);
}

bool SystemControl::writeWord(uint32_t address, uint32_t value) {
    if (address == dwt || address == dwt + 4) {
        if (address == dwt)
            dwtControl_ = value;
        else
            cycleCountFrom_ = cycles_ - value;
        return true;
    }
    if (address < scs)
        return false;
    uint32_t at = address - scs;
    if (at >= 0x100 && at < 0x300) { // ISER, ICER, ISPR, ICPR
        const bool on = !(at & 0x80);
        const unsigned first = (at & 0x7F) * 8;
        for (unsigned b = 0; b < 32 && first + b < Exceptions::interrupts; ++b) {
            const unsigned number = FirstInterrupt + first + b;
            if (value >> b & 1)
                at < 0x200 ? exceptions_->enable(number, on) : exceptions_->pend(number, on);
        }
        return true;
    }
    if (at >= 0x400 && at < 0x400 + ((Exceptions::interrupts + 3) & ~3u)) {
        for (unsigned b = 0; b < 4 && at - 0x400 + b < Exceptions::interrupts; ++b)
            exceptions_->setPriority(FirstInterrupt + at - 0x400 + b,
                                     static_cast<uint8_t>(value >> 8 * b));
        return true;
    }
    switch (at) {
    case 0x010: {
        stoppedAt_ = currentTicks();
        bool wasOn = control_ & 1;
        control_ = value & 7;
        if (!(control_ & 1))
            tickDue_ = ~0ull;
        else if (!wasOn)
            startSysTick(stoppedAt_ ? stoppedAt_ : uint64_t(load_) + 1);
        return true;
    }
    case 0x018: // any value clears it: it is loaded at the next tick
        stoppedAt_ = 0;
        countFlag_ = false;
        if (control_ & 1)
            startSysTick(uint64_t(load_) + 1);
        return true;
    case 0xF00: // STIR
        if ((value & 0x1FF) < Exceptions::interrupts)
            exceptions_->pend(FirstInterrupt + (value & 0x1FF));
        return true;
    }
    if (at >= 0xD90 && at < 0xDA8)
        return accessMpu(at - 0xD90, true, value);
    for (const Stored& r : stored)
        if (r.at == at) {
            this->*r.value = r.clears ? this->*r.value & ~value : value & r.kept;
            return !(value & r.unknown);
        }
    return writeScb(at, value);
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

bool SystemControl::readScb(uint32_t at, uint32_t& value) {
    auto flag = [&](unsigned number, unsigned bit, bool Exceptions::State::* what) {
        value |= uint32_t((*exceptions_)[number].*what) << bit;
    };
    constexpr auto active = &Exceptions::State::active, pending = &Exceptions::State::pending,
                   enabled = &Exceptions::State::enabled;
    value = 0;
    switch (at) {
    case 0xD00:
        value = 0x412FC230;
        return true; // CPUID: r2p0, an STM32F2's
    case 0xD04:      // ICSR; VECTACTIVE is the processor's IPSR
        for (unsigned n = 1; n < Exceptions::count; ++n)
            if ((*exceptions_)[n].active &&
                exceptions_->priorityOf(n) <= exceptions_->runningPriority())
                value = n;
        value |= uint32_t(exceptions_->activeCount() <= 1) << 11 | exceptions_->firstPending()
                                                                       << 12;
        flag(SysTick, 26, pending);
        flag(PendSv, 28, pending);
        flag(NonMaskable, 31, pending);
        return true;
    case 0xD0C:
        value = keyOut << 16 | exceptions_->grouping() << 8;
        return true;
    case 0xD18:
    case 0xD1C:
    case 0xD20:
        for (unsigned b = 0, n = at - 0xD14; b < 4; ++b)
            value |= uint32_t(priorityByte(n + b)) << 8 * b;
        return true;
    case 0xD24:
        flag(MemManage, 0, active), flag(BusFault, 1, active), flag(UsageFault, 3, active);
        flag(SupervisorCall, 7, active), flag(PendSv, 10, active), flag(SysTick, 11, active);
        flag(UsageFault, 12, pending), flag(MemManage, 13, pending), flag(BusFault, 14, pending);
        flag(MemManage, 16, enabled), flag(BusFault, 17, enabled), flag(UsageFault, 18, enabled);
        return true;
    default:
        return false;
    }
}

bool SystemControl::writeScb(uint32_t at, uint32_t value) {
    switch (at) {
    case 0xD04:
        if (value >> 31)
            exceptions_->pend(NonMaskable);
        if (value >> 28 & 1)
            exceptions_->pend(PendSv);
        if (value >> 27 & 1)
            exceptions_->pend(PendSv, false);
        if (value >> 26 & 1)
            exceptions_->pend(SysTick);
        if (value >> 25 & 1)
            exceptions_->pend(SysTick, false);
        return true;
    case 0xD0C:
        if (value >> 16 != keyIn)
            return true; // ignored without the key
        exceptions_->setGrouping(value >> 8);
        resetRequested_ = resetRequested_ || (value & 4);
        return true;
    case 0xD18:
    case 0xD1C:
    case 0xD20:
        for (unsigned b = 0, n = at - 0xD14; b < 4; ++b)
            if (hasPriority(n + b))
                exceptions_->setPriority(n + b, static_cast<uint8_t>(value >> 8 * b));
        return true;
    case 0xD24:
        exceptions_->enable(MemManage, value >> 16 & 1);
        exceptions_->enable(BusFault, value >> 17 & 1);
        exceptions_->enable(UsageFault, value >> 18 & 1);
        return true;
    default:
        return false;
    }
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
