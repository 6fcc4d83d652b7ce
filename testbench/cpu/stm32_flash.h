// SPDX-License-Identifier: MIT
//
// stm32_flash: the flash memory of an STM32F2 with 1 MiB, and its interface's registers (ST's
// PM0059, and the data sheet's table of erase and programming times). It has one bank: every read
// waits until an erase or a write is done. Programming only clears bits. An operation cut by a
// reset or a loss of power leaves bits that a seed decides.

#ifndef STM32_FLASH_H
#define STM32_FLASH_H

#include <cstdint>
#include <functional>
#include <random>
#include <stdexcept>

class Stm32Flash {
public:
    static constexpr uint32_t bytes = 0x100000, sectors = 12;
    static uint32_t sectorAt(unsigned number);    // offset of its first byte
    static uint32_t sectorBytes(unsigned number); // 4 x 16 KiB, 64 KiB, 7 x 128 KiB
    static unsigned sectorOf(uint32_t offset);

    enum Register : uint32_t { Acr = 0, Keyr = 4, Sr = 12, Cr = 16 };
    enum : uint32_t { Pg = 1, Ser = 2, Strt = 1u << 16, Lock = 1u << 31 }; // of CR
    enum : uint32_t {                                                      // of SR
        Eop = 1,
        Pgaerr = 1u << 5,
        Pgperr = 1u << 6,
        Pgserr = 1u << 7,
        Bsy = 1u << 16
    };
    // A wrong key: on the chip a bus error, and the register stays locked until the next reset.
    class WrongKey : public std::runtime_error {
    public:
        using std::runtime_error::runtime_error;
    };

    // `memory` has `bytes` bytes; `now` is in ns.
    Stm32Flash(uint8_t* memory, std::function<uint64_t()> now, uint64_t seed = 1)
        : memory_(memory), now_(std::move(now)), random_(seed) {}

    uint32_t read(uint32_t reg);
    void write(uint32_t reg, uint32_t value);
    // A store of 1, 2 or 4 bytes to flash.
    void store(uint32_t offset, unsigned size, uint32_t value);
    // Returns how long the memory cannot be read yet, in ns.
    uint64_t busyNs() const;
    // A reset or a loss of power cuts the operation under way.
    void reset();

    uint64_t operations() const { return operations_; } // erases and writes that have begun
    // Called when an erase or a write has begun.
    std::function<void()> onOperation;
    // Called when bytes have changed.
    std::function<void(uint32_t offset, uint32_t size)> onChange;

private:
    struct Operation {
        uint64_t end = 0;
        uint32_t offset = 0, size = 0, value = 0;
        bool under = false, erases = false;
    };
    void unlock(uint32_t key);
    void begin(Operation operation, uint64_t ns);
    void finish();
    void settle();
    void cut();
    void put(uint32_t offset, unsigned size, uint32_t value);
    void changed(uint32_t offset, uint32_t size) const;

    uint8_t* memory_;
    std::function<uint64_t()> now_;
    std::mt19937_64 random_;
    Operation operation_;
    uint64_t operations_ = 0;
    uint32_t keyStep_ = 0, acr_ = 0, sr_ = 0, cr_ = Lock;
};

#endif
