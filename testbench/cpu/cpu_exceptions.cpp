// SPDX-License-Identifier: MIT
//
// cpu_exceptions: the part of CortexM3 with its construction, reset, exception entry and return,
// and faults (ARMv7-M ARM, B1.5).

#include "cortex_m3.h"
#include "unicorn_calls.h"
#include <cstring>
#include <utility>

namespace {

// cycles of exception entry, return and tail-chaining (Cortex-M3 TRM, 5.5 and 5.9)
constexpr unsigned entryCycles = 12, exitCycles = 10, chainCycles = 6;
constexpr uint32_t returnHandler = 0xFFFFFFF1, returnMain = 0xFFFFFFF9, returnProcess = 0xFFFFFFFD;
constexpr uint32_t thumb = 1u << 24, aligned = 1u << 9, exceptionMask = 0x1FF;
constexpr uint32_t ifThenMask = 0x0600FC00; // ICI/IT bits of xPSR
// A page at the end of the FSMC's address range. The model puts a CLREX instruction there, and
// executes it in order to close the exclusive monitor.
constexpr uint32_t clrexPage = 0x9FFFF000, pageBytes = 0x1000;
constexpr uint16_t clrex[2] = {0xF3BF, 0x8F2F};

// Returns true if the default memory map forbids execution at an address, as it does in the device
// and system regions (B3.1, table B3-1).
bool isNeverExecuted(uint32_t address) {
    return (address >= 0x40000000 && address < 0x60000000) || address >= 0xA0000000;
}

void check(uc_err error, const char* what) {
    if (error != UC_ERR_OK)
        throw std::runtime_error(std::string("libunicorn: ") + what + ": " + uc_strerror(error));
}

} // namespace

int UnicornCalls::registerId(int number) {
    static const int ids[CortexM3::Registers] = {
        UC_ARM_REG_R0,      UC_ARM_REG_R1,        UC_ARM_REG_R2,     UC_ARM_REG_R3,
        UC_ARM_REG_R4,      UC_ARM_REG_R5,        UC_ARM_REG_R6,     UC_ARM_REG_R7,
        UC_ARM_REG_R8,      UC_ARM_REG_R9,        UC_ARM_REG_R10,    UC_ARM_REG_R11,
        UC_ARM_REG_R12,     UC_ARM_REG_SP,        UC_ARM_REG_LR,     UC_ARM_REG_PC,
        UC_ARM_REG_XPSR,    UC_ARM_REG_MSP,       UC_ARM_REG_PSP,    UC_ARM_REG_PRIMASK,
        UC_ARM_REG_BASEPRI, UC_ARM_REG_FAULTMASK, UC_ARM_REG_CONTROL};
    return ids[number];
}

CortexM3::CortexM3(CpuBus& bus, const Config& config, const std::vector<Window>& windows)
    : bus_(bus), config_(config),
      memory_({config.flashBase, config.flashBytes}, {config.ramBase, config.ramBytes}),
      flashWrites_(config.flashBytes), control_(exceptions_, config.calibration) {
    check(uc_open(UC_ARCH_ARM, static_cast<uc_mode>(UC_MODE_THUMB | UC_MODE_MCLASS), &uc_), "open");
    check(uc_ctl_set_cpu_model(uc_, UC_CPU_ARM_CORTEX_M3), "Cortex-M3");
    for (uint32_t base : {0u, config.flashBase})
        check(uc_mem_map_ptr(uc_, base, config.flashBytes, UC_PROT_ALL, memory_.flash()), "flash");
    check(uc_mem_map_ptr(uc_, config.ramBase, config.ramBytes, UC_PROT_ALL, memory_.ram()), "RAM");
    check(uc_mem_map(uc_, clrexPage, pageBytes, UC_PROT_EXEC), "memory");
    check(uc_mem_write(uc_, clrexPage, clrex, sizeof clrex), "memory");
    std::vector<Window> all = windows;
    all.push_back({0xE0000000, 0x100000});
    all.push_back({0x22000000, 32 * config.ramBytes});
    all.push_back({0x42000000, 0x2000000});
    for (const Window& w : all) {
        windows_.push_back(std::make_unique<MappedWindow>(MappedWindow{this, w.base}));
        void* user = windows_.back().get();
        check(
            uc_mmio_map(uc_, w.base, w.bytes, UnicornCalls::read, user, UnicornCalls::write, user),
            "window");
    }
    uc_hook hook;
    check(uc_hook_add(uc_, &hook, UC_HOOK_CODE, reinterpret_cast<void*>(UnicornCalls::code), this,
                      1, 0),
          "hook");
    check(uc_hook_add(uc_, &hook, UC_HOOK_INTR, reinterpret_cast<void*>(UnicornCalls::raised), this,
                      1, 0),
          "hook");
    check(uc_hook_add(uc_, &hook, UC_HOOK_MEM_READ | UC_HOOK_MEM_WRITE,
                      reinterpret_cast<void*>(UnicornCalls::access), this, config.ramBase,
                      uint64_t(config.ramBase) + config.ramBytes - 1),
          "hook");
    for (uint32_t base : {0u, config.flashBase})
        check(uc_hook_add(uc_, &hook, UC_HOOK_MEM_WRITE,
                          reinterpret_cast<void*>(UnicornCalls::flashWrite), this, base,
                          uint64_t(base) + config.flashBytes - 1),
              "hook");
}

