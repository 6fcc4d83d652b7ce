// SPDX-License-Identifier: MIT
//
// cpu_memory: stores the bytes of flash and RAM. Flash can be read at its own address and at
// address 0.

#pragma once

#include <cstdint>
#include <memory>

class CpuMemory {
public:
    struct Range {
        uint32_t base, bytes;
    };
    CpuMemory(Range flash, Range ram);

    uint8_t* flash() { return flash_.get(); }
    uint8_t* ram() { return ram_.get(); }
    bool isFlash(uint32_t address) const {
        return address < flashRange_.bytes || address - flashRange_.base < flashRange_.bytes;
    }
    // Returns the offset in flash; `address` may lie in flash itself or in its copy at 0.
    uint32_t flashOffset(uint32_t address) const {
        return address >= flashRange_.base ? address - flashRange_.base : address;
    }
    bool isInRam(uint32_t address, uint32_t bytes) const {
        return isInside(ramRange_, address, bytes);
    }
    // Reads without side effects. Returns false if part of the range is not memory.
    bool read(uint32_t address, void* data, uint32_t bytes) const;

private:
    static bool isInside(const Range& range, uint32_t address, uint32_t bytes) {
        return address >= range.base &&
               uint64_t(address) + bytes <= uint64_t(range.base) + range.bytes;
    }
    const Range flashRange_, ramRange_;
    std::unique_ptr<uint8_t[], void (*)(void*)> flash_, ram_; // page-aligned, as unicorn requires
};
