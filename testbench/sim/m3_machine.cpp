// SPDX-License-Identifier: MIT
//
// m3_machine: the chip's interrupt goes to PB0; the processor's time is the time of its FSMC's pins.

#include "m3_machine.h"

namespace {

constexpr uint64_t pinHclkHz = SocModel::clkHz * 6 / 5; // as FsmcMaster plays it

Stm32F2::Config configOf(uint32_t hclkHz) {
    if (hclkHz == 0)
        return {1, static_cast<uint32_t>(pinHclkHz)};
    if (hclkHz < pinHclkHz || hclkHz % pinHclkHz || hclkHz % 8000)
        throw std::runtime_error("HCLK of " + std::to_string(hclkHz) + " Hz: give 0 or a multiple of " +
                                 std::to_string(pinHclkHz) + " Hz");
    return {static_cast<unsigned>(hclkHz / pinHclkHz), hclkHz};
}

} // namespace

M3Machine::M3Machine(SocModel& soc, const Config& config, std::function<bool()> poll)
    : soc_(soc), poll_(std::move(poll)),
      stm32_(soc.fsmc(), [&soc] { return soc.now(); }, configOf(config.hclkHz)) {
    stm32_.load(config.firmware);
    stm32_.onTime([this] {
        if (soc_.cycles() < nextPoll_)
            return;
        nextPoll_ = soc_.cycles() + SocModel::clkHz / 1000;
        if (!poll_()) {
            over_ = true;
            cpu().stop();
        }
    });
    soc_.onIrq([this](bool high) { stm32_.setPinB(0, high); });
}

M3Machine::~M3Machine() { soc_.onIrq(nullptr); }

void M3Machine::run() {
    if (!powered_)
        stm32_.powerOn();
    powered_ = true;
    over_ = false;
    while (!over_)
        stm32_.run();
}
