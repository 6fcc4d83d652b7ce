// SPDX-License-Identifier: MIT
//
// chip_kit: simulates a board with the chip loaded in its FPGA. The microcontroller runs the
// self-test, and reaches registers, DDR3 and modem through wires with delays.

#pragma once

#include "board_faults.h"
#include "rf_channel.h"
#include "soc_model.h"
#include "stm32f2.h"
#include <string>
#include <vector>

class ChipKit : private PinWires {
public:
    explicit ChipKit(const std::vector<WireFault>& faults, XBee::Options modem = {});

    // Loads the self-test, calls `change`, and runs the self-test until it prints a line that
    // begins with END, or until `limitMs` has passed. Returns the text that the self-test has
    // printed.
    std::string run(const std::string& elf, unsigned limitMs,
                    const std::function<void(Stm32F2&)>& change);

    SocModel& soc() { return soc_; }
    Stm32F2& stm32() { return stm32_; }

private:
    uint16_t levels(unsigned port, uint16_t inside) override;
    void changed(unsigned) override {}

    RfChannel air_{1};
    SocModel soc_;
    Stm32F2 stm32_;
    std::string printed_;
    bool ended_ = false;
};
