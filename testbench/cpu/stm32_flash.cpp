// SPDX-License-Identifier: MIT
//
// stm32_flash: an operation changes the memory at its end; a cut one at its cut.

#include "stm32_flash.h"
#include <cstring>

namespace {

constexpr uint32_t keys[2] = {0x45670123, 0xCDEF89AB};
// Typical times (STM32F207's data sheet, flash memory characteristics) with a parallelism of 32
// bits, of sectors of 16, 64 and 128 KiB and of a word.
constexpr uint64_t eraseMs[] = {250, 550, 1000}, millisecond = 1'000'000, programNs = 16'000;

} // namespace

uint32_t Stm32Flash::sectorAt(unsigned n) {
    return n <= 4 ? n * 0x4000u : (n - 4) * 0x20000u;
}

uint32_t Stm32Flash::sectorBytes(unsigned n) {
    return n < 4 ? 0x4000 : n == 4 ? 0x10000 : 0x20000;
}

unsigned Stm32Flash::sectorOf(uint32_t offset) {
    return offset < 0x10000 ? offset / 0x4000 : offset < 0x20000 ? 4 : 4 + offset / 0x20000;
}

void Stm32Flash::unlock(uint32_t key) {
    if (keyStep_ > 1 || key != keys[keyStep_]) {
        keyStep_ = 3; // until the next reset
        throw WrongKey("a wrong key, or one too many: the flash stays locked until a reset");
    }
    if (++keyStep_ == 2) {
        cr_ &= ~Lock;
        keyStep_ = 0;
    }
}

uint32_t Stm32Flash::read(uint32_t reg) {
    settle();
    switch (reg) {
    case Acr:
        return acr_;
    case Sr:
        return sr_ | (operation_.under ? uint32_t(Bsy) : 0);
    case Cr:
        return cr_;
    default:
        return 0; // the keys' registers
    }
}

void Stm32Flash::write(uint32_t reg, uint32_t value) {
    settle();
    if (reg == Acr)
        acr_ = value;
    else if (reg == Keyr)
        unlock(value);
    else if (reg == Sr)
        sr_ &= ~value;
    if (reg != Cr || (cr_ & Lock) || operation_.under) // writes are ignored
        return;
    cr_ = value & ~Strt;
    if (!(value & Strt) || !(value & Ser))
        return;
    const unsigned sector = value >> 3 & 15, kind = sector < 4 ? 0 : sector == 4 ? 1 : 2;
    if (sector >= sectors)
        sr_ |= Pgserr;
    else
        begin({0, sectorAt(sector), sectorBytes(sector), 0, false, true},
              eraseMs[kind] * millisecond);
}

void Stm32Flash::store(uint32_t offset, unsigned size, uint32_t value) {
    settle();
    if (operation_.under) // the bus waits
        finish();
    if (!(cr_ & Pg))
        sr_ |= Pgserr;
    else if (size != 1u << (cr_ >> 8 & 3))
        sr_ |= Pgperr;
    else if (offset / 16 != (offset + size - 1) / 16)
        sr_ |= Pgaerr;
    else
        begin({0, offset, size, value, false, false}, programNs);
}

void Stm32Flash::begin(Operation operation, uint64_t ns) {
    operation_ = operation;
    operation_.under = true;
    operation_.end = now_() + ns;
    ++operations_;
    if (onOperation)
        onOperation();
}

uint64_t Stm32Flash::busyNs() const {
    const uint64_t now = now_();
    return operation_.under && operation_.end > now ? operation_.end - now : 0;
}

void Stm32Flash::settle() {
    if (operation_.under && now_() >= operation_.end)
        finish();
}

void Stm32Flash::finish() {
    operation_.under = false;
    if (operation_.erases)
        std::memset(memory_ + operation_.offset, 0xFF, operation_.size);
    else
        put(operation_.offset, operation_.size, operation_.value);
    changed(operation_.offset, operation_.size);
    if (cr_ >> 24 & 1)
        sr_ |= Eop;
}

// Clears the bits that are 0 in `value`.
void Stm32Flash::put(uint32_t offset, unsigned size, uint32_t value) {
    for (unsigned i = 0; i < size; ++i)
        memory_[offset + i] &= static_cast<uint8_t>(value >> 8 * i);
}

void Stm32Flash::changed(uint32_t offset, uint32_t size) const {
    if (onChange)
        onChange(offset, size);
}

// Leaves a cut write with some of its bits cleared. A cut erase, which first clears all bits and
// then sets them, leaves rows of 64 bytes old, cleared, erased, or in between.
void Stm32Flash::cut() {
    operation_.under = false;
    const auto [end, offset, size, value, under, erases] = operation_;
    if (!erases)
        put(offset, size, value | static_cast<uint32_t>(random_()));
    for (uint32_t row = offset; erases && row < offset + size; row += 64) {
        const unsigned kind = random_() & 3;
        for (uint32_t i = row; kind && i < row + 64; ++i)
            memory_[i] = kind == 1   ? 0
                         : kind == 2 ? 0xFF
                                     : static_cast<uint8_t>(memory_[i] ^ random_());
    }
    changed(offset, size);
}

void Stm32Flash::reset() {
    settle();
    if (operation_.under)
        cut();
    keyStep_ = acr_ = sr_ = 0;
    cr_ = Lock;
}
