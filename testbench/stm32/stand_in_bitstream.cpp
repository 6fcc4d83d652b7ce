// SPDX-License-Identifier: MIT
//
// stand_in_bitstream: writes a bitstream that configures the model of the FPGA, for machines
// without ISE. The simulated design itself does not depend on this bitstream.

#include "spartan6_boot.h"
#include <cstdlib>
#include <fstream>
#include <iostream>

int main(int argc, char** argv) {
    // number of words with which the file is as long as a bitstream of the XC6SLX16, 466,408 bytes
    const uint32_t frames = 233'127;
    if (argc < 3) {
        std::cerr << "Usage: stand_in_bitstream OUT.bin SEED [WORDS OF FRAMES, else " << frames
                  << "]\n";
        return 2;
    }
    const auto number = [](const char* text) {
        return static_cast<uint32_t>(std::strtoul(text, nullptr, 10));
    };
    const auto bits = standInBitstream(number(argv[2]), argc > 3 ? number(argv[3]) : frames);
    std::ofstream out(argv[1], std::ios::binary);
    out.write(reinterpret_cast<const char*>(bits.data()),
              static_cast<std::streamsize>(bits.size()));
    if (!out.flush()) {
        std::cerr << "stand_in_bitstream: cannot write '" << argv[1] << "'\n";
        return 1;
    }
    return 0;
}
