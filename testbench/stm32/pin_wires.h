// SPDX-License-Identifier: MIT
//
// pin_wires: the interface between the microcontroller's pins and the wires of a board.

#pragma once

#include <cstdint>

// Function of a pin, from its GPIO registers (RM0033, 6.4).
struct PinSetting {
    enum Mode { Input, Output, Alternate, Analog } mode = Input;
    bool level = false;     // output level
    bool openDrain = false; // open drain: drives only the low level
    int pull = 0;           // 1 for a pull-up, -1 for a pull-down, 0 for neither
    unsigned function = 0;  // alternate function, 0 to 15
    unsigned speed = 0;     // 0 (2 MHz) to 3 (100 MHz)
};

class PinWires {
public:
    virtual ~PinWires() = default;
    // Returns the levels at the 16 pins of a port. `inside`: levels that the model of the
    // microcontroller knows without the wires.
    virtual uint16_t levels(unsigned port, uint16_t inside) = 0;
    // Called when settings of a port's pins have changed.
    virtual void changed(unsigned port) = 0;
};
