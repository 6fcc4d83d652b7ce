// SPDX-License-Identifier: MIT
//
// m3_machine: connects the processor to the wires of the board, and computes the time of the
// processor from the cycles of its FSMC pins.

#include "m3_machine.h"
#include "tell_on_abort.h"
#include <algorithm>
#include <fmt/format.h>

namespace {

constexpr uint64_t pinHclkHz = SocModel::clkHz * 6 / 5; // HCLK frequency of FsmcMaster, Hz

Stm32F2::Config configOf(uint32_t hclkHz, uint64_t seed, uint32_t oscillatorHz) {
    if (hclkHz == 0)
        return {1, static_cast<uint32_t>(pinHclkHz), seed, oscillatorHz};
    if (hclkHz < pinHclkHz || hclkHz % pinHclkHz || hclkHz % 8000)
        throw std::runtime_error("HCLK of " + std::to_string(hclkHz) +
                                 " Hz: expected 0 or a multiple of " + std::to_string(pinHclkHz) +
                                 " Hz");
    return {static_cast<unsigned>(hclkHz / pinHclkHz), hclkHz, seed, oscillatorHz};
}

// Returns the name of the current function, and the names of the functions with return addresses
// on the stack.
std::string stackOf(Stm32F2& stm32) {
    const CortexM3& cpu = stm32.cpu();
    std::string text = stm32.image()->functionAt(cpu.reg(CortexM3::Pc));
    for (uint32_t at = cpu.reg(CortexM3::Sp), end = at + 256; at < end; at += 4) {
        const uint32_t word = cpu.word(at);
        if ((word & 1) && word >> 20 == 0x080) // the word is an address of code in flash
            text += ", " + stm32.image()->functionAt(word);
    }
    return text;
}

} // namespace

void provideKeys(SimulatedBoard& board, const M3Machine::Config& config) {
    board.provide(config.key, config.address);
    board.providePeers(config.peers);
}

M3Machine::M3Machine(SocModel& soc, const Config& config, std::function<bool()> poll)
    : soc_(soc), poll_(std::move(poll)), fpgaFlash_([&soc] { return soc.now(); }, config.seed),
      stm32_(
          soc.fsmc(), [&soc] { return soc.now(); },
          configOf(config.hclkHz, config.seed, soc.wires().oscillatorHz())) {
    stm32_.load(config.firmware);
    cpu().hasDebugger = false;
    SimulatedBoard board;
    provideKeys(board, config);
    std::copy(board.words.begin(), board.words.end(), stm32_.backup().begin());
    stm32_.setPinB(1, !config.isWired);
    if (config.flash.empty())
        program.emplace(stm32_.cpu(), *stm32_.image(), [&soc] { return soc.cycles(); });
    else
        cpu().loadFlash(0x08000000, config.flash);
    if (!config.fpgaFlash.empty()) {
        fpgaFlash_.memory = config.fpgaFlash;
        stm32_.fpga.wire(fpgaFlash_);
        stm32_.fpga.onReconfigured = [this] { soc_.reset(true); };
    }
    const bool asks = config.guardMs && config.flash.empty() && stm32_.image()->has("uav_guardMs");
    uint32_t guardAt = asks ? stm32_.image()->symbol("uav_guardMs") : 0;
    uint32_t modeAt = asks && config.isTransparent ? stm32_.image()->symbol("uav_transparent") : 0;
    stm32_.onTime([this, guardAt, modeAt, guardMs = config.guardMs] {
        if (soc_.now() >= until_)
            cpu().stop();
        if (soc_.cycles() < nextPoll_)
            return std::min(nextPoll_ * SocModel::clkNs, until_);
        nextPoll_ = soc_.cycles() + SocModel::clkHz / 1000;
        if (guardAt)
            cpu().writeMemory(guardAt, &guardMs, sizeof guardMs);
        if (modeAt)
            cpu().writeMemory(modeAt, "\1", 1);
        over_ = !poll_();
        isAsked_ = isAsked_ || (stub_ && stub_->wantsStop());
        if (over_ || isAsked_ || (checkpoints_ && soc_.now() >= nextCopyNs_))
            cpu().stop();
        return std::min(nextPoll_ * SocModel::clkNs, until_);
    });
    stm32_.wire(&soc_.wires());
    soc_.wires().follow(
        [this](unsigned port, unsigned pin) { return stm32_.pinSetting(port, pin); });
    soc_.onIrq([this](bool high) { stm32_.setPinB(0, high); });
    if (!soc_.wires().areOthersStraight() && soc_.irq()) // a line that is stuck
        stm32_.setPinB(0, true);
    tellOnAbort(this, [this] { return "The program is in " + stackOf(stm32_) + "."; });
    stm32_.onWatchdog = [this] {
        watchdogReport_ = fmt::format("the watchdog resets the processor at {:.6f} s; the firmware "
                                      "is in {}",
                                      static_cast<double>(soc_.now()) / 1e9,
                                      program ? stackOf(stm32_) : "another program");
        fmt::print(stderr, "icesoc-sim: {}\n", watchdogReport_);
    };
}

M3Machine::~M3Machine() {
    tellers.erase(this);
    soc_.onIrq(nullptr);
    soc_.wires().follow(nullptr);
}

void M3Machine::powerOn() {
    if (!powered_)
        stm32_.powerOn();
    powered_ = true;
    over_ = false;
}

void M3Machine::run() {
    powerOn();
    while (!over_)
        stm32_.run();
}

void M3Machine::advance(uint64_t ns) {
    if (!powered_)
        powerOn();
    until_ = ns;
    while (!over_ && soc_.now() < ns)
        stm32_.run();
}

