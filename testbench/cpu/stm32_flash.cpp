// SPDX-License-Identifier: MIT
//
// stm32_flash: an operation changes the memory at its end; a cut one at its cut.

#include "stm32_flash.h"
#include <cstring>

namespace {

constexpr uint32_t keys[2] = {0x45670123, 0xCDEF89AB}, optionKeys[2] = {0x08192A3B, 0x4C5D6E7F};
constexpr uint32_t optionLock = 1;
constexpr uint64_t microsecond = 1'000, millisecond = 1'000'000;

// Typical times (STM32F207's data sheet, flash memory characteristics), by PSIZE: the parallelism
// of 8, 16, 32 and 64 bits.
constexpr uint64_t eraseMs[3][4] = {
    {400, 300, 250, 250}, {1200, 700, 550, 550}, {2000, 1300, 1000, 1000}};
constexpr uint64_t massEraseMs[4] = {16000, 11000, 8000, 8000};
constexpr uint64_t programNs = 16 * microsecond;

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

void Stm32Flash::unlock(uint32_t value, const uint32_t key[2], unsigned& step, uint32_t& reg,
                        uint32_t lock) {
    if (step > 1 || value != key[step]) {
        step = 3; // until the next reset
        throw WrongKey("a wrong key, or one too many: the flash stays locked until a reset");
    }
    if (++step == 2) {
        reg &= ~lock;
        step = 0;
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
    case Optcr:
        return optcr_;
    default:
        return 0; // the keys' registers
    }
}

void Stm32Flash::write(uint32_t reg, uint32_t value) {
    settle();
    switch (reg) {
    case Acr:
        acr_ = value;
        return;
    case Keyr:
        return unlock(value, keys, keyStep_, cr_, Lock);
    case Optkeyr:
        return unlock(value, optionKeys, optionStep_, optcr_, optionLock);
    case Sr:
        sr_ &= ~value;
        return;
    case Optcr:
        if (!(optcr_ & optionLock))
            optcr_ = value;
        return;
    default:
        break;
    }
    if ((cr_ & Lock) || operation_.under) // writes are ignored
        return;
    cr_ = value & ~Strt;
    if (!(value & Strt) || !(value & (Ser | Mer)))
        return;
    const unsigned width = value >> 8 & 3, sector = value >> 3 & 15;
    if (value & Mer) {
        if ((optcr_ >> 16 & 0xFFF) != 0xFFF)
            sr_ |= Wrperr;
        else
            begin({0, 0, bytes, 0, false, true}, massEraseMs[width] * millisecond);
    } else if (sector >= sectors) {
        sr_ |= Pgserr;
    } else if (isProtected(sectorAt(sector))) {
        sr_ |= Wrperr;
    } else {
        const unsigned kind = sector < 4 ? 0 : sector == 4 ? 1 : 2;
        begin({0, sectorAt(sector), sectorBytes(sector), 0, false, true},
              eraseMs[kind][width] * millisecond);
    }
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
    else if (isProtected(offset))
        sr_ |= Wrperr;
    else
        begin({0, offset, size, value, false, false}, programNs);
}

bool Stm32Flash::isProtected(uint32_t offset) const {
    return !(optcr_ >> 16 >> sectorOf(offset) & 1);
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
    keyStep_ = optionStep_ = 0;
    acr_ = sr_ = 0;
    cr_ = Lock;
    optcr_ |= optionLock;
}
