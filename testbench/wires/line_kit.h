// SPDX-License-Identifier: MIT
//
// line_kit: simulates a board with line_tester loaded in its FPGA: the pins of the
// microcontroller, the tester's RTL, an idle modem, and the wires between them.

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
        double fpgaMhz = BOARD_FPGA_HZ / 1e6; // frequency of the FPGA's clock, MHz
        // true if line_tester is loaded; without it, the FPGA has pull-ups on its pins
        bool isConfigured = true;
    };
    explicit LineKit(const Options& options);

    // Loads the self-test into RAM or flash, and runs it until it prints a line that begins with
    // END, or until `limitMs` has passed. Returns the text that the self-test has printed.
    std::string run(const std::string& elf, unsigned limitMs);
    // Sets a function that changes the microcontroller before the program runs, for example one of
    // its variables.
    void onStart(std::function<void(Stm32F2&)> change) { change_ = std::move(change); }

    Wires& wires() { return wires_; }
    uint64_t now() const { return now_; }
    Stm32F2& stm32() { return stm32_; }

private:
    // period of 25 MHz, the slowest CFGMCLK (DS162: 50 MHz, 50 %)
    static constexpr uint64_t oscNs = 40;
    // number of clocks of the board in one unit of the clock count in the tester
    static constexpr unsigned unitClocks = 64;
    static constexpr unsigned lines = 50, pins = 55;

    uint16_t levels(unsigned port, uint16_t inside) override;
    void changed(unsigned port) override;
    void tick();
    void exchange();
    void plant(const WireFault& fault, double& mhz);
    void followModem();
    void followSecondMemory();
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
    double clockAt_ = 0, clockHalfNs_ = 0; // 0 means that the clock is missing
    uint64_t inputs_ = 0, outputs_ = ~0ull, enables_ = ~0ull;
    bool isModemFitted_ = true, inReset_ = false, hasSecondMemory_ = false;
    std::string printed_;
    bool ended_ = false;
};
