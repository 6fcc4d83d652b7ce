// SPDX-License-Identifier: MIT
//
// board_wires: models the path of each signal from the microcontroller to the chip on a given
// board. GPIO modes and alternate functions determine whether the signal leaves its pin. The board
// determines which ball the signal reaches (boards/NAME/board.toml). The constraints determine to
// which port of the chip this ball belongs (board.ucf).
//
// On a straight board, each signal reaches its own port; the model then costs no run time.

#pragma once

#include "fsmc_pins.h"
#include "pin_wires.h"
#include <array>
#include <functional>
#include <map>
#include <string>

class BoardWires : public PinWires {
public:
    // Signals, in the order of the chip's ports: 25 of A, 16 of D, 2 of NBL and of NE, and others.
    enum Line : unsigned {
        A = 0,
        D = 25,
        Nbl = 41,
        Ne = 43,
        Noe = 45,
        Nwe,
        Nadv,
        Nwait,
        Irq,
        ModemRxd,
        ModemTxd,
        ModemCts,
        ModemRts,
        ModemReset,
        Lines
    };

    // The board that the simulator was built for.
    BoardWires();
    // Another board: the texts of its board.wires and board.ucf. Throws std::runtime_error with the
    // line that is not understood.
    BoardWires(const std::string& wires, const std::string& ucf);

    uint32_t oscillatorHz() const { return oscillatorHz_; }
    // Sets the function that returns what a pin does; without this function all pins are switched
    // to their signals, as a program that does not model pins needs it.
    void follow(std::function<PinSetting(unsigned port, unsigned pin)> setting);

    bool isStraight() const { return isStraight_; }
    // Returns whether a signal that does not belong to the FSMC arrives where it should.
    bool reaches(Line line) const { return from_[line] == int(line); }
    // Returns the pins as the chip sees them.
    FsmcPins atChip(const FsmcPins& near) const;
    // Sets the processor's pins to the levels that the chip drives at its pins.
    void toProcessor(const FsmcPins& chip, FsmcPins& near) const;

    uint16_t levels(unsigned, uint16_t inside) override { return inside; }
    void changed(unsigned port) override;

private:
    struct Pin {
        unsigned port, pin, function;
        Line line;
    };
    static Line lineOf(const std::string& name);
    void readWires(const std::string& text, std::map<std::string, int>& lineAtBall);
    void updateStraight();

    uint32_t oscillatorHz_ = 0;
    std::array<int, Lines> from_;      // signal that arrives at each port; -1 without a signal
    std::array<bool, Lines> isHigh_{}; // level of each port at which no signal arrives
    std::array<bool, Lines> isSwitched_;
    std::map<Line, Pin> pins_; // pins of the FSMC
    std::function<PinSetting(unsigned, unsigned)> setting_;
    bool isStraight_ = false;
};
