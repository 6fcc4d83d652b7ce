// SPDX-License-Identifier: MIT
//
// spartan6_boot: models how a Spartan-6 configures itself from an SPI flash (UG380 v2.7, chapters 5
// and 7). A header at address 0 points to the MultiBoot bitstream. The FPGA tries this bitstream
// three times, and then the golden bitstream. A try fails if the CRC or the device is wrong, or if
// no sync word arrives in time. Any other fault after the sync word stops the FPGA permanently
// (AMD's answer 58249), so a bitstream with such a fault must never be in flash.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

struct Spartan6Boot {
    static constexpr uint32_t idCode = 0x04002093; // XC6SLX16
    static constexpr uint32_t cclkHz = 2'000'000;  // default of ConfigRate

    // Configures the FPGA, at power-on or when PROGRAM_B rises.
    void configure(const std::vector<uint8_t>& flash);

    // Address in flash of the bitstream that is running; empty while DONE is low.
    std::optional<uint32_t> running;
    bool isStuck = false; // true if the FPGA makes no more tries
    uint64_t clocks = 0;  // number of CCLK clocks that the configuration took
    unsigned strikes = 0; // number of tries that failed
    // The read of the flash in one try: the address, and the clocks at which chip select falls and
    // rises.
    struct Read {
        uint32_t address;
        uint64_t from, to;
    };
    std::vector<Read> reads;

private:
    enum class End { Done, Failed, Stuck, Iprog };
    End load(const std::vector<uint8_t>& flash, uint32_t address);
    // GENERAL1..4: addresses of the MultiBoot bitstream and of the golden bitstream
    uint16_t general_[4] = {};
};

// Returns a bitstream that configures the model, for machines without ISE. Its frames contain
// random words.
std::vector<uint8_t> standInBitstream(uint32_t seed, uint32_t frameWords,
                                      uint32_t idCode = Spartan6Boot::idCode);
