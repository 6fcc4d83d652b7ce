// SPDX-License-Identifier: MIT
//
// board_wires: models the path of each signal from the microcontroller to the chip on a given
// board. GPIO modes and alternate functions determine whether the signal leaves its pin. The board
// determines which ball the signal reaches (boards/NAME/board.toml). The constraints determine to
// which port of the chip this ball belongs (board.ucf).
//
// A fault of a wire (wire_fault.h) changes the levels at its ends. On a straight board, each signal
// reaches its own port; the model then costs no run time.

#pragma once

#include "fsmc_pins.h"
#include "pin_wires.h"
#include "wire_fault.h"
#include <array>
#include <functional>
#include <map>
#include <string>

class BoardWires : public PinWires {
public:
    // Signals, in the order of the chip ports: 25 of A, 16 of D, 2 of NBL and of NE, and others.
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
    // Another board, described by the contents of its files board.wires and board.ucf. Throws
    // std::runtime_error with the first line that is wrong.
    BoardWires(const std::string& wires, const std::string& ucf);
    // Reads board.wires and board.ucf from a folder that ./icesoc board make has written.
    static BoardWires fromFolder(const std::string& folder);

    uint32_t oscillatorHz() const { return oscillatorHz_; }
    bool isMuxed() const { return isMuxed_; }
    // Returns the kind of the board's modem (xbee_profile.h); empty if unknown.
    const std::string& modem() const { return modem_; }
    // Sets the function that returns the setting of a pin. Without this function, every pin counts
    // as switched to its signal, for programs that do not model the settings of pins.
    void follow(std::function<PinSetting(unsigned port, unsigned pin)> setting);
    // Plants a fault of a wire or of a bank's supply. Returns false for other kinds of faults.
    bool plant(const WireFault& fault);

    bool isStraight() const { return isStraight_; } // concerns the FSMC signals
    bool areOthersStraight() const { return areOthersStraight_; }
    bool rings() const { return rings_; } // rising edges of NWE arrive twice

    // Returns the FSMC's pins as the chip sees them.
    FsmcPins atChip(const FsmcPins& near);
    // Sets the processor pins to the levels that the chip drives at its pins.
    void toProcessor(const FsmcPins& chip, FsmcPins& near);
    // Sets the level of an output of the chip or of the modem: IRQ, and the modem's lines.
    void drive(Line line, bool high);
    // Returns the level that arrives at the input of one of these lines.
    bool arrives(Line line) const;

    uint16_t levels(unsigned, uint16_t inside) override { return inside; }
    void changed(unsigned port) override;

private:
    struct Pin {
        unsigned port, pin, function;
        Line line;
    };
    // Outputs of one side: a bit for each signal.
    struct Drivers {
        uint64_t on = 0, high = 0;
        void set(int signal, bool isOn, bool isHigh);
    };
    static Line lineOf(const std::string& name);
    static bool isOfModem(unsigned line) { return line == ModemRxd || line == ModemCts; }
    void readWires(const std::string& text);
    void updateStraight();
    void cut(unsigned line);
    int level(int signal) const;

    uint32_t oscillatorHz_ = 0;
    bool isMuxed_ = false;
    std::string modem_;
    struct Ball {
        int signal, bank;
        bool isPowered;
    };
    std::map<std::string, Ball> balls_;
    // index of the signal that arrives at each port; -1 if no signal arrives
    std::array<int, Lines> from_;
    std::array<int, Lines> bank_;      // bank of each port; -1 if unknown
    std::array<bool, Lines> isHigh_{}; // level of each port that no signal reaches
    std::array<bool, Lines> isSwitched_;
    std::map<Line, Pin> pins_; // pins of the FSMC
    std::function<PinSetting(unsigned, unsigned)> setting_;
    bool isStraight_ = false, areOthersStraight_ = false;
    Drivers processor_, chip_, modemsOutputs_;
    // faults, a bit for each signal
    uint64_t faulty_ = 0, stuck_ = 0, stuckHigh_ = 0, pulled_ = 0, pulledHigh_ = 0, inverted_ = 0;
    // bits of a signal and of all signals shorted to it; one entry for each signal
    std::array<uint64_t, Lines> joined_;
    bool rings_ = false, hasSecondDriver_ = false;
};