CortexM3::~CortexM3() {
    uc_close(uc_);
}

bool CortexM3::writeMemory(uint32_t address, const void* data, uint32_t bytes) {
    if (memory_.isInRam(address, bytes))
        return uc_mem_write(uc_, address, data, bytes) == UC_ERR_OK;
    uint8_t was;
    if (address >= config_.ramBase || !readMemory(address, &was, 1) ||
        !readMemory(address + bytes - 1, &was, 1))
        return false;
    // Changes flash as a flash programmer would; the model needs no erase for this.
    const uint32_t offset = memory_.flashOffset(address);
    std::memcpy(memory_.flash() + offset, data, bytes);
    flashChanged(offset, bytes);
    return true;
}

void CortexM3::loadFlash(uint32_t address, const std::vector<uint8_t>& bytes) {
    if (!bytes.empty() && !writeMemory(address, bytes.data(), static_cast<uint32_t>(bytes.size())))
        throw std::runtime_error("the program does not fit into flash and RAM");
}

uint32_t CortexM3::word(uint32_t address) const {
    uint32_t value = 0;
    (void)readMemory(address, &value, 4);
    return value;
}

uint32_t CortexM3::reg(int number) const {
    if (number == Pc)
        return pc_;
    uint32_t value = 0;
    uc_reg_read(uc_, UnicornCalls::registerId(number), &value);
    return value;
}

void CortexM3::setReg(int number, uint32_t value) {
    if (number == Pc) {
        pc_ = value & ~1u;
        // A debugger has moved the program counter, so a fault of the previous instruction does not
        // happen. A program in RAM can therefore start although an empty flash has no valid reset
        // vector.
        synchronous_.number = 0;
        updateAttention();
    } else
        uc_reg_write(uc_, UnicornCalls::registerId(number), &value);
    if (number >= Primask)
        exceptions_.setMasks(reg(Primask), reg(Basepri), reg(Faultmask));
}

unsigned CortexM3::currentException() const {
    return reg(Xpsr) & exceptionMask;
}

void CortexM3::reset() {
    control_.reset();
    lockedUp_ = false;
    flashFree_ = 0;
    synchronous_.number = 0;
    store_.bytes = 0;
    raised_ = skipped_ = unitEnd_ = expected_ = 0;
    masksChanged_ = false;
    masked_.reset();
    clearExclusive();
    setReg(Xpsr, thumb);
    for (int r : {Primask, Basepri, Faultmask, Control})
        setReg(r, 0);
    setReg(Msp, word(0) & ~3u);
    setReg(Lr, 0xFFFFFFFF);
    pc_ = word(4) & ~1u;
    if (!(word(4) & 1)) {
        executing_ = pc_;
        synchronous_ = {UsageFault, SystemControl::invalidState,
                        "a reset vector without its lowest bit"};
    }
    updateAttention();
}

// Exception entry and exception return close the exclusive monitor, but libunicorn does not notice
// them; this function closes the monitor.
void CortexM3::clearExclusive() {
    if (!std::exchange(exclusive_, false))
        return;
    isClearing_ = true;
    check(uc_emu_start(uc_, clrexPage | 1, clrexPage + sizeof clrex, 0, 0), "CLREX");
    isClearing_ = false;
}

void CortexM3::jumpTo(unsigned number) {
    setReg(Xpsr, (reg(Xpsr) & ~(exceptionMask | ifThenMask)) | thumb | number);
    setReg(Control, reg(Control) & ~2u);
    clearExclusive();
    exceptions_.enter(number);
    uint32_t vector = 0;
    if (!readMemory(control_.vectorTable() + 4 * number, &vector, 4))
        throw NotModelled("a vector table outside of flash and RAM");
    pc_ = vector & ~1u;
    if (!(vector & 1)) {
        executing_ = pc_;
        synchronous_ = {UsageFault, SystemControl::invalidState, "a vector without its lowest bit"};
    }
    expected_ = 0;
    if (listener.entered)
        listener.entered(number);
}

