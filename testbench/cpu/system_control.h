// SPDX-License-Identifier: MIT
//
// system_control: registers of a Cortex-M3's private peripheral bus (0xE0000000): SysTick, NVIC,
// SCB, the MPU for regions that are inaccessible or read-only, and DWT's cycle counter. ARMv7-M
// ARM, chapter B3.

#pragma once

#include "exceptions.h"
#include <cstdint>

class SystemControl {
public:
    // `calibration`: SYST_CALIB.TENMS; on an STM32F2 ticks of HCLK/8 in one millisecond
    // (RM0033, 8.1.2).
    SystemControl(Exceptions& exceptions, uint32_t calibration)
        : exceptions_(&exceptions), calibration_(calibration) {}

    void reset();
    // 32-bit registers; 8 and 16 bits are cut out of them. False: there is no such register.
    bool read(uint32_t address, unsigned size, uint32_t& value);
    bool write(uint32_t address, unsigned size, uint32_t value);

    // Time passes; SysTick pends when it runs through zero.
    void pass(unsigned cycles) {
        cycles_ += cycles;
        if (cycles_ >= tickDue_)
            tick();
    }
    uint64_t cycles() const { return cycles_; }
    // Cycles until SysTick pends, at least 1; a large number where it is off.
    uint64_t untilTick() const { return tickDue_ > cycles_ ? tickDue_ - cycles_ : 1; }

    uint32_t vectorTable() const { return vtor_; }
    bool takeResetRequest();
    bool buffersStores() const { return !(actlr_ & 1u << 1); } // ACTLR.DISDEFWBUF
    bool alignsStack() const { return ccr_ & 1u << 9; }

    // True if the MPU forbids a data access from `start` on.
    bool isForbidden(uint32_t start, uint32_t bytes, bool write) const {
        return guards_ && hitsGuard(start, bytes, write);
    }

    // Fault status, for the processor to fill in: bits of CFSR and HFSR, and the address.
    void reportFault(uint32_t cfsrBits) { cfsr_ |= cfsrBits; }
    void reportHardFault(uint32_t hfsrBits) { hfsr_ |= hfsrBits; }
    void setFaultAddress(uint32_t cfsrBits, uint32_t address);
    static constexpr uint32_t dataAccess = 1u << 1, stackAccess = 1u << 4, mmfarValid = 1u << 7,
                              preciseBus = 1u << 9, impreciseBus = 1u << 10, bfarValid = 1u << 15,
                              undefined = 1u << 16, invalidState = 1u << 17,
                              invalidReturn = 1u << 18, noCoprocessor = 1u << 19,
                              instructionBus = 1u << 8, forced = 1u << 30;

private:
    struct Stored;
    static const Stored stored[];
    struct Region {
        uint32_t rbar = 0, rasr = 0;
    };
    // Read into `value`, or write it.
    bool accessWord(uint32_t address, bool write, uint32_t& value);
    bool accessInterrupts(uint32_t offset, bool write, uint32_t& value);
    bool accessPriorities(unsigned first, bool write, uint32_t& value);
    bool accessOther(uint32_t offset, bool write, uint32_t& value);
    bool accessMpu(uint32_t offset, bool write, uint32_t& value);
    void tick();
    void startSysTick(uint64_t ticks);
    void controlSysTick(uint32_t value);
    uint64_t tickUnit() const { return control_ & 4 ? 1 : 8; } // CLKSOURCE: HCLK or HCLK/8
    uint32_t currentTicks() const;
    bool hitsGuard(uint32_t start, uint32_t bytes, bool write) const;
    void updateGuards();

    static constexpr unsigned regions = 8;
    Exceptions* exceptions_;
    uint32_t calibration_;
    uint64_t cycles_ = 0, tickDue_ = ~0ull;
    uint32_t control_ = 0, load_ = 0, stoppedAt_ = 0;
    bool countFlag_ = false;
    uint32_t actlr_ = 0, vtor_ = 0, scr_ = 0, ccr_ = 0x200, cfsr_ = 0, hfsr_ = 0, mmfar_ = 0,
             bfar_ = 0;
    uint32_t demcr_ = 0, dwtControl_ = 0;
    uint64_t cycleCountFrom_ = 0;
    bool resetRequested_ = false;
    uint32_t mpuControl_ = 0, mpuRegion_ = 0;
    Region region_[regions];
    unsigned guards_ = 0; // enabled regions with restrictions
};
