// SPDX-License-Identifier: MIT
//
// unicorn_calls: connects CortexM3 with libunicorn: the C callbacks, and libunicorn's names of the
// registers.

#pragma once

#include "cortex_m3.h"

struct UnicornCalls {
    static CortexM3& cpu(void* user) { return *static_cast<CortexM3*>(user); }
    static void code(uc_engine*, uint64_t address, uint32_t, void* user) {
        cpu(user).onInstruction(static_cast<uint32_t>(address));
    }
    static void raised(uc_engine*, uint32_t number, void* user) { cpu(user).onRaised(number); }
    static void access(uc_engine*, uc_mem_type type, uint64_t address, int size, int64_t,
                       void* user) {
        cpu(user).onGuarded(static_cast<uint32_t>(address), static_cast<unsigned>(size),
                            type == UC_MEM_WRITE);
    }
    static void flashWrite(uc_engine*, uc_mem_type, uint64_t address, int size, int64_t value,
                           void* user) {
        CortexM3& m3 = cpu(user);
        const auto at = static_cast<uint32_t>(address);
        m3.onFlashWrite(m3.memory_.flashOffset(at), static_cast<unsigned>(size),
                        static_cast<uint32_t>(value));
    }
    static uint64_t read(uc_engine*, uint64_t offset, unsigned size, void* user) {
        auto& window = *static_cast<CortexM3::MappedWindow*>(user);
        return window.cpu->onRead(window.base + static_cast<uint32_t>(offset), size);
    }
    static void write(uc_engine*, uint64_t offset, unsigned size, uint64_t value, void* user) {
        auto& window = *static_cast<CortexM3::MappedWindow*>(user);
        window.cpu->onWrite(window.base + static_cast<uint32_t>(offset), size,
                            static_cast<uint32_t>(value));
    }
    static int registerId(int number);
};
