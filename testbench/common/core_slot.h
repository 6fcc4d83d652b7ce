// SPDX-License-Identifier: MIT
//
// core_slot: connects a core and its generated wrapper, in slot 5, to the FSMC driver and a
// generated servant. It provides the driver's port, the interrupt and the waits
// (docs/hw-mapping.md).

#pragma once

#include "bus_master.h"
#include "npi_memory.h"
#include "precompiled.h"
#include "same.h"
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <unordered_map>
extern "C" {
#include "fsmc.h"
#include "hw_core.h"
#include "icec.h"
#include "map_regs.h"
#include "system_regs.h"
}

constexpr U32 coreSlot = 5;
#ifdef CORE_CLK_HZ // defined only for cores that have the parameter CLK_HZ
constexpr U32 coreClocksOfMs = CORE_CLK_HZ / 1000;
#else
// number of core clocks in a millisecond; small, so that time-outs expire soon
constexpr U32 coreClocksOfMs = 100;
#endif
// byte address of the core's buffers in DDR3, as the driver uses it
constexpr U32 coreMemory = 0x01000000;

// Prints a status in GoogleTest's messages, such as "10 (::Ice::TimeoutException)".
inline void PrintTo(Ice_Status status, std::ostream* out) {
    *out << static_cast<int>(status) << " (" << Ice_Status_text(status) << ")";
}

// Exception for a call that failed, with its status. It is not used if the call threw one of the
// exceptions of its operation.
class CoreError : public std::runtime_error {
public:
    CoreError(const std::string& operation, Ice_Status status)
        : std::runtime_error(operation +
                             (status == ICE_TIMEOUT
                                  ? std::string(": the core did not finish the call in time")
                                  : std::string(" failed: ") + Ice_Status_text(status))),
          status_(status) {}
    Ice_Status status() const { return status_; }

private:
    Ice_Status status_;
};

// Context of a call that a test makes directly to a servant. A servant that refuses calls needs it.
struct DirectCall {
    DirectCall() {
        communicator_->decoding = &parameters_;
        current.communicator = communicator_.get();
    }
    // Returns the reason of the last refusal; "" without one.
    std::string reason() const { return parameters_.bound ? parameters_.bound : ""; }
    Ice_Current current{};

private:
    Ice_InputStream parameters_{};
    std::unique_ptr<Ice_Communicator> communicator_ = std::make_unique<Ice_Communicator>();
};

// Models the DDR3 memory at the core's memory port, if the core has such a port.
template <class Module, class = void> class CoreMemory {
public:
    explicit CoreMemory(Bench<Module>&) {}
    uint8_t byte(uint32_t address) const { return bytes_.count(address) ? bytes_.at(address) : 0; }
    void setByte(uint32_t address, uint8_t value) { bytes_[address] = value; }

private:
    std::unordered_map<uint32_t, uint8_t> bytes_;
};
template <class Module>
class CoreMemory<Module, std::void_t<decltype(Module::npi_addr_o)>> : public NpiMemory<Module> {
public:
    explicit CoreMemory(Bench<Module>& bench) : NpiMemory<Module>(bench, 0.2, testSeed()) {}
};

// Clock of a core with a separate clock domain, in addition to the chip's 100 MHz. The edges of
// this clock lie between the edges of the chip clock.
#ifndef CORE_OWN_HZ
#define CORE_OWN_HZ 24000000u
#endif
template <class Module, class = void> struct OwnClock {
    explicit OwnClock(Bench<Module>&) {}
};
template <class Module> class OwnClock<Module, std::void_t<decltype(Module::clock_i)>> {
public:
    explicit OwnClock(Bench<Module>& bench) {
        bench.addClock([this, &top = bench.top()] {
            for (time_ += hz_; time_ >= 100000000; time_ -= 100000000) {
                top.clock_i ^= 1;
                top.eval();
            }
        });
    }
    void run(unsigned hz) { hz_ = hz; } // Sets the frequency of the clock, Hz; 0 stops the clock.

private:
    unsigned hz_ = CORE_OWN_HZ, time_ = 0;
};

