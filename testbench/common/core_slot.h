// SPDX-License-Identifier: MIT
//
// core_slot: a core behind its generated wrapper in slot 5, as the FSMC driver and a generated
// servant see it: the driver's port, the interrupt, the wait (docs/hw-mapping.md).

#ifndef CORE_SLOT_H
#define CORE_SLOT_H

#include "bus_master.h"
#include <gtest/gtest.h>
extern "C" {
#include "fsmc.h"
#include "hw_core.h"
#include "map_regs.h"
#include "system_regs.h"
}

constexpr U32 coreSlot = 5, coreClocksOfMs = 100; // a simulated millisecond

// One core in a slot, the driver's port, the interrupt and the wait.
template <class Module> class CoreSlot {
public:
    CoreSlot() {
        static const Fsmc_Port port = {nullptr, nullptr, nullptr, nullptr, read, write};
        bench_.reset();
        EXPECT_EQ(FSMC_init(&port, this), FSMC_OK);
    }
    static int wait(void* context, U32 operation, U32 ms) {
        auto& self = *static_cast<CoreSlot*>(context);
        for (U32 i = 0; i < ms * coreClocksOfMs && !(self.posted_ >> operation & 1); ++i)
            self.tick();
        int posted = self.posted_ >> operation & 1;
        self.posted_ &= ~(1u << operation);
        self.waitedClocks_ = bench(context).cycles() - self.started_;
        return posted;
    }
    static void post(void* context, U32 operation) {
        static_cast<CoreSlot*>(context)->posted_ |= 1u << operation;
    }
    static U32 nowMs(void* context) {
        return static_cast<U32>(bench(context).cycles() / coreClocksOfMs);
    }
    void tick() {
        bench_.tick();
        if (bench_.top().irq_o && core_)
            Hw_Core_interrupt(core_);
    }

    static constexpr Hw_Seam seam = {wait, post, nowMs};
    Bench<Module> bench_;
    BusMaster<Module> bus_{bench_};
    Hw_Core* core_ = nullptr;
    U32 posted_ = 0;
    uint64_t started_ = 0, waitedClocks_ = 0;
    unsigned errors_ = 0;

private:
    static Bench<Module>& bench(void* context) { return static_cast<CoreSlot*>(context)->bench_; }
    U32 access(bool isWrite, U32 address, U32 value) {
        constexpr U32 control = 0x64000000; // NE2
        if (address < control || address >= control + 0x1000)
            return 0; // the FSMC's own registers
        U32 word = (address - control) / 4;
        if (word / 16 == MAP_SLOT_SYSTEM)
            return word == SYSTEM_ID ? SYSTEM_ID_VALUE : 0;
        EXPECT_EQ(word / 16, coreSlot);
        auto answer = bus_.transfer(isWrite, word % 16, value);
        errors_ += answer.error;
        return answer.data;
    }
    static U32 read(void* context, U32 address) {
        return static_cast<CoreSlot*>(context)->access(false, address, 0);
    }
    static void write(void* context, U32 address, U32 value) {
        static_cast<CoreSlot*>(context)->access(true, address, value);
    }
};

#endif
