// SPDX-License-Identifier: MIT
//
// flash_writes: keeps the decoded instructions of the CPU model's flash, and undoes stores to
// flash. libunicorn carries out such a store by itself; it is undone, and the bus then applies the
// write.

#pragma once

#include "instruction.h"
#include <cstring>
#include <vector>

class FlashWrites {
public:
    explicit FlashWrites(uint32_t bytes) : decoded_(bytes / 2) {
        for (Instruction& i : decoded_)
            i.bytes = 0;
    }

    // Returns the place for the decoded instruction at an offset. If its `bytes` is 0, the caller
    // must decode the instruction and store it there.
    Instruction& decodedAt(uint32_t offset) { return decoded_[offset >> 1]; }
    // Drops the decoded instructions of bytes that have changed.
    void changed(uint32_t offset, uint32_t bytes) {
        // a 32-bit instruction may begin one halfword earlier
        const uint32_t first = offset >= 2 ? offset / 2 - 1 : 0;
        for (uint32_t at = first; at < (offset + bytes + 1) / 2; ++at) {
            isStale_ = isStale_ || decoded_[at].bytes;
            decoded_[at].bytes = 0;
        }
    }
    // True if code that libunicorn has translated no longer equals the flash.
    bool isStale() const { return isStale_; }
    void translated() { isStale_ = false; }

    // Saves the old bytes before libunicorn overwrites them.
    void keep(const uint8_t* flash, uint32_t offset, unsigned bytes) {
        Store store{offset, bytes, {}};
        std::memcpy(store.was, flash + offset, bytes);
        stores_.push_back(store);
    }
    // Restores the bytes that were overwritten.
    void undo(uint8_t* flash) {
        if (stores_.empty())
            return;
        for (auto s = stores_.rbegin(); s != stores_.rend(); ++s)
            std::memcpy(flash + s->offset, s->was, s->bytes);
        stores_.clear();
    }

private:
    struct Store {
        uint32_t offset;
        unsigned bytes;
        uint8_t was[8];
    };
    std::vector<Store> stores_;        // stores of the current instruction
    std::vector<Instruction> decoded_; // one entry per halfword
    bool isStale_ = false;
};
