// SPDX-License-Identifier: MIT
//
// cortex_m3: the main loop around libunicorn, and the steps before each instruction.
//
// Unicorn calls a hook before every instruction. The hook advances the time, and stops the
// processor before the instruction if an exception must be entered. Therefore, when a program
// unmasks an interrupt, the exception is entered at the same instruction as on the chip. The hook
// does not stop the processor within an IT block, because unicorn would lose the state of the
// block; an interrupt then waits for up to four instructions.

#include "cortex_m3.h"
#include "unicorn_calls.h"
#include <algorithm>
#include <cstring>

namespace {
// largest number of cycles by which the rest of the system may be advanced at once
constexpr uint64_t sleepStep = 1 << 20;
} // namespace

CortexM3::Stop CortexM3::run(bool singleStep) {
    singleStep_ = singleStep;
    stepped_ = breakpointHit_ = false;
    passBreakpoint_ = true; // do not stop again at the breakpoint at which the processor is now
    for (;;) {
        if (failure_) {
            auto failure = failure_;
            failure_ = nullptr;
            std::rethrow_exception(failure);
        }
        if (resetAsked_) {
            resetAsked_ = false;
            if (listener.systemReset)
                listener.systemReset();
            reset();
        }
        if (synchronous_.number)
            fault(synchronous_.number, synchronous_.cfsrBits, synchronous_.text);
        if (stopAsked_ || stepped_ || breakpointHit_) {
            Stop why = breakpointHit_ ? Stop::Breakpoint : stepped_ ? Stop::Stepped : Stop::Asked;
            stopAsked_ = false;
            updateAttention();
            return why;
        }
        if (lockedUp_) { // only a reset ends a lock-up
            pass(1);
            continue;
        }
        if (unsigned number = exceptions_.deliverable())
            enter(number);
        if (flashWrites_.isStale())
            for (uint32_t base : {0u, config_.flashBase})
                uc_ctl_remove_cache(uc_, base, base + config_.flashBytes - 1);
        flashWrites_.translated();
        updateAttention();
        raised_ = 0;
        uc_err error = uc_emu_start(uc_, pc_ | 1, 0, 0, 0);
        uc_reg_read(uc_, UC_ARM_REG_PC, &pc_);
        flashWrites_.undo(memory_.flash());
        handleUnicorn(error);
    }
}

void CortexM3::updateAttention() {
    attention_ = stopAsked_ || resetAsked_ || failure_ || synchronous_.number ||
                 flashWrites_.isStale() || exceptions_.deliverable() != 0;
}

void CortexM3::setSynchronous(uint32_t address, unsigned number, uint32_t cfsrBits,
                              const char* text) {
    executing_ = address;
    synchronous_ = {number, cfsrBits, text};
    attention_ = true;
    uc_emu_stop(uc_);
}

// Checks an instruction before it is executed. Returns false if the instruction faults.
bool CortexM3::mayExecute(uint32_t address, const Instruction& i) {
    if (i.base != Instruction::noBase && (reg(i.base) & i.alignment)) {
        setSynchronous(address, UsageFault, SystemControl::unaligned,
                       "LDM, STM, LDRD, STRD, LDREX or STREX at an unaligned address");
        return false;
    }
    if (control_.isExecuteNever(address) && !isMpuOff()) {
        setSynchronous(address, MemManage, SystemControl::instructionAccess,
                       "the MPU forbids to execute that");
        return false;
    }
    return true;
}

void CortexM3::onInstruction(uint32_t address) {
    if (isClearing_)
        return;
    if (masksChanged_)
        updateMasks(address);
    flashWrites_.undo(memory_.flash());
    if (store_.bytes && cycles() >= store_.due)
        drainStore();
    bool inUnit = skipped_ != 0 && address > executing_ && address < unitEnd_;
    if (!inUnit) {
        if (failure_ || synchronous_.number || raised_) {
            uc_emu_stop(uc_);
            return;
        }
        if (skipped_ != 0) {
            unsigned cycles = skipped_;
            skipped_ = 0;
            if (address == unitEnd_) { // each skipped instruction of an IT block takes one cycle
                expected_ = address;
                pass(cycles);
            }
        }
        if (attention_)
            updateAttention();
        if (instructions_ != boundaries_[1]) {
            boundaries_[0] = boundaries_[1];
            boundaries_[1] = instructions_;
        }
        stepped_ = stepped_ || (limit_ && instructions_ >= limit_);
        if (cycles() < flashFree_ && memory_.isFlash(address) && !attention_)
            waitForFlash();
        if (attention_ || stepped_) {
            uc_emu_stop(uc_);
            return;
        }
        if (!breakpoints.empty() && !passBreakpoint_ && breakpoints.count(address)) {
            breakpointHit_ = true;
            uc_emu_stop(uc_);
            return;
        }
        passBreakpoint_ = false;
    } else {
        --skipped_;
        expected_ = address;
    }
    const Instruction& i = instructionAt(address);
    if (mayExecute(address, i))
        execute(address, i);
}

