// SPDX-License-Identifier: MIT
//
// system_block: the SCB's registers (ARMv7-M ARM, B3.2) and the MPU's (B3.5) of SystemControl.

#include "system_control.h"

namespace {

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
    case 0xD08:
        value = vtor_;
        return true;
    case 0xD0C:
        value = keyOut << 16 | exceptions_->grouping() << 8;
        return true;
    case 0xD10:
        value = scr_;
        return true;
    case 0xD14:
        value = ccr_;
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
    case 0xD28:
        value = cfsr_;
        return true;
    case 0xD2C:
        value = hfsr_;
        return true;
    case 0xD34:
        value = mmfar_;
        return true;
    case 0xD38:
        value = bfar_;
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
    case 0xD08:
        vtor_ = value & 0x3FFFFF80;
        return true;
    case 0xD0C:
        if (value >> 16 != keyIn)
            return true; // ignored without the key
        exceptions_->setGrouping(value >> 8);
        resetRequested_ = resetRequested_ || (value & 4);
        return true;
    case 0xD10:
        scr_ = value;
        return !(value & 2); // SLEEPONEXIT is not modelled
    case 0xD14:
        ccr_ = value;
        return !(value & 0x18); // nor are the traps of unaligned accesses and divisions by zero
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
    case 0xD28:
        cfsr_ &= ~value;
        return true;
    case 0xD2C:
        hfsr_ &= ~value;
        return true;
    case 0xD34:
        mmfar_ = value;
        return true;
    case 0xD38:
        bfar_ = value;
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
