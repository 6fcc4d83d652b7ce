// SPDX-License-Identifier: MIT
//
// stm32_flash: models the 1 MiB flash memory of an STM32F2, and the registers of its interface
// (ST's PM0059; erase and programming times from the data sheet). The flash has one bank, so every
// read during an erase or a write waits until the erase or write has ended. Programming can only
// clear bits. If a reset or a loss of power interrupts an operation, the affected bits become
// random; a seed makes them repeatable.

#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <stdexcept>

class Stm32Flash {
public:
    static constexpr uint32_t bytes = 0x100000, sectors = 12;
    // Returns the offset of a sector.
    static uint32_t sectorAt(unsigned n) { return n <= 4 ? n * 0x4000u : (n - 4) * 0x20000u; }
    // Returns the size of a sector: sectors 0 to 3 have 16 KiB, sector 4 has 64 KiB, sectors 5 to
    // 11 have 128 KiB.
    static uint32_t sectorBytes(unsigned n) { return n < 4 ? 0x4000 : n == 4 ? 0x10000 : 0x20000; }
    static unsigned sectorOf(uint32_t offset) {
        return offset < 0x10000 ? offset / 0x4000 : offset < 0x20000 ? 4 : 4 + offset / 0x20000;
    }

    enum Register : uint32_t { Acr = 0, Keyr = 4, Optkeyr = 8, Sr = 12, Cr = 16, Optcr = 20 };
    // bits of the register CR
    enum : uint32_t { Pg = 1, Ser = 2, Strt = 1u << 16, Lock = 1u << 31 };
    // bits of the register SR
    enum : uint32_t {
        Eop = 1,
        Pgaerr = 1u << 5,
        Pgperr = 1u << 6,
        Pgserr = 1u << 7,
        Bsy = 1u << 16
    };
    // Exception for a wrong key. On the chip a wrong key is a bus error, and the register stays
    // locked until the next reset.
    class WrongKey : public std::runtime_error {
    public:
        using std::runtime_error::runtime_error;
    };

    // `memory` is the flash's contents of `bytes` bytes; `now` returns the time, ns.
    Stm32Flash(uint8_t* memory, std::function<uint64_t()> now, uint64_t seed = 1)
        : memory_(memory), now_(std::move(now)), random_(seed) {}

    uint32_t read(uint32_t reg) {
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
            return 0; // the key registers always read as 0
        }
    }
    void write(uint32_t reg, uint32_t value) {
        settle();
        if (reg == Acr)
            acr_ = value;
        else if (reg == Keyr)
            unlock(value);
        else if (reg == Sr)
            sr_ &= ~value;
        else if (reg == Optkeyr)
            unlockOptions(value);
        else if (reg == Optcr && !(optcr_ & 1))
            setOptions(value);
        if (reg != Cr || (cr_ & Lock) || operation_.under) // the write is ignored
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
    // Handles a store of 1, 2 or 4 bytes to flash.
    void store(uint32_t offset, unsigned size, uint32_t value) {
        settle();
        if (operation_.under) // the bus waits until the current operation has ended
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
    // Returns the time until the memory can be read again, ns.
    uint64_t busyNs() const {
        const uint64_t now = now_();
        return operation_.under && operation_.end > now ? operation_.end - now : 0;
    }
    // Interrupts the current operation, like a reset or a loss of power.
    void reset() {
        settle();
        if (operation_.under)
            cut();
        keyStep_ = optionStep_ = acr_ = sr_ = 0;
        cr_ = Lock;
        optcr_ = erasedOptions | uint32_t(protection_) << 8 | 1;
    }

    // Returns the level of the read protection; 0xAA means not protected.
    uint8_t protection() const { return protection_; }
    // Returns the number of erases and writes that have begun so far.
    uint64_t operations() const { return operations_; }
    // Called when an erase or a write has begun.
    std::function<void()> onOperation;
    // Called when bytes of the flash have changed.
    std::function<void(uint32_t offset, uint32_t size)> onChange;

private:
    static constexpr uint32_t keys[2] = {0x45670123, 0xCDEF89AB};
    // Typical durations (STM32F207 data sheet, flash memory characteristics) with a parallelism of
    // 32 bits: of an erase for sectors of 16, 64 and 128 KiB, and of programming a word.
    static constexpr uint64_t eraseMs[] = {250, 550, 1000}, millisecond = 1'000'000,
                              programNs = 16'000;

    struct Operation {
        uint64_t end = 0;
        uint32_t offset = 0, size = 0, value = 0;
        bool under = false, erases = false;
    };
    void unlock(uint32_t key) {
        if (keyStep_ > 1 || key != keys[keyStep_]) {
            keyStep_ = 3; // the register is then locked until the next reset
            throw WrongKey("a wrong key: the flash stays locked until a reset");
        }
        if (++keyStep_ == 2) {
            cr_ &= ~Lock;
            keyStep_ = 0;
        }
    }
    // Option bytes: of these, only the read protection is stored (PM0059, 2.5).
    void unlockOptions(uint32_t key) {
        static constexpr uint32_t optionKeys[2] = {0x08192A3B, 0x4C5D6E7F};
        optionStep_ = optionStep_ < 2 && key == optionKeys[optionStep_] ? optionStep_ + 1 : 3;
        if (optionStep_ == 2)
            optcr_ &= ~1u;
    }
    void setOptions(uint32_t value) {
        optcr_ = value & ~2u;
        if (value & 2)
            protection_ = static_cast<uint8_t>(value >> 8);
    }
    void begin(Operation operation, uint64_t ns) {
        operation_ = operation;
        operation_.under = true;
        operation_.end = now_() + ns;
        ++operations_;
        if (onOperation)
            onOperation();
    }
    void finish() {
        operation_.under = false;
        if (operation_.erases)
            std::memset(memory_ + operation_.offset, 0xFF, operation_.size);
        else
            put(operation_.offset, operation_.size, operation_.value);
        changed(operation_.offset, operation_.size);
        if (cr_ >> 24 & 1)
            sr_ |= Eop;
    }
    void settle() {
        if (operation_.under && now_() >= operation_.end)
            finish();
    }
    // Interrupts the current operation. A write then has cleared only some of its bits. An erase
    // first clears all bits and then sets them; if it is interrupted, each row of 64 bytes is
    // unchanged, cleared, erased, or partly erased.
    void cut() {
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
    // Clears those bits of the flash that are 0 in `value`.
    void put(uint32_t offset, unsigned size, uint32_t value) {
        for (unsigned i = 0; i < size; ++i)
            memory_[offset + i] &= static_cast<uint8_t>(value >> 8 * i);
    }
    void changed(uint32_t offset, uint32_t size) const {
        if (onChange)
            onChange(offset, size);
    }

    uint8_t* memory_;
    std::function<uint64_t()> now_;
    std::mt19937_64 random_;
    Operation operation_;
    uint64_t operations_ = 0;
    static constexpr uint32_t erasedOptions = 0x0FFF00EC;
    uint32_t keyStep_ = 0, acr_ = 0, sr_ = 0, cr_ = Lock;
    uint32_t optionStep_ = 0, optcr_ = erasedOptions | 0xAA01;
    uint8_t protection_ = 0xAA;
};
