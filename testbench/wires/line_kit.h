// SPDX-License-Identifier: MIT
//
// line_kit: a board whose FPGA is loaded with line_tester: the microcontroller's pins, the tester's
// RTL, an idle modem, and the wires between them.

#pragma once

#include "VLineTester.h"
#include "board_pins.h"
#include "stm32f2.h"
#include "wires.h"
#include <functional>
#include <memory>
#include <string>
#include <verilated.h>

class LineKit : private PinWires {
public:
    struct Options {
        std::vector<WireFault> faults;
        double fpgaMhz = BOARD_FPGA_HZ / 1e6; // the FPGA's clock
        bool isConfigured = true; // line_tester is loaded; if not, the FPGA pulls its pins up
    };
    explicit LineKit(const Options& options);

    // Loads the self-test into RAM or flash and runs it until it prints a line that begins with
    // END, or until this time (ms). Returns what it has printed.
    std::string run(const std::string& elf, unsigned limitMs);
    // Sets a variable of the program, before run().
    void onStart(std::function<void(Stm32F2&)> change) { change_ = std::move(change); }

    Wires& wires() { return wires_; }
    uint64_t now() const { return now_; }
    Stm32F2& stm32() { return stm32_; }

private:
    static constexpr uint64_t oscNs = 40;      // 25 MHz, the slowest CFGMCLK (DS162: 50 MHz, 50 %)
    static constexpr unsigned unitClocks = 64; // clocks of the board that the tester counts as one
    static constexpr unsigned lines = 50, pins = 55;

    uint16_t levels(unsigned port, uint16_t inside) override;
    void changed(unsigned port) override;
    void tick();
    void exchange();
    void followModem();
    void pulseNwe(bool level);

    struct Place {
        unsigned port, pin;
    };
    static const Place places[lines];

    Options options_;
    VerilatedContext context_;
    VLineTester top_{&context_};
    Wires wires_;
    FsmcPins fsmcPins_;
    FsmcMaster fsmc_;
    Stm32F2 stm32_;
    std::function<void(Stm32F2&)> change_;
    uint64_t now_ = 0;
    double clockAt_ = 0, clockHalfNs_ = 0; // 0: no clock
    uint64_t inputs_ = 0, outputs_ = ~0ull, enables_ = ~0ull;
    bool isModemFitted_ = true, inReset_ = false;
    std::string printed_;
    bool ended_ = false;
};
