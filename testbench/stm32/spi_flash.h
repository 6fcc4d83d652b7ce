// SPDX-License-Identifier: MIT
//
// spi_flash: models a 2 MiB serial NOR flash like Winbond's W25Q16. It receives instructions byte
// by byte from the SPI master, and takes realistic times for erases and writes. A write can only
// clear bits. If a loss of power interrupts an operation, the affected bits become random; a seed
// makes them repeatable.

#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

class SpiFlash {
public:
    static constexpr uint32_t bytes = 0x200000;

    // `now` returns the time, ns.
    explicit SpiFlash(std::function<uint64_t()> now, uint64_t seed = 1)
        : memory(bytes, 0xFF), now_(std::move(now)), random_(seed) {}

    // Sets chip select. An instruction that changes the flash begins when chip select rises.
    void select(bool isLow) {
        settle();
        if (isSelected_ && !isLow && !in_.empty() && !isUnder_) {
            const uint8_t instruction = in_[0];
            const uint32_t at =
                in_.size() < 4 ? 0
                               : (uint32_t(in_[1]) << 16 | uint32_t(in_[2]) << 8 | in_[3]) % bytes;
            if (instruction == WriteEnable || instruction == WriteDisable) {
                mayWrite_ = instruction == WriteEnable;
            } else if (mayWrite_ && instruction == PageProgram && in_.size() > 4) {
                // after the last byte of the page, the address continues with the first byte
                const uint32_t page = at & ~(pageBytes - 1);
                page_.assign(pageBytes, 0xFF);
                for (size_t i = 4; i < in_.size(); ++i)
                    page_[(at + i - 4) % pageBytes] = in_[i];
                begin(page, pageBytes, 7 * millisecond / 10);
            } else if (mayWrite_ && in_.size() == 4 && instruction == SectorErase) {
                page_.clear();
                begin(at & ~0xFFFu, 0x1000, 45 * millisecond);
            } else if (mayWrite_ && in_.size() == 4 && instruction == BlockErase) {
                page_.clear();
                begin(at & ~0xFFFFu, 0x10000, 150 * millisecond);
            }
        }
        if (isLow && !isSelected_)
            in_.clear();
        isSelected_ = isLow;
    }
    // Clocks one byte: the flash receives `in` and sends the returned byte at the same time.
    uint8_t transfer(uint8_t in) {
        settle();
        in_.push_back(in);
        // number of bytes that follow the first byte of the instruction
        const size_t behind = in_.size() - 1;
        if (!isSelected_ || behind == 0)
            return 0xFF;
        if (in_[0] == ReadStatus)
            return (isUnder_ ? Busy : 0) | (mayWrite_ ? WriteEnabled : 0);
        if (isUnder_)
            return 0xFF;
        if (in_[0] == Identify && behind <= sizeof identity)
            return identity[behind - 1];
        if (in_[0] == Read && behind > 3) {
            const uint32_t at = uint32_t(in_[1]) << 16 | uint32_t(in_[2]) << 8 | in_[3];
            return memory[(at + behind - 4) % bytes];
        }
        return 0xFF;
    }
    // Interrupts the current operation by a loss of power. A write that is interrupted has cleared
    // only some of its bits. An erase first clears all bits and then sets them; if it is
    // interrupted, each row of 64 bytes is unchanged, cleared, erased, or partly erased.
    void powerOff() {
        settle();
        for (uint32_t row = at_; isUnder_ && row < at_ + size_; row += 64) {
            const unsigned kind = random_() & 3;
            for (uint32_t i = row; i < row + 64; ++i) {
                const auto chance = static_cast<uint8_t>(random_());
                if (!page_.empty())
                    memory[i] &= static_cast<uint8_t>(page_[i - at_] | chance);
                else if (kind)
                    memory[i] = kind == 1 ? 0 : kind == 2 ? 0xFF : memory[i] ^ chance;
            }
        }
        isUnder_ = mayWrite_ = isSelected_ = false;
        end_ = 0;
    }
    // Returns the remaining time of the current erase or write, ns.
    uint64_t busyNs() const { return end_ > now_() ? end_ - now_() : 0; }

    std::vector<uint8_t> memory;
    // Returns the number of erases and writes that have begun so far.
    uint64_t operations() const { return operations_; }
    // Called when an erase or a write has begun.
    std::function<void()> onOperation;

private:
    enum : uint8_t {
        PageProgram = 0x02,
        Read = 0x03,
        WriteDisable = 0x04,
        ReadStatus = 0x05,
        WriteEnable = 0x06,
        SectorErase = 0x20,
        Identify = 0x9F,
        BlockErase = 0xD8
    };
    enum : uint8_t { Busy = 1, WriteEnabled = 2 };
    static constexpr uint8_t identity[] = {0xEF, 0x40, 0x15};
    static constexpr uint64_t millisecond = 1'000'000;
    static constexpr uint32_t pageBytes = 256;

    void begin(uint32_t at, uint32_t size, uint64_t ns) {
        at_ = at;
        size_ = size;
        end_ = now_() + ns;
        isUnder_ = true;
        ++operations_;
        if (onOperation)
            onOperation();
    }
    void settle() {
        if (!isUnder_ || now_() < end_)
            return;
        isUnder_ = mayWrite_ = false;
        for (uint32_t i = 0; i < size_; ++i) {
            uint8_t& byte = memory[at_ + i];
            byte = page_.empty() ? 0xFF : byte & page_[i];
        }
    }

    std::function<uint64_t()> now_;
    std::mt19937_64 random_;
    // in_: bytes of the instruction; page_: contents of the page that is being written, empty
    // during an erase
    std::vector<uint8_t> in_, page_;
    bool isSelected_ = false, mayWrite_ = false, isUnder_ = false;
    uint32_t at_ = 0, size_ = 0; // address and size of the current operation
    uint64_t end_ = 0, operations_ = 0;
};