void CortexM3::enter(unsigned number) {
    drainStore();
    bool handler = currentException() != 0, process = !handler && (reg(Control) & 2);
    uint32_t xpsr = reg(Xpsr), sp = reg(Sp);
    uint32_t padding = control_.alignsStack() && (sp & 4) ? 4 : 0;
    uint32_t frame = sp - 32 - padding;
    const uint32_t saved[8] = {
        reg(0),  reg(1),  reg(2), reg(3),
        reg(12), reg(Lr), pc_,    (xpsr & ~aligned) | (padding ? aligned : 0)};
    bool guarded = !isMpuOff() && control_.isForbidden(frame, 32, true);
    if (guarded || !writeMemory(frame, saved, 32)) {
        lastFault = "the stack pointer is bad at the entry of an exception";
        control_.reportFault(guarded ? SystemControl::stackAccess
                                     : SystemControl::stackAccess << 8);
        unsigned derived = guarded ? MemManage : BusFault;
        bool possible = exceptions_[derived].enabled &&
                        exceptions_.priorityOf(derived) < exceptions_.runningPriority();
        if (!possible)
            control_.reportHardFault(SystemControl::forced);
        // the frame on the stack is lost, as on the chip
        number = possible ? derived : unsigned(HardFault);
    }
    setReg(Sp, frame);
    setReg(Lr, handler ? returnHandler : process ? returnProcess : returnMain);
    jumpTo(number);
    pass(entryCycles);
}

void CortexM3::leave() {
    uint32_t number = currentException(), how = pc_ | 1;
    uint32_t kind = how & 0xF;
    bool valid = number && (kind == 1 || kind == 9 || kind == 13) &&
                 (kind == 1) == (exceptions_.activeCount() > 1);
    exceptions_.leave(number);
    if (number != NonMaskable)
        setReg(Faultmask, 0);
    if (listener.left)
        listener.left(number);
    exceptions_.setMasks(reg(Primask), reg(Basepri), reg(Faultmask));
    if (!valid) {
        synchronous_ = {UsageFault, SystemControl::invalidReturn, "wrong EXC_RETURN value"};
        return;
    }
    // tail-chaining: the frame remains on the stack for the next exception
    if (unsigned next = exceptions_.deliverable()) {
        setReg(Lr, how);
        jumpTo(next);
        pass(chainCycles);
        return;
    }
    drainStore();
    clearExclusive();
    int stack = kind == 13 ? Psp : Msp;
    uint32_t frame = reg(stack), saved[8];
    if (!isMpuOff() && control_.isForbidden(frame, 32, false)) {
        lastFault = "the MPU forbids to read the frame of an exception";
        synchronous_ = {MemManage, SystemControl::unstackAccess, lastFault};
        return;
    }
    if (!readMemory(frame, saved, 32)) {
        lastFault = "the stack pointer is bad at the return from an exception";
        synchronous_ = {BusFault, SystemControl::stackAccess << 7, lastFault};
        return;
    }
    if ((kind == 1) != ((saved[7] & exceptionMask) != 0)) {
        synchronous_ = {UsageFault, SystemControl::invalidReturn,
                        "the stacked xPSR is of another mode"};
        return;
    }
    for (int r = 0; r < 4; ++r)
        setReg(r, saved[r]);
    setReg(12, saved[4]);
    setReg(stack, frame + 32 + (saved[7] & aligned ? 4 : 0));
    setReg(Xpsr, (saved[7] & ~aligned) | thumb);
    if (kind != 1)
        setReg(Control, (reg(Control) & ~2u) | (kind == 13 ? 2 : 0));
    setReg(Lr, saved[5]);
    pc_ = saved[6] & ~1u;
    expected_ = 0;
    if (!(saved[7] & thumb)) {
        executing_ = pc_;
        synchronous_ = {UsageFault, SystemControl::invalidState, "the stacked xPSR has no T bit"};
    }
    pass(exitCycles);
}

