// SPDX-License-Identifier: MIT
//
// spi_flash: an operation changes the memory at its end; a cut one at its cut.

#include "spi_flash.h"

namespace {

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
constexpr uint8_t identity[] = {0xEF, 0x40, 0x15};
constexpr uint64_t millisecond = 1'000'000;
constexpr uint32_t pageBytes = 256;

} // namespace

void SpiFlash::settle() {
    if (!isUnder_ || now_() < end_)
        return;
    isUnder_ = mayWrite_ = false;
    for (uint32_t i = 0; i < size_; ++i) {
        uint8_t& byte = memory[at_ + i];
        byte = page_.empty() ? 0xFF : byte & page_[i];
    }
}

uint8_t SpiFlash::transfer(uint8_t in) {
    settle();
    in_.push_back(in);
    const size_t behind = in_.size() - 1; // bytes behind the instruction's first
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

void SpiFlash::select(bool isLow) {
    settle();
    if (isSelected_ && !isLow && !in_.empty() && !isUnder_) {
        const uint8_t instruction = in_[0];
        const uint32_t at =
            in_.size() < 4 ? 0 : (uint32_t(in_[1]) << 16 | uint32_t(in_[2]) << 8 | in_[3]) % bytes;
        if (instruction == WriteEnable || instruction == WriteDisable) {
            mayWrite_ = instruction == WriteEnable;
        } else if (mayWrite_ && instruction == PageProgram && in_.size() > 4) {
            const uint32_t page = at & ~(pageBytes - 1); // behind its end it goes on at its start
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

void SpiFlash::begin(uint32_t at, uint32_t size, uint64_t ns) {
    at_ = at;
    size_ = size;
    end_ = now_() + ns;
    isUnder_ = true;
    ++operations_;
    if (onOperation)
        onOperation();
}

// Leaves a cut write with some of its bits cleared. A cut erase, which first clears all bits and
// then sets them, leaves rows of 64 bytes old, cleared, erased, or in between.
void SpiFlash::powerOff() {
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