void M3Machine::report() {
    const Stm32F2::Resets& resets = stm32_.resets();
    const double cycles = std::max(1.0, static_cast<double>(cpu().cycles()));
    fmt::print("icesoc-sim: Cortex-M3: {} instructions; asleep {:.1f} % of the time, {:.2f} % in "
               "bus accesses; resets: {} software, {} watchdog\n",
               cpu().instructions(), 100 * static_cast<double>(cpu().sleepingCycles()) / cycles,
               100 * static_cast<double>(cpu().busCycles()) / cycles, resets.software,
               resets.watchdog);
    if (!cpu().lastFault.empty())
        fmt::print("icesoc-sim: last fault: {} in {}\n", cpu().lastFault,
                   stm32_.image()->functionAt(cpu().reg(CortexM3::Pc)));
}

// ---- under a debugger ----

GdbStub::Target M3Machine::target() {
    GdbStub::Target target{
        cpu(),
        [this](bool step) { return resume(step); },
        [this] { stm32_.powerOn(); },
        [this] { return over_; },
        [this] {
            return fmt::format("{:.6f} s simulated, {} instructions, {} cycles; last fault: {}\n",
                               static_cast<double>(soc_.now()) / 1e9, cpu().instructions(),
                               cpu().cycles(), cpu().lastFault.empty() ? "none" : cpu().lastFault);
        },
        nullptr,
        [this] {
            return !checkpoints_ ? "" : over_ ? "end" : isAtBegin_ ? "begin" : "";
        },
        [this] {
            if (checkpoints_)
                checkpoints_->forgetBehind(cpu().instructions());
        }};
    if (checkpoints_)
        target.back = [this](bool step) { goBack(step); };
    return target;
}

void M3Machine::debug(GdbStub& stub, bool canGoBack) {
    powerOn();
    stub_ = &stub;
    // When a debugger has disconnected, the program runs without stopping until another debugger
    // connects.
    auto mayWait = [&] { return poll_() && (!stub.hasServed() || stub.wantsStop()); };
    do {
        checkpoints_ = canGoBack ? std::make_unique<Checkpoints>() : nullptr;
        nextCopyNs_ = soc_.now();
        cpu().hasDebugger = true;
        const bool goesOn = stub.serve(target(), mayWait);
        cpu().hasDebugger = false;
        checkpoints_ = nullptr;
        if (!goesOn)
            break;
        while (!over_ && !stub.wantsStop())
            stm32_.run();
    } while (!over_);
    stub_ = nullptr;
}

// Runs as the debugger commands. During the run, makes frozen copies of the process: at first every
// 50 ms of simulated time, later at intervals of a sixteenth of the elapsed time.
CortexM3::Stop M3Machine::resume(bool singleStep) {
    constexpr uint64_t copyNs = 50'000'000;
    isAtBegin_ = isAsked_ = false;
    for (;;) {
        if (checkpoints_ && soc_.now() >= nextCopyNs_) {
            nextCopyNs_ = soc_.now() + std::max(copyNs, soc_.now() / 16);
            const uint64_t from = cpu().instructions();
            if (auto order = checkpoints_->freeze(from))
                return follow(*order, from);
        }
        const CortexM3::Stop why = stm32_.run(singleStep);
        if (why != CortexM3::Stop::Asked || over_ || isAsked_)
            return why;
    }
}

// Goes back to the last earlier place at which the processor can stop, or to the last breakpoint.
// One woken copy searches for this place; a second copy then runs to it. Returns only if there is
// no such place.
void M3Machine::goBack(bool singleStep) {
    const uint64_t here = cpu().instructions();
    if (checkpoints_->isFirst(here))
        return;
    using Order = Checkpoints::Order;
    checkpoints_->wake(
        here - 1, {singleStep ? Order::LastStop : Order::LastBreakpoint, here, cpu().breakpoints});
}

// Runs until this number of instructions has been executed. Returns false if a breakpoint was
// reached first.
bool M3Machine::runTo(uint64_t instructions) {
    CortexM3::Stop why = CortexM3::Stop::Asked;
    cpu().setLimit(instructions);
    while (why == CortexM3::Stop::Asked && cpu().instructions() < instructions && !over_)
        why = stm32_.run();
    cpu().setLimit(0);
    return why != CortexM3::Stop::Breakpoint;
}

// Carries out the order that this woken copy received; `from` is the place at which the copy was
// made.
CortexM3::Stop M3Machine::follow(const Checkpoints::Order& order, uint64_t from) {
    using Order = Checkpoints::Order;
    cpu().breakpoints.clear();
    if (order.goal == Order::LastBreakpoint) {
        cpu().breakpoints = order.breakpoints;
        uint64_t found = 0;
        if (order.breakpoints.count(cpu().reg(CortexM3::Pc)))
            found = from;
        while (!runTo(order.place))
            if (cpu().instructions() < order.place)
                found = cpu().instructions();
        if (!found && !checkpoints_->isFirst(from))
            checkpoints_->wake(from - 1, {Order::LastBreakpoint, from, order.breakpoints});
        checkpoints_->wake(std::max(found, from), {Order::Stop, found, order.breakpoints});
    }
    runTo(order.place);
    if (order.goal == Order::LastStop)
        checkpoints_->wake(from, {Order::Stop, cpu().lastStop(), order.breakpoints});
    cpu().breakpoints = order.breakpoints;
    isAtBegin_ = order.place == 0;
    return CortexM3::Stop::Stepped;
}
