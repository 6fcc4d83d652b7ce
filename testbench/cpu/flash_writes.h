// SPDX-License-Identifier: MIT
//
// flash_writes: keeps the decoded instructions of the CPU model's flash, and undoes stores to
// flash. libunicorn writes such a store directly into flash. This class restores the old bytes; the
// bus then decides what the store changes.

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

    // Returns the entry for the decoded instruction at an offset. If `bytes` of the entry is 0, the
    // caller must decode the instruction and fill the entry.
    Instruction& decodedAt(uint32_t offset) { return decoded_[offset >> 1]; }
    // Discards the decoded instructions of bytes that have changed.
    void changed(uint32_t offset, uint32_t bytes) {
        // the changed bytes may be the second half of a 32-bit instruction, which begins one
        // halfword earlier
        const uint32_t first = offset >= 2 ? offset / 2 - 1 : 0;
        for (uint32_t at = first; at < (offset + bytes + 1) / 2; ++at) {
            isStale_ = isStale_ || decoded_[at].bytes;
            decoded_[at].bytes = 0;
        }
    }
    // Returns true if flash has changed after libunicorn translated code from it.
    bool isStale() const { return isStale_; }
    void translated() { isStale_ = false; }

    // Saves the old bytes before libunicorn overwrites them with a store.
    void keep(const uint8_t* flash, uint32_t offset, unsigned bytes) {
        Store store{offset, bytes, {}};
        std::memcpy(store.was, flash + offset, bytes);
        stores_.push_back(store);
    }
    // Restores the saved bytes.
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
    // old values of the bytes that the current instruction has overwritten
    std::vector<Store> stores_;
    std::vector<Instruction> decoded_; // decoded instructions, one entry per halfword of flash
    bool isStale_ = false;
};
