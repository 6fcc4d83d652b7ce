// SPDX-License-Identifier: MIT
//
// bringup_main: icesoc-bringup, which runs the self-test of a new board on a simulated board. It
// runs the self-test first with line_tester and then with the chip, prints the output of the
// console, and finally calls the vehicle's firmware over a cable.
//
//     icesoc-bringup bringup_flash.elf uav.elf [--fault D3:open]...

#include "call_kit.h"
#include "chip_kit.h"
#include "line_kit.h"
#include <cstdio>
#include <cstring>
#include <iostream>

namespace {

// Bringup_Limits (sw/bringup/bringup.h) with values that are short enough for a simulation.
struct Limits {
    uint32_t steps = ~0u, modemBootMs = 2, guardMs = 20, patternKib = 64, retentionMs = 1;
};

void shorten(Stm32F2& stm32) {
    const Limits limits;
    stm32.cpu().writeMemory(stm32.image()->symbol("bringup_limits"), &limits, sizeof limits);
}

// Returns whether only the second half of the self-test, which uses the chip, detects a fault.
bool isOfChip(const WireFault& fault) {
    return fault.kind == WireFault::Late || fault.isMemory() || fault.bank() == 3 ||
           (fault.wire == "D" && fault.kind == WireFault::Shifted);
}

// Prints the report. Returns whether the self-test has passed.
bool show(const std::string& report) {
    std::cout << report << std::flush;
    return report.find("\nEND 0") != std::string::npos;
}

} // namespace

int main(int argc, char** argv) try {
    std::vector<std::string> programs;
    std::vector<WireFault> all, lines, chip;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--fault") == 0 && i + 1 < argc) {
            all.push_back(WireFault::parse(argv[++i]));
            (isOfChip(all.back()) ? chip : lines).push_back(all.back());
        } else if (argv[i][0] != '-' && programs.size() < 2) {
            programs.push_back(argv[i]);
        } else {
            programs.clear();
            break;
        }
    }
    if (programs.size() != 2)
        throw std::runtime_error("expected icesoc-bringup SELF-TEST FIRMWARE [--fault FAULT]...");
    LineKit::Options options;
    options.faults = lines;
    LineKit lineKit(options);
    lineKit.onStart(shorten);
    if (!show(lineKit.run(programs[0], 1000)))
        return 1;
    {
        XBee::Options modem;
        modem.set["GT"] = 10;
        ChipKit chipKit(chip, modem);
        if (!show(chipKit.run(programs[0], 60'000, shorten)))
            return 1;
    }
    return show(callOverCable(programs[1], all)) ? 0 : 1;
} catch (const std::exception& e) {
    std::cerr << "icesoc-bringup: " << e.what() << "\n";
    return 2;
}