// A core in a slot, with everything that its driver needs: register access, interrupts, waiting.
template <class Module> class CoreSlot {
public:
    CoreSlot() {
        static const FSMC_Port bus = {read<1>,       write<1, U8>, read<2>,
                                      write<2, U16>, read<4>,      write<4, U32>};
        bench_.reset();
        EXPECT_EQ(FSMC_init(&bus, this), FSMC_OK);
    }
    static int wait(void* context, U32 operation, U32 ms) {
        auto& self = *static_cast<CoreSlot*>(context);
        for (U32 i = 0; i < ms * coreClocksOfMs && !(self.posted_ >> operation & 1); ++i)
            self.tick();
        int posted = self.posted_ >> operation & 1;
        self.posted_ &= ~(1u << operation);
        self.waitedClocks_ = self.bench_.cycles() - self.started_;
        return posted;
    }
    static void post(void* context, U32 operation) {
        static_cast<CoreSlot*>(context)->posted_ |= 1u << operation;
    }
    static U32 nowMs(void* context) {
        return static_cast<U32>(static_cast<CoreSlot*>(context)->bench_.cycles() / coreClocksOfMs);
    }
    void tick() {
        bench_.tick();
        if (!bench_.top().irq_o)
            return;
        if (interrupt_)
            interrupt_();
        else if (core_)
            Hw_Core_interrupt(core_);
    }

    // Functions that generated proxies call.
    void hw_start(Hw_Status status, Hw_Core& core) {
        EXPECT_EQ(status, HW_OK);
        core_ = &core;
    }
    static void hw_check(const char* operation, Ice_Status status) {
        if (status != ICE_OK)
            throw CoreError(operation, status);
    }
    template <class Exception>
    static void hw_check(const char* operation, Ice_Status status, const Exception& exception) {
        if (status == ICE_USER_EXCEPTION)
            throw exception;
        hw_check(operation, status);
    }
    // Polls until a deferred operation has ended. Like the task of the firmware, it polls after
    // each interrupt of the core, and a few milliseconds after the time-out of the operation.
    void hw_finish(const char* name, U32 operation) {
        Hw_Status status = HW_OK;
        U32 next = HW_NEVER;
        Hw_Core_later(core_, operation);
        while (!Hw_Core_ended(core_, operation, nowMs(this), &status, &next)) {
            ASSERT_LT(next, HW_NEVER / 2) << "no event and no time-out would wake the task";
            wait(this, operation, next + 3);
            next = HW_NEVER;
        }
        core_->later[operation] = 0;
        if (status != HW_OK)
            throw CoreError(name, status == HW_TIMEOUT ? ICE_TIMEOUT : ICE_UNKNOWN_EXCEPTION);
    }

    static U32 busErrors(void* context) { return static_cast<CoreSlot*>(context)->errors_; }

    static inline Hw_Frames frames{};
    static constexpr Hw_Port port = {wait, post, nowMs, busErrors, &frames};
    Bench<Module> bench_;
    OwnClock<Module> ownClock_{bench_};
    CoreMemory<Module> memory_{bench_};
    BusMaster<Module> bus_{bench_};
    Hw_Core* core_ = nullptr;
    // interrupt function of the servant; Hw_Core_interrupt is used if this function is empty
    std::function<void()> interrupt_;
    // function that is called before each register access, to simulate another task that runs in
    // between
    std::function<void()> beforeAccess_;
    U32 posted_ = 0;
    U32 memoryAt_ = coreMemory; // address of the core's buffers: the value of the register MEMORY
    uint64_t started_ = 0, waitedClocks_ = 0;
    unsigned errors_ = 0;

private:
    static constexpr U32 ddr = MAP_DDR_WINDOW, control = MAP_CONTROL_WINDOW;
    U32 inMemory(U32 address) const { return address - ddr - coreMemory + memoryAt_; }
    U32 access(bool isWrite, U32 address, U32 value) {
        if (address < control || address >= control + 0x1000)
            return 0; // an address outside the control window belongs to the FSMC's own registers
        U32 word = (address - control) / 4;
        if (beforeAccess_)
            beforeAccess_();
        if (word / 16 == MAP_SLOT_SYSTEM)
            return word == SYSTEM_ID ? SYSTEM_ID_VALUE : 0;
        EXPECT_EQ(word / 16, coreSlot);
        auto answer = bus_.transfer(isWrite, word % 16, value);
        errors_ += answer.error;
        return answer.data;
    }
    template <unsigned Bytes> static auto read(void* context, U32 address) {
        auto& self = *static_cast<CoreSlot*>(context);
        using Value = std::conditional_t<Bytes == 1, U8, std::conditional_t<Bytes == 2, U16, U32>>;
        U32 value = 0;
        if (address < ddr || address >= control)
            return static_cast<Value>(self.access(false, address, 0));
        for (unsigned i = 0; i < Bytes; ++i)
            value |= U32(self.memory_.byte(self.inMemory(address + i))) << (8 * i);
        return static_cast<Value>(value);
    }
    template <unsigned Bytes, class Value>
    static void write(void* context, U32 address, Value value) {
        auto& self = *static_cast<CoreSlot*>(context);
        if (address < ddr || address >= control) {
            self.access(true, address, value);
            return;
        }
        for (unsigned i = 0; i < Bytes; ++i)
            self.memory_.setByte(self.inMemory(address + i),
                                 static_cast<uint8_t>(value >> (8 * i)));
    }
};
