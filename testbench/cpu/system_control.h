// SPDX-License-Identifier: MIT
//
// system_control: models the registers of a Cortex-M3's private peripheral bus (0xE0000000):
// SysTick, NVIC, SCB, MPU, and DWT's cycle counter, as described in the ARMv7-M ARM (DDI 0403),
// chapter B3. If a program accesses a register, a bit or a value that is not modelled, the
// simulation stops with a message (NotModelled).

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

// Exception that is thrown if a program uses a feature of the processor or of the chip that is not
// modelled.
class NotModelled : public std::runtime_error {
public:
    explicit NotModelled(const std::string& what)
        : std::runtime_error("not modelled: " + what + " (docs/simulation.md)") {}
};

// The exceptions of a Cortex-M3: which of them are pending, active and enabled, and which of them
// the processor must enter next.
//
// Source: ARMv7-M Architecture Reference Manual, B1.5. Exceptions 1 to 15 are Reset to SysTick;
// exception 16 + n is interrupt n.
enum Exception : unsigned {
    NonMaskable = 2,
    HardFault = 3,
    MemManage = 4,
    BusFault = 5,
    UsageFault = 6,
    SupervisorCall = 11,
    DebugMonitor = 12,
    PendSv = 14,
    SysTick = 15,
    FirstInterrupt = 16
};

class Exceptions {
public:
    // number of interrupts of an STM32F2 (RM0033, table 61)
    static constexpr unsigned interrupts = 81;
    static constexpr unsigned count = FirstInterrupt + interrupts;
    static constexpr uint8_t priorityBits = 0xF0; // implemented bits of a priority: the upper four
    // execution priority of thread mode, lower than the priority of any exception
    static constexpr int none = 256;

    struct State {
        bool pending = false, active = false, enabled = false;
        // level of the interrupt line; while it is high, the interrupt becomes pending again after
        // each handler
        bool level = false;
        uint8_t priority = 0;
    };

    void reset() { *this = Exceptions(), update(); }
    // Sets or clears the pending state of an exception. An interrupt with its line high becomes
    // pending again at once, unless it is active.
    void pend(unsigned number, bool pending = true) {
        State& s = states_[number];
        s.pending = pending || (s.level && !s.active);
        update();
    }
    void enable(unsigned number, bool enabled) {
        states_[number].enabled = enabled;
        update();
    }
    void setPriority(unsigned number, uint8_t priority) {
        states_[number].priority = priority & priorityBits;
        update();
    }
    // Sets PRIGROUP, which splits a priority into group priority and subpriority.
    void setGrouping(unsigned group) {
        group_ = group & 7;
        update();
    }
    unsigned grouping() const { return group_; }
    void setLine(unsigned number, bool high) {
        State& s = states_[number];
        if (high && !s.level)
            s.pending = true;
        s.level = high;
        update();
    }
    // Makes a pending exception active.
    void enter(unsigned number) {
        states_[number].pending = false;
        states_[number].active = true;
        active_.push_back(static_cast<uint8_t>(number));
        update();
    }
    void leave(unsigned number) {
        State& s = states_[number];
        active_.erase(std::remove(active_.begin(), active_.end(), number), active_.end());
        s.active = false;
        s.pending = s.pending || s.level;
        update();
    }
    const State& operator[](unsigned number) const { return states_[number]; }
    unsigned activeCount() const { return static_cast<unsigned>(active_.size()); }
    // Returns the number of the running exception; 0 in thread mode.
    unsigned current() const { return active_.empty() ? 0 : active_.back(); }

    // Sets the mask registers of the processor.
    void setMasks(uint32_t primask, uint32_t basepri, uint32_t faultmask) {
        primask_ = primask & 1;
        basepri_ = basepri & priorityBits;
        faultmask_ = faultmask & 1;
        updateMasks();
    }

    uint32_t basepri() const { return basepri_; }
    uint32_t faultmask() const { return faultmask_; }

