// SPDX-License-Identifier: MIT
//
// board_wires: the way of a signal from the microcontroller to the chip, as a board has it. GPIO
// modes and alternate functions decide whether it leaves its pin, the board which ball it reaches
// (boards/NAME/board.toml), and the constraints which port of the chip that is (board.ucf).
//
// A board on which each signal reaches its port is straight; it costs nothing at run time.

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
    // Sets the function that returns what a pin does; without one all pins are switched to their
    // signals, as for a program without pins.
    void follow(std::function<PinSetting(unsigned port, unsigned pin)> setting);

    bool isStraight() const { return isStraight_; }
    // Returns whether a signal that does not belong to the FSMC arrives where it should.
    bool reaches(Line line) const { return from_[line] == int(line); }
    // Returns the pins as the chip sees them.
    FsmcPins atChip(const FsmcPins& near) const;
    // Gives the processor's pins the levels that the chip drives at its own.
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
    std::array<int, Lines> from_;      // signal that arrives at a port; -1: none
    std::array<bool, Lines> isHigh_{}; // level of a port at which none arrives
    std::array<bool, Lines> isSwitched_;
    std::map<Line, Pin> pins_; // pins of the FSMC
    std::function<PinSetting(unsigned, unsigned)> setting_;
    bool isStraight_ = false;
};
