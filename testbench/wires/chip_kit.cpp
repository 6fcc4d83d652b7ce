// SPDX-License-Identifier: MIT
//
// chip_kit: connects the models of a board that has the chip.

#include "chip_kit.h"

ChipKit::ChipKit(const std::vector<WireFault>& faults, XBee::Options modem)
    : soc_(air_, std::move(modem), 120, 100),
      stm32_(soc_.fsmc(), [this] { return soc_.now(); }, Stm32F2::Config()) {
    delayWires(soc_);
    plantFaults(soc_, faults);
    stm32_.wire(this);
    soc_.onIrq([this](bool high) { stm32_.setPinB(0, high); });
    stm32_.onHclk = [this](uint64_t hz) {
        soc_.fsmc().setClocks(static_cast<unsigned>(hz / 1'000'000), 100);
    };
    stm32_.onSerial = [this](uint8_t byte) {
        printed_ += static_cast<char>(byte);
        const size_t line = printed_.rfind('\n', printed_.size() - 2);
        if (byte == '\n' && printed_.compare(line + 1, 3, "END") == 0)
            ended_ = true;
    };
    soc_.reset();
}

// Returns the levels with NWAIT, which is pin PD6.
uint16_t ChipKit::levels(unsigned port, uint16_t inside) {
    if (port != 3)
        return inside;
    return static_cast<uint16_t>(inside | uint32_t(soc_.nwaitN()) << 6);
}

std::string ChipKit::run(const std::string& elf, unsigned limitMs,
                         const std::function<void(Stm32F2&)>& change) {
    stm32_.load(elf);
    stm32_.powerOn();
    stm32_.cpu().breakpoints = {stm32_.image()->symbol("main") & ~1u};
    (void)stm32_.run();
    stm32_.cpu().breakpoints.clear();
    change(stm32_);
    const uint64_t end = soc_.now() + uint64_t(limitMs) * 1'000'000;
    stm32_.onTime([this, end] {
        if (ended_ || soc_.now() >= end)
            stm32_.cpu().stop();
        return end;
    });
    while (!ended_ && soc_.now() < end)
        stm32_.run();
    return printed_;
}