void CortexM3::execute(uint32_t address, const Instruction& i) {
    if (listener.instruction)
        listener.instruction(address);
    unsigned cycles = i.cycles;
    if (address != expected_ && expected_)
        cycles += refillCycles;
    executing_ = address;
    expected_ = address + i.bytes;
    ++instructions_;
    pass(cycles);
    stepped_ = singleStep_;
    switch (i.kind) {
    case Instruction::If: {
        uint32_t at = expected_;
        for (unsigned n = 0; n < i.conditional; ++n)
            at += instructionAt(at).bytes;
        unitEnd_ = at;
        skipped_ = i.conditional;
        break;
    }
    case Instruction::Sleep:
        drainStore();
        sleep();
        break;
    case Instruction::Barrier:
        drainStore();
        break;
    case Instruction::Masks:
        masksChanged_ = true;
        special_ = i.special;
        break;
    case Instruction::Exclusive:
        exclusive_ = true;
        break;
    case Instruction::Refused:
        failure_ = std::make_exception_ptr(NotModelled("WFE, SEV and YIELD"));
        break;
    case Instruction::Unprivileged:
        failure_ = std::make_exception_ptr(
            NotModelled("an unprivileged access (LDRT, STRT and similar instructions)"));
        break;
    case Instruction::Plain:
        break;
    }
}

const Instruction& CortexM3::instructionAt(uint32_t address) {
    auto decode = [&] {
        uint16_t halves[2] = {0, 0};
        if (!readMemory(address, halves, 4))
            readMemory(address, halves, 2);
        return decodeInstruction(halves[0], halves[1]);
    };
    const uint32_t offset = memory_.flashOffset(address);
    if (offset >= config_.flashBytes)
        return scratch_ = decode();
    Instruction& i = flashWrites_.decodedAt(offset);
    if (i.bytes == 0)
        i = decode();
    return i;
}

template <class Time> void CortexM3::passing(Time time) {
    try {
        time();
    } catch (...) {
        failure_ = std::current_exception();
    }
    attention_ = attention_ || failure_ || exceptions_.deliverable();
}

void CortexM3::pass(unsigned cycles) {
    control_.pass(cycles);
    passing([&] { bus_.pass(cycles); });
}

void CortexM3::sleep() {
    asleep_ = true;
    uint64_t from = cycles();
    while (!exceptions_.wakes() && !stopAsked_ && !resetAsked_ && !failure_)
        passing([&] {
            control_.pass(
                bus_.sleep(static_cast<unsigned>(std::min(control_.untilTick(), sleepStep))));
        });
    sleeping_ += cycles() - from;
    asleep_ = false;
}

// Advances the time until instructions can be fetched from flash again, or until another event must
// be handled.
void CortexM3::waitForFlash() {
    while (cycles() < flashFree_ && !stopAsked_ && !resetAsked_ && !failure_)
        passing([&] {
            const uint64_t wanted = std::min(flashFree_ - cycles(), control_.untilTick());
            control_.pass(bus_.sleep(static_cast<unsigned>(std::min(wanted, sleepStep))));
        });
    updateAttention();
}

// Keeps only the four implemented bits of BASEPRI. A write to BASEPRI_MAX is ignored if these four
// bits are 0.
void CortexM3::fixBasepri() {
    constexpr uint8_t basepriMax = 18;
    const uint32_t value = reg(Basepri), kept = value & Exceptions::priorityBits;
    if (value != kept)
        setReg(Basepri, kept || special_ != basepriMax ? kept : exceptions_.basepri());
}

// FAULTMASK cannot be set in the handlers of hard faults and NMI (B5.2.3).
void CortexM3::fixFaultmask() {
    if (reg(Faultmask) && !exceptions_.faultmask() && exceptions_.runningPriority() <= -1)
        setReg(Faultmask, 0);
}

void CortexM3::updateMasks(uint32_t address) {
    masksChanged_ = false;
    fixBasepri();
    fixFaultmask();
    if (reg(Control) & 1)
        failure_ = std::make_exception_ptr(NotModelled("unprivileged code (CONTROL.nPRIV)"));
    exceptions_.setMasks(reg(Primask), reg(Basepri), reg(Faultmask));
    attention_ = attention_ || exceptions_.deliverable();
    masked_.update(reg(Primask) || reg(Faultmask), reg(Basepri), cycles(), executing_, address);
}

void CortexM3::setInterrupt(unsigned number, bool high) {
    exceptions_.setLine(FirstInterrupt + number, high);
    attention_ = attention_ || exceptions_.deliverable();
}

void CortexM3::pendInterrupt(unsigned number) {
    exceptions_.pend(FirstInterrupt + number);
    attention_ = attention_ || exceptions_.deliverable();
}
