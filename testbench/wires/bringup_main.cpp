// SPDX-License-Identifier: MIT
//
// bringup_main: icesoc-bringup, which runs the self-test of a new board on a simulated board. It
// runs the self-test first with line_tester and then with the chip, and prints the output of the
// console.
//
//     icesoc-bringup bringup_flash.elf [--wire D3:open]...

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

bool isOfChip(const WireFault& fault) {
    return fault.kind == WireFault::Late || fault.wire.rfind("DDR_", 0) == 0;
}

// Prints the report. Returns whether the self-test has passed.
bool show(const std::string& report) {
    std::cout << report << std::flush;
    return report.find("\nEND 0") != std::string::npos;
}

} // namespace

int main(int argc, char** argv) try {
    std::string elf;
    std::vector<WireFault> lines, chip;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--wire") == 0 && i + 1 < argc) {
            const WireFault fault = WireFault::parse(argv[++i]);
            (isOfChip(fault) ? chip : lines).push_back(fault);
        } else if (elf.empty() && argv[i][0] != '-') {
            elf = argv[i];
        } else {
            throw std::runtime_error(std::string(argv[i]) +
                                     ": expected icesoc-bringup PROGRAM [--wire FAULT]...");
        }
    }
    LineKit::Options options;
    options.faults = lines;
    LineKit lineKit(options);
    lineKit.onStart(shorten);
    if (!show(lineKit.run(elf, 1000)))
        return 1;
    XBee::Options modem;
    modem.set["GT"] = 10;
    ChipKit chipKit(chip, modem);
    return show(chipKit.run(elf, 60'000, shorten)) ? 0 : 1;
} catch (const std::exception& e) {
    std::cerr << "icesoc-bringup: " << e.what() << "\n";
    return 2;
}
