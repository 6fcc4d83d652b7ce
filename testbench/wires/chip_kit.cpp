// SPDX-License-Identifier: MIT
//
// chip_kit: applies faults to the models around the chip.

#include "chip_kit.h"
#include "pin_delays.h"

namespace {

// Typical delays for wires of 10 cm.
const FsmcCorner kitDelays = {"kit", 2000, 3000, 1000, 500, 1500, 600, 2000, 2500, 5000, 1000, 500};

} // namespace

ChipKit::ChipKit(const std::vector<WireFault>& faults, XBee::Options modem)
    : soc_(air_, std::move(modem), 120, 100),
      stm32_(soc_.fsmc(), [this] { return soc_.now(); }, Stm32F2::Config()) {
    soc_.delay(kitDelays, 1, false);
    soc_.fsmc().tolerate();
    for (const WireFault& fault : faults)
        plant(fault);
    if (hasMemoryFault_)
        soc_.memory().plant(memory_);
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
    if (neverCalibrates_)
        soc_.memory().restart(~0u >> 1);
}

// Returns the levels with NWAIT, which is pin PD6.
uint16_t ChipKit::levels(unsigned port, uint16_t inside) {
    if (port != 3)
        return inside;
    return static_cast<uint16_t>(inside | uint32_t(soc_.chip().fsmc_nwait_n_o) << 6);
}

void ChipKit::plant(const WireFault& fault) {
    if (fault.kind == WireFault::Late) {
        soc_.fsmc().makeLate(fault.wire, static_cast<int>(1000 * fault.value));
        return;
    }
    // Names such as DDR_DQ3, DDR_A12, DDR_BA1, DDR_LDM, DDR_UDM, DDR_LDQS, DDR_UDQS or DDR_CK.
    if (fault.wire.compare(0, 4, "DDR_") != 0)
        throw std::runtime_error("wire " + fault.wire + ": not a wire that the chip's model has");
    hasMemoryFault_ = true;
    const bool high = fault.kind == WireFault::Stuck1 || fault.kind == WireFault::Open;
    const bool isShort = fault.kind == WireFault::Short;
    auto lineOf = [](const std::string& wire, const std::string& prefix) {
        return 1u << std::stoul(wire.substr(prefix.size()));
    };
    auto startsWith = [&fault](const char* prefix) { return fault.wire.rfind(prefix, 0) == 0; };
    if (startsWith("DDR_DQ")) {
        unsigned lines = lineOf(fault.wire, "DDR_DQ");
        if (isShort)
            memory_.dqShort = static_cast<uint16_t>(lines | lineOf(fault.other, "DDR_DQ"));
        else
            (high ? memory_.dqHigh : memory_.dqLow) = static_cast<uint16_t>(lines);
    } else if (startsWith("DDR_BA")) {
        unsigned lines = lineOf(fault.wire, "DDR_BA");
        (isShort ? memory_.bankShort : memory_.bankLow) =
            static_cast<uint8_t>(isShort ? lines | lineOf(fault.other, "DDR_BA") : lines);
    } else if (startsWith("DDR_A")) {
        unsigned lines = lineOf(fault.wire, "DDR_A");
        (isShort ? memory_.addressShort : memory_.addressLow) =
            static_cast<uint16_t>(isShort ? lines | lineOf(fault.other, "DDR_A") : lines);
    } else if (startsWith("DDR_LDM") || startsWith("DDR_UDM")) {
        const uint8_t lane = startsWith("DDR_LDM") ? 1 : 2;
        (fault.kind == WireFault::Stuck1 ? memory_.maskHigh : memory_.maskLow) = lane;
    } else if (startsWith("DDR_LDQS") || startsWith("DDR_UDQS")) {
        memory_.strobeOpen = startsWith("DDR_LDQS") ? 1 : 2;
    } else {
        neverCalibrates_ = true; // a fault of clock, commands or supply
    }
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
