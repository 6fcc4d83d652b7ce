// SPDX-License-Identifier: MIT
//
// cpu_memory: allocates and reads flash and RAM.

#include "cpu_memory.h"
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

uint8_t* pages(uint32_t bytes) {
    void* at = std::aligned_alloc(4096, bytes);
    if (!at)
        throw std::bad_alloc();
    std::memset(at, 0, bytes);
    return static_cast<uint8_t*>(at);
}

} // namespace

CpuMemory::CpuMemory(Range flash, Range ram)
    : flashRange_(flash), ramRange_(ram), flash_(pages(flash.bytes), std::free),
      ram_(pages(ram.bytes), std::free) {}

bool CpuMemory::read(uint32_t address, void* data, uint32_t bytes) const {
    const uint8_t* at = isInRam(address, bytes) ? ram_.get() + (address - ramRange_.base)
                        : isInside(flashRange_, address, bytes)
                            ? flash_.get() + (address - flashRange_.base)
                        : isInside({0, flashRange_.bytes}, address, bytes) ? flash_.get() + address
                                                                           : nullptr;
    if (at)
        std::memcpy(data, at, bytes);
    return at != nullptr;
}