    // Returns the number of the exception that must be entered now; 0 if no exception must be
    // entered.
    unsigned deliverable() const { return bestPriority_ < runningPriority_ ? best_ : 0; }
    // Returns the current execution priority, raised by the mask registers; `none` in thread mode
    // without masks.
    int runningPriority() const { return runningPriority_; }
    // Returns the most urgent pending exception; 0 if no exception is pending, or if BASEPRI or
    // FAULTMASK masks this exception.
    unsigned firstPending() const { return bestPriority_ < maskPriority_ ? best_ : 0; }
    // Returns true if a pending exception ends WFI. This is an exception that would be entered if
    // PRIMASK were 0 (B1.5.19).
    bool wakes() const { return bestPriority_ < sleepPriority_; }
    int priorityOf(unsigned number) const {
        switch (number) {
        case NonMaskable:
            return -2;
        case HardFault:
            return -1;
        default:
            return states_[number].priority;
        }
    }

private:
    int groupOf(int priority) const {
        return priority < 0 ? priority : priority & ~((2 << group_) - 1) & 0xFF;
    }
    void update() {
        activePriority_ = none;
        best_ = 0;
        bestPriority_ = none;
        int bestExact = none;
        for (unsigned n = NonMaskable; n < count; ++n) {
            const State& s = states_[n];
            if (s.active)
                activePriority_ = std::min(activePriority_, groupOf(priorityOf(n)));
            bool possible =
                n < MemManage || n == SupervisorCall || n == PendSv || n == SysTick || s.enabled;
            if (s.pending && possible && priorityOf(n) < bestExact) {
                best_ = n;
                bestExact = priorityOf(n);
            }
        }
        if (best_)
            bestPriority_ = groupOf(bestExact);
        updateMasks();
    }
    void updateMasks() {
        maskPriority_ = faultmask_ ? -1 : basepri_ ? groupOf(static_cast<int>(basepri_)) : none;
        sleepPriority_ = std::min(activePriority_, maskPriority_);
        runningPriority_ = primask_ ? std::min(sleepPriority_, 0) : sleepPriority_;
    }

    std::array<State, count> states_;
    std::vector<uint8_t> active_; // numbers of the active exceptions; the last one is running
    unsigned group_ = 0;
    uint32_t primask_ = 0, basepri_ = 0, faultmask_ = 0;
    unsigned best_ = 0;
    int bestPriority_ = none, activePriority_ = none, runningPriority_ = none,
        sleepPriority_ = none, maskPriority_ = none;
};

class SystemControl {
public:
    // `calibration` is the value of SYST_CALIB.TENMS. On an STM32F2 this is the number of ticks of
    // HCLK/8 in one millisecond (RM0033, 8.1.2).
    SystemControl(Exceptions& exceptions, uint32_t calibration)
        : exceptions_(&exceptions), calibration_(calibration) {}

    void reset();
    // Read and write 32-bit registers. Accesses of 8 or 16 bits read or write a part of a register.
    // Both throw NotModelled.
    uint32_t read(uint32_t address, unsigned size);
    void write(uint32_t address, unsigned size, uint32_t value);

    // Advances the time by `cycles`. The exception SysTick becomes pending when its counter reaches
    // zero.
    void pass(unsigned cycles) {
        cycles_ += cycles;
        if (cycles_ >= tickDue_)
            tick();
    }
    uint64_t cycles() const { return cycles_; }
    // Returns the number of cycles until SysTick becomes pending, at least 1; a very large number
    // if SysTick is off.
    uint64_t untilTick() const { return tickDue_ > cycles_ ? tickDue_ - cycles_ : 1; }

    uint32_t vectorTable() const { return vtor_; }
    bool takeResetRequest();
    // Returns true if the write buffer is enabled, that is, if ACTLR.DISDEFWBUF is 0.
    bool buffersStores() const { return !(actlr_ & 1u << 1); }
    bool alignsStack() const { return ccr_ & 1u << 9; }

