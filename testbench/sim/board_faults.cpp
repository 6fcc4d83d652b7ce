// SPDX-License-Identifier: MIT
//
// board_faults: maps each fault to the model that has the faulty part.

#include "board_faults.h"
#include "pin_delays.h"
#include <algorithm>

namespace {

const FsmcCorner kitDelays = {"kit", 2000, 3000, 1000, 500, 1500, 600, 2000, 2500, 5000, 1000, 500};

// Returns the bit of a line such as DDR_A12.
unsigned bitOf(const std::string& wire, const std::string& prefix) {
    return 1u << std::stoul(wire.substr(prefix.size()));
}

// Adds a fault of a DDR3 line. Returns false if the memory does not start with it.
bool addMemoryFault(McbModel::Lines& lines, const WireFault& fault) {
    auto startsWith = [&fault](const char* prefix) { return fault.wire.rfind(prefix, 0) == 0; };
    const bool isShort = fault.kind == WireFault::Short;
    auto bits = [&](const char* prefix) {
        return bitOf(fault.wire, prefix) | (isShort ? bitOf(fault.other, prefix) : 0);
    };
    const uint8_t lane = startsWith("DDR_L") ? 1 : 2;
    if (startsWith("DDR_DQ")) {
        const bool isHigh = fault.kind == WireFault::Stuck1 || fault.kind == WireFault::Open;
        uint16_t& line = isShort ? lines.dqShort : isHigh ? lines.dqHigh : lines.dqLow;
        line = static_cast<uint16_t>(line | bits("DDR_DQ"));
    } else if (startsWith("DDR_BA")) {
        uint8_t& line = isShort ? lines.bankShort : lines.bankLow;
        line = static_cast<uint8_t>(line | bits("DDR_BA"));
    } else if (startsWith("DDR_A")) {
        uint16_t& line = isShort ? lines.addressShort : lines.addressLow;
        line = static_cast<uint16_t>(line | bits("DDR_A"));
    } else if (startsWith("DDR_LDM") || startsWith("DDR_UDM")) {
        (fault.kind == WireFault::Stuck1 ? lines.maskHigh : lines.maskLow) |= lane;
    } else if (startsWith("DDR_LDQS") || startsWith("DDR_UDQS")) {
        lines.strobeOpen |= lane;
    } else {
        return false; // clock and commands
    }
    return true;
}

} // namespace

void delayWires(SocModel& soc) {
    soc.delay(kitDelays, 1, false);
    soc.fsmc().tolerate();
}

void plantFaults(SocModel& soc, const std::vector<WireFault>& faults) {
    constexpr int memoryBank = 3; // bank of the memory controller that synth/ise/chip.v uses
    McbModel::Lines lines;
    bool isMemoryFaulty = false, starts = true;
    if (!faults.empty())
        soc.fsmc().tolerate();
    for (const WireFault& fault : faults) {
        if (fault.wire == "CLK") {
            soc.changeClock(fault.kind == WireFault::Missing ? -100 : -fault.value);
        } else if (fault.kind == WireFault::Late) {
            if (SocModel::clkHz != 100'000'000)
                throw std::runtime_error("fault " + fault.text() +
                                         ": expected a chip at 100 MHz, got one at " +
                                         std::to_string(SocModel::clkHz / 1'000'000) + " MHz");
            delayWires(soc);
            break;
        }
    }
    for (const WireFault& fault : faults) {
        if (fault.kind == WireFault::Late)
            soc.fsmc().makeLate(fault.wire, static_cast<int>(1000 * fault.value));
        else if (fault.wire == "D" && fault.kind == WireFault::Shifted)
            soc.fsmc().shiftReads();
        else if (fault.isMemory())
            isMemoryFaulty = true, starts = addMemoryFault(lines, fault) && starts;
        else if (fault.bank() >= 0)
            soc.wires().plant(fault), starts = starts && fault.bank() != memoryBank;
        else if (fault.wire != "CLK" && !soc.wires().plant(fault))
            throw std::runtime_error("fault " + fault.text() + ": this simulator cannot inject it");
    }
    if (isMemoryFaulty)
        soc.memory().plant(lines);
    if (!starts)
        soc.memory().breakStart();
    // The oscillator of the kit is in bank 0.
    for (const WireFault& fault : faults)
        if (fault.bank() == 0)
            soc.changeClock(-100);
}
