// SPDX-License-Identifier: MIT
//
// m3_machine: the chip's interrupt goes to PB0; the processor's time is the time of its FSMC's
// pins.

#include "m3_machine.h"
#include <cstdio>

namespace {

constexpr uint64_t pinHclkHz = SocModel::clkHz * 6 / 5; // as FsmcMaster plays it

Stm32F2::Config configOf(uint32_t hclkHz) {
    if (hclkHz == 0)
        return {1, static_cast<uint32_t>(pinHclkHz)};
    if (hclkHz < pinHclkHz || hclkHz % pinHclkHz || hclkHz % 8000)
        throw std::runtime_error("HCLK of " + std::to_string(hclkHz) +
                                 " Hz: give 0 or a multiple of " + std::to_string(pinHclkHz) +
                                 " Hz");
    return {static_cast<unsigned>(hclkHz / pinHclkHz), hclkHz};
}

} // namespace

M3Machine::M3Machine(SocModel& soc, const Config& config, std::function<bool()> poll)
    : soc_(soc), poll_(std::move(poll)),
      stm32_(
          soc.fsmc(), [&soc] { return soc.now(); }, configOf(config.hclkHz)) {
    stm32_.load(config.firmware);
    const bool asks = config.guardMs && stm32_.image()->has("uav_guardMs");
    uint32_t guardAt = asks ? stm32_.image()->symbol("uav_guardMs") : 0;
    stm32_.onTime([this, guardAt, guardMs = config.guardMs] {
        if (soc_.cycles() < nextPoll_)
            return;
        nextPoll_ = soc_.cycles() + SocModel::clkHz / 1000;
        if (guardAt)
            cpu().writeMemory(guardAt, &guardMs, sizeof guardMs);
        over_ = !poll_();
        if (over_ || (stub_ && stub_->wantsStop()))
            cpu().stop();
    });
    soc_.onIrq([this](bool high) { stm32_.setPinB(0, high); });
}

M3Machine::~M3Machine() {
    soc_.onIrq(nullptr);
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

void M3Machine::debug(GdbStub& stub) {
    powerOn();
    GdbStub::Target target{
        cpu(), [this](bool step) { return stm32_.run(step); }, [this] { stm32_.powerOn(); },
        [this] { return over_; },
        [this] {
            char text[160];
            std::snprintf(text, sizeof text,
                          "%.6f s simulated, %llu instructions, %llu cycles; last fault: ",
                          static_cast<double>(soc_.now()) / 1e9,
                          static_cast<unsigned long long>(cpu().instructions()),
                          static_cast<unsigned long long>(cpu().cycles()));
            return text + (cpu().lastFault.empty() ? std::string("none") : cpu().lastFault) + "\n";
        }};
    stub_ = &stub;
    // Between two debuggers the program runs.
    auto mayWait = [&] { return poll_() && (!stub.hasServed() || stub.wantsStop()); };
    while (!over_ && stub.serve(target, mayWait))
        while (!over_ && !stub.wantsStop())
            stm32_.run();
    stub_ = nullptr;
}
