// SPDX-License-Identifier: MIT
//
// pin_wires: the interface between the microcontroller pins and the wires of a board.

#pragma once

#include <cstdint>

// Setting of a pin in the GPIO registers (RM0033, 6.4).
struct PinSetting {
    enum Mode { Input, Output, Alternate, Analog } mode = Input;
    bool level = false;     // output level
    bool openDrain = false; // open drain: the pin drives only the low level
    int pull = 0;           // 1: pull-up; -1: pull-down; 0: no pull
    unsigned function = 0;  // alternate function, 0 to 15
    unsigned speed = 0;     // speed: 0 (2 MHz) to 3 (100 MHz)
};

class PinWires {
public:
    virtual ~PinWires() = default;
    // Returns the levels at the 16 pins of a port. `inside` are the levels without any wires, as
    // computed by the model of the microcontroller.
    virtual uint16_t levels(unsigned port, uint16_t inside) = 0;
    // Called when the settings of pins of a port have changed.
    virtual void changed(unsigned port) = 0;
};
