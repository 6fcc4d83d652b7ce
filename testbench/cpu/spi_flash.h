// SPDX-License-Identifier: MIT
//
// spi_flash: a serial NOR flash of 2 MiB like Winbond's W25Q16: instructions byte by byte, as the
// SPI master clocks them, with the times of erases and writes. Programming only clears bits. An
// operation cut by a loss of power leaves bits that a seed decides.

#ifndef SPI_FLASH_H
#define SPI_FLASH_H

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

class SpiFlash {
public:
    static constexpr uint32_t bytes = 0x200000;

    // `now` is in ns.
    explicit SpiFlash(std::function<uint64_t()> now, uint64_t seed = 1)
        : memory(bytes, 0xFF), now_(std::move(now)), random_(seed) {}

    // Chip select; an instruction that changes something begins when it rises.
    void select(bool isLow);
    // Eight clocks: takes a byte, and returns the byte that it drives meanwhile.
    uint8_t transfer(uint8_t in);
    // A loss of power cuts the operation under way.
    void powerOff();
    // Returns the remaining time of an erase or a write, in ns.
    uint64_t busyNs() const { return end_ > now_() ? end_ - now_() : 0; }

    std::vector<uint8_t> memory;
    uint64_t operations() const { return operations_; } // erases and writes that have begun
    // Called when an erase or a write has begun.
    std::function<void()> onOperation;

private:
    void begin(uint32_t at, uint32_t size, uint64_t ns);
    void settle();

    std::function<uint64_t()> now_;
    std::mt19937_64 random_;
    std::vector<uint8_t> in_, page_; // the instruction; what is being written, empty: an erase
    bool isSelected_ = false, mayWrite_ = false, isUnder_ = false;
    uint32_t at_ = 0, size_ = 0; // of the operation under way
    uint64_t end_ = 0, operations_ = 0;
};

#endif