// Reports the fault of a buffered store. The fault becomes pending, and is taken according to its
// priority.
void CortexM3::reportStoreFault(const std::string& text) {
    char where[40];
    std::snprintf(where, sizeof where, " (a store before 0x%08X)", expected_);
    lastFault = text + where;
    control_.reportFault(SystemControl::impreciseBus);
    const bool possible = exceptions_[BusFault].enabled;
    if (!possible)
        control_.reportHardFault(SystemControl::forced);
    exceptions_.pend(possible ? BusFault : HardFault);
    attention_ = true;
}

void CortexM3::fault(unsigned number, uint32_t cfsrBits, const std::string& text) {
    char where[40];
    std::snprintf(where, sizeof where, " (at 0x%08X)", executing_);
    lastFault = text + where;
    synchronous_.number = 0;
    control_.reportFault(cfsrBits);
    bool possible = number == SupervisorCall || exceptions_[number].enabled;
    int own = exceptions_.priorityOf(number), running = exceptions_.runningPriority();
    if (!possible || own >= running) { // escalation
        control_.reportHardFault(number == DebugMonitor ? SystemControl::debugEvent
                                                        : SystemControl::forced);
        if (running <= -1) {
            lockedUp_ = true;
            lastFault += "; in the handler of a hard fault: the processor locks up";
            return;
        }
        number = HardFault;
    }
    exceptions_.pend(number);
    enter(number);
}

void CortexM3::onRaised(uint32_t number) {
    raised_ = number;
    uc_emu_stop(uc_);
}

// Sets the fault for an invalid instruction. libunicorn reports an undefined instruction and a jump
// to an even address in the same way, so xPSR.T is checked here.
void CortexM3::undefinedAt(uint32_t address) {
    if (!(reg(Xpsr) & thumb)) {
        synchronous_ = {UsageFault, SystemControl::invalidState, "a jump out of Thumb state"};
        return;
    }
    pc_ = address;
    synchronous_ = {UsageFault, SystemControl::undefined, "undefined instruction"};
}

void CortexM3::fetchFault() {
    if (isNeverExecuted(pc_))
        synchronous_ = {MemManage, SystemControl::instructionAccess,
                        "devices and system registers are not executed"};
    else
        synchronous_ = {BusFault, SystemControl::instructionBus, "nothing to execute there"};
}

void CortexM3::handleRaised() {
    enum {
        Undefined = 1,
        Software = 2,
        Fetch = 3,
        Breakpoint = 7,
        ExceptionReturn = 8,
        NoCoprocessor = 17,
        State = 18
    };
    switch (std::exchange(raised_, 0)) {
    case ExceptionReturn:
        return leave();
    case Software:
        if (exceptions_.priorityOf(SupervisorCall) < exceptions_.runningPriority()) {
            exceptions_.pend(SupervisorCall);
            enter(SupervisorCall);
        } else {
            pc_ = executing_;
            fault(HardFault, 0, "SVC at a priority that is not below its own");
        }
        return;
    case Breakpoint:
        pc_ = executing_;
        if (hasDebugger)
            breakpointHit_ = true;
        else // C1.5; the exception DebugMonitor is never enabled, so this is a hard fault
            fault(DebugMonitor, 0, "BKPT without a debugger");
        return;
    case Fetch:
        return fetchFault();
    case NoCoprocessor:
        pc_ = executing_;
        synchronous_ = {UsageFault, SystemControl::noCoprocessor,
                        "access to a missing coprocessor"};
        return;
    case State:
        synchronous_ = {UsageFault, SystemControl::invalidState, "a jump out of Thumb state"};
        return;
    default:
        pc_ = executing_;
        synchronous_ = {UsageFault, SystemControl::undefined, "undefined instruction"};
    }
}

void CortexM3::handleUnicorn(uc_err error) {
    if (synchronous_.number) { // the fault was caused by the instruction at executing_
        pc_ = executing_;
        return;
    }
    if (raised_)
        return handleRaised();
    const std::string text = uc_strerror(error);
    switch (error) {
    case UC_ERR_OK:
        return;
    case UC_ERR_WRITE_UNMAPPED:
        pc_ = expected_;
        reportStoreFault(text);
        return;
    case UC_ERR_READ_UNMAPPED:
    case UC_ERR_READ_PROT:
    case UC_ERR_WRITE_PROT:
        pc_ = executing_;
        synchronous_ = {BusFault, SystemControl::preciseBus, text};
        return;
    case UC_ERR_FETCH_UNMAPPED:
    case UC_ERR_FETCH_PROT:
        return fetchFault();
    case UC_ERR_INSN_INVALID:
    case UC_ERR_EXCEPTION:
        return undefinedAt(executing_);
    default:
        throw std::runtime_error("libunicorn: " + text);
    }
}
