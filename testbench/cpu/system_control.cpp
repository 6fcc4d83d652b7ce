// SPDX-License-Identifier: MIT
//
// system_control: SysTick as a due time, NVIC and SCB as views of Exceptions, the MPU as a list of
// guards.

#include "system_control.h"

namespace {

constexpr uint32_t dwt = 0xE0001000, scs = 0xE000E000;

} // namespace

void SystemControl::reset() {
    uint64_t cycles = cycles_;
    *this = SystemControl(*exceptions_, calibration_);
    cycles_ = cycles;
    exceptions_->reset();
}

// ---- SysTick ----

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

// ---- access by size ----

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
    auto bitsOf = [&](uint32_t base, auto test) {
        value = 0;
        for (unsigned b = 0, n = (at - base) * 8; b < 32 && n + b < Exceptions::interrupts; ++b)
            value |= uint32_t(test((*exceptions_)[FirstInterrupt + n + b])) << b;
        return true;
    };
    switch (at & ~0x7Fu) {
    case 0x100:
        return bitsOf(0x100, [](auto& s) { return s.enabled; });
    case 0x180:
        return bitsOf(0x180, [](auto& s) { return s.enabled; });
    case 0x200:
        return bitsOf(0x200, [](auto& s) { return s.pending; });
    case 0x280:
        return bitsOf(0x280, [](auto& s) { return s.pending; });
    case 0x300:
        return bitsOf(0x300, [](auto& s) { return s.active; });
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
    case 0x008:
        value = actlr_;
        return true;
    case 0x010:
        value = control_ | uint32_t(countFlag_) << 16;
        countFlag_ = false;
        return true;
    case 0x014:
        value = load_;
        return true;
    case 0x018:
        value = currentTicks();
        return true;
    case 0x01C:
        value = calibration_;
        return true;
    case 0xDFC:
        value = demcr_;
        return true;
    }
    if (at >= 0xD90 && at < 0xDA8)
        return accessMpu(at - 0xD90, false, value);
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
    auto each = [&](uint32_t base, auto act) {
        for (unsigned b = 0, n = (at - base) * 8; b < 32 && n + b < Exceptions::interrupts; ++b)
            if (value >> b & 1)
                act(FirstInterrupt + n + b);
        return true;
    };
    switch (at & ~0x7Fu) {
    case 0x100:
        return each(0x100, [&](unsigned n) { exceptions_->enable(n, true); });
    case 0x180:
        return each(0x180, [&](unsigned n) { exceptions_->enable(n, false); });
    case 0x200:
        return each(0x200, [&](unsigned n) { exceptions_->pend(n); });
    case 0x280:
        return each(0x280, [&](unsigned n) { exceptions_->pend(n, false); });
    }
    if (at >= 0x400 && at < 0x400 + ((Exceptions::interrupts + 3) & ~3u)) {
        for (unsigned b = 0; b < 4 && at - 0x400 + b < Exceptions::interrupts; ++b)
            exceptions_->setPriority(FirstInterrupt + at - 0x400 + b,
                                     static_cast<uint8_t>(value >> 8 * b));
        return true;
    }
    switch (at) {
    case 0x008:
        actlr_ = value;
        return !(value & ~2u); // only DISDEFWBUF is modelled
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
    case 0x014:
        load_ = value & 0xFFFFFF;
        return true;
    case 0x018: // any value clears it: it is loaded at the next tick
        stoppedAt_ = 0;
        countFlag_ = false;
        if (control_ & 1)
            startSysTick(uint64_t(load_) + 1);
        return true;
    case 0xDFC:
        demcr_ = value;
        return true;
    case 0xF00: // STIR
        if ((value & 0x1FF) < Exceptions::interrupts)
            exceptions_->pend(FirstInterrupt + (value & 0x1FF));
        return true;
    }
    if (at >= 0xD90 && at < 0xDA8)
        return accessMpu(at - 0xD90, true, value);
    return writeScb(at, value);
}
