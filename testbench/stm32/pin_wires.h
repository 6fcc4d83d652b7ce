// SPDX-License-Identifier: MIT
//
// pin_wires: the seam between the microcontroller's pins and the wires of a board.

#pragma once

#include <cstdint>

// What a pin does, by its GPIO registers (RM0033, 6.4).
struct PinSetting {
    enum Mode { Input, Output, Alternate, Analog } mode = Input;
    bool level = false;     // output level
    bool openDrain = false; // drives only the low level
    int pull = 0;           // 1 up, -1 down
    unsigned function = 0;  // alternate function, 0 to 15
    unsigned speed = 0;     // 0 (2 MHz) to 3 (100 MHz)
};

class PinWires {
public:
    virtual ~PinWires() = default;
    // Returns the levels at the 16 pins of a port; `inside` has those that the microcontroller's
    // model knows without wires.
    virtual uint16_t levels(unsigned port, uint16_t inside) = 0;
    // Settings of a port's pins have changed.
    virtual void changed(unsigned port) = 0;
};