    // Returns true if the MPU forbids a data access to `bytes` bytes at `start`.
    bool isForbidden(uint32_t start, uint32_t bytes, bool write) const {
        return guards_ && hitsGuard(start, bytes, write);
    }
    // Returns true if the MPU forbids the execution of the instruction at an address.
    bool isExecuteNever(uint32_t address) const {
        return address >= neverFrom_ && address <= neverTo_ && hitsExecuteNever(address);
    }

    // Record a fault of the processor: they set bits of CFSR or HFSR, and the address register of
    // the fault.
    void reportFault(uint32_t cfsrBits) { cfsr_ |= cfsrBits; }
    void reportHardFault(uint32_t hfsrBits) { hfsr_ |= hfsrBits; }
    void setFaultAddress(uint32_t cfsrBits, uint32_t address);
    static constexpr uint32_t instructionAccess = 1u << 0, dataAccess = 1u << 1,
                              unstackAccess = 1u << 3, stackAccess = 1u << 4, mmfarValid = 1u << 7,
                              preciseBus = 1u << 9, impreciseBus = 1u << 10, bfarValid = 1u << 15,
                              undefined = 1u << 16, invalidState = 1u << 17,
                              invalidReturn = 1u << 18, noCoprocessor = 1u << 19,
                              unaligned = 1u << 24, instructionBus = 1u << 8, forced = 1u << 30,
                              debugEvent = 1u << 31;

private:
    struct Stored;
    static const Stored stored[];
    struct Region {
        uint32_t rbar = 0, rasr = 0;
    };
    // Reads a register into `value`, or writes `value` into it.
    bool accessWord(uint32_t address, bool write, uint32_t& value);
    bool accessInterrupts(uint32_t offset, bool write, uint32_t& value);
    bool accessPriorities(unsigned first, bool write, uint32_t& value);
    uint32_t interruptState() const; // ICSR
    uint32_t handlerState() const;   // SHCSR
    bool accessOther(uint32_t offset, bool write, uint32_t& value);
    bool accessMpu(uint32_t offset, bool write, uint32_t& value);
    void tick();
    // Returns the number of SysTick's ticks between two zeros of its counter; 0 if the counter
    // stays at zero.
    uint64_t reload() const { return load_ ? uint64_t(load_) + 1 : 0; }
    void startSysTick(uint64_t ticks);
    void controlSysTick(uint32_t value);
    void loadSysTick(uint32_t value);
    uint64_t countedCycles() const;
    void controlCycleCounter(uint32_t demcr, uint32_t control);
    const Region* regionAt(uint32_t address) const;
    void checkRegion(const Region& region) const;
    // Returns the number of HCLK cycles per tick: CLKSOURCE selects HCLK or HCLK/8.
    uint64_t tickUnit() const { return control_ & 4 ? 1 : 8; }
    uint32_t currentTicks() const;
    bool hitsExecuteNever(uint32_t address) const;
    bool hitsGuard(uint32_t start, uint32_t bytes, bool write) const;
    void updateGuards();

    static constexpr unsigned regions = 8;
    Exceptions* exceptions_;
    uint32_t calibration_;
    uint64_t cycles_ = 0, tickDue_ = ~0ull;
    uint32_t control_ = 0, load_ = 0, stoppedAt_ = 0;
    uint64_t period_ = 0; // number of ticks from the last reload to the next zero
    bool countFlag_ = false;
    uint32_t actlr_ = 0, vtor_ = 0, scr_ = 0, ccr_ = 0x200, cfsr_ = 0, hfsr_ = 0, mmfar_ = 0,
             bfar_ = 0;
    uint32_t demcr_ = 0, dwtControl_ = 0;
    uint64_t cycleCountFrom_ = 0;
    uint32_t stoppedCount_ = 0; // value of CYCCNT while it is stopped
    bool resetRequested_ = false;
    uint32_t mpuControl_ = 0, mpuRegion_ = 0;
    Region region_[regions];
    unsigned guards_ = 0; // number of enabled regions that restrict accesses
    // range of addresses that contains all execute-never regions: lowest and highest address
    uint32_t neverFrom_ = 1, neverTo_ = 0;
};
