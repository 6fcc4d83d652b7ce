// SPDX-License-Identifier: MIT
//
// board_wires: reads the list of nets and pins that `./icesoc board make` generates, and connects
// the pins.

#include "board_wires.h"
#include <regex>
#include <sstream>
#include <stdexcept>

namespace {

#include "board_wires.inc"

// Both names of a signal: `end` is the function of the microcontroller's pin, or the name of the
// modem's pin; `port` is the port of the chip.
struct Name {
    const char *end, *port;
    unsigned line, count;
};
constexpr Name names[] = {
    {"FSMC_A", "fsmc_a_i", BoardWires::A, 25},
    {"FSMC_D", "fsmc_d_io", BoardWires::D, 16},
    {"FSMC_NBL", "fsmc_nbl_n_i", BoardWires::Nbl, 2},
    {"FSMC_NE", "fsmc_ne_n_i", BoardWires::Ne, 2},
    {"FSMC_NOE", "fsmc_noe_n_i", BoardWires::Noe, 1},
    {"FSMC_NWE", "fsmc_nwe_n_i", BoardWires::Nwe, 1},
    {"FSMC_NL", "fsmc_nadv_n_i", BoardWires::Nadv, 1},
    {"FSMC_NWAIT", "fsmc_nwait_n_o", BoardWires::Nwait, 1},
    {"PB0", "irq_o", BoardWires::Irq, 1},
    {"DOUT", "modem_rxd_i", BoardWires::ModemRxd, 1},
    {"DIN", "modem_txd_o", BoardWires::ModemTxd, 1},
    {"CTS", "modem_cts_n_i", BoardWires::ModemCts, 1},
    {"RTS", "modem_rts_n_o", BoardWires::ModemRts, 1},
    {"RESET", "modem_reset_n_o", BoardWires::ModemReset, 1},
};

bool bitOf(const FsmcPins& pins, unsigned line) {
    if (line < BoardWires::D)
        return pins.a >> line & 1;
    if (line < BoardWires::Nbl)
        return pins.d >> (line - BoardWires::D) & 1;
    if (line < BoardWires::Ne)
        return pins.nblN >> (line - BoardWires::Nbl) & 1;
    if (line < BoardWires::Noe)
        return pins.neN >> (line - BoardWires::Ne) & 1;
    return line == BoardWires::Noe    ? pins.noeN
           : line == BoardWires::Nwe  ? pins.nweN
           : line == BoardWires::Nadv ? pins.nadvN
                                      : true;
}

} // namespace

BoardWires::BoardWires() : BoardWires(defaultWires, defaultUcf) {}

BoardWires::BoardWires(const std::string& wires, const std::string& ucf) {
    from_.fill(-1);
    isSwitched_.fill(true);
    // Lines with a pull-up in synth/ise/chip.ucf.
    for (unsigned line : {unsigned(Ne), Ne + 1, unsigned(Noe), unsigned(Nwe), unsigned(ModemRxd)})
        isHigh_[line] = true;
    std::map<std::string, int> lineAtBall;
    readWires(wires, lineAtBall);
    static const std::regex place("NET \"([^\"]+)\" LOC = \"([A-Z0-9]+)\"( \\| PULLUP)?;");
    for (std::sregex_iterator at(ucf.begin(), ucf.end(), place), end; at != end; ++at) {
        const Line port = lineOf((*at)[1]);
        auto found = lineAtBall.find((*at)[2]);
        if (port == Lines)
            continue;
        if ((*at)[3].matched)
            isHigh_[port] = true;
        if (found != lineAtBall.end())
            from_[port] = found->second;
    }
    updateStraight();
}

// Returns the line of a function, a pin or a port, such as FSMC_NE2 or fsmc_ne_n_i<1>; Lines if the
// name is unknown.
BoardWires::Line BoardWires::lineOf(const std::string& name) {
    for (const Name& n : names) {
        for (const std::string known : {n.end, n.port}) {
            if (n.count == 1 && name == known)
                return Line(n.line);
            const std::string rest = name.compare(0, known.size(), known)
                                         ? "" // another name
                                         : name.substr(known.size());
            static const std::regex number("<?(\\d+)>?");
            std::smatch found;
            if (n.count == 1 || !std::regex_match(rest, found, number))
                continue;
            const unsigned bit =
                // FSMC_NE1 is bit 0
                static_cast<unsigned>(std::stoul(found[1])) - (known == "FSMC_NE");
            if (bit < n.count)
                return Line(n.line + bit);
        }
    }
    return Lines;
}

// Reads the pins and balls of each net, one net per line (tools/icesoc/board/simulator.py).
void BoardWires::readWires(const std::string& text, std::map<std::string, int>& lineAtBall) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string end, number, function, net, ball;
        double volts = 0;
        if (line.empty() || line[0] == '#')
            continue;
        if (line.compare(0, 11, "oscillator ") == 0) {
            oscillatorHz_ = static_cast<uint32_t>(std::stoul(line.substr(11)));
            continue;
        }
        if (!(words >> end >> number >> function >> net >> ball >> volts))
            throw std::runtime_error("board.wires: expected pin, number, function, net, ball and "
                                     "volts, got '" +
                                     line + "'");
        Line signal = lineOf(function);
        if (signal == Lines)
            signal = lineOf(end);
        if (signal == Lines)
            continue;
        if (number != "-")
            pins_[signal] = {unsigned(end[1] - 'A'),
                             static_cast<unsigned>(std::stoul(end.substr(2))),
                             static_cast<unsigned>(std::stoul(number)), signal};
        if (volts > 0) // a bank without supply neither drives nor reads its balls
            lineAtBall[ball] = int(signal);
    }
}

void BoardWires::follow(std::function<PinSetting(unsigned, unsigned)> setting) {
    setting_ = std::move(setting);
    if (!setting_)
        isSwitched_.fill(true);
    updateStraight();
    for (unsigned port = 0; port < 9; ++port)
        changed(port);
}

void BoardWires::changed(unsigned port) {
    if (!setting_)
        return;
    for (const auto& [line, pin] : pins_)
        if (pin.port == port) {
            const PinSetting now = setting_(port, pin.pin);
            isSwitched_[line] = now.mode == PinSetting::Alternate && now.function == pin.function;
        }
    updateStraight();
}

void BoardWires::updateStraight() {
    isStraight_ = true;
    for (unsigned line = 0; line < Irq; ++line)
        if (line != Nadv) // the bridge of this chip is not multiplexed
            isStraight_ = isStraight_ && from_[line] == int(line) && isSwitched_[line];
}

FsmcPins BoardWires::atChip(const FsmcPins& near) const {
    auto level = [&](unsigned port) {
        const int signal = from_[port];
        return signal >= 0 && signal < int(Nwait) && isSwitched_[unsigned(signal)]
                   ? bitOf(near, unsigned(signal))
                   : isHigh_[port];
    };
    FsmcPins chip = near;
    auto bits = [&](unsigned first, unsigned count) {
        uint32_t value = 0;
        for (unsigned bit = 0; bit < count; ++bit)
            value |= uint32_t(level(first + bit)) << bit;
        return value;
    };
    chip.a = bits(A, 25);
    chip.d = static_cast<uint16_t>(bits(D, 16));
    chip.nblN = static_cast<uint8_t>(bits(Nbl, 2));
    chip.neN = static_cast<uint8_t>((near.neN & ~3u) | bits(Ne, 2));
    chip.noeN = level(Noe);
    chip.nweN = level(Nwe);
    chip.nadvN = level(Nadv);
    return chip;
}

void BoardWires::toProcessor(const FsmcPins& chip, FsmcPins& near) const {
    // A data pin without a connection to the chip reads as low, because a processor cannot detect
    // that nothing drives it.
    near.dFromDesign = 0;
    for (unsigned bit = 0; bit < 16; ++bit) {
        const int signal = from_[D + bit];
        if (signal >= int(D) && signal < int(Nbl) && isSwitched_[unsigned(signal)])
            near.dFromDesign = static_cast<uint16_t>(
                near.dFromDesign | (chip.dFromDesign >> bit & 1) << (unsigned(signal) - D));
    }
    near.dDriven = chip.dDriven || (!near.noeN && !near.dOut && (near.neN & 3) != 3);
    near.nwaitN = from_[Nwait] == int(Nwait) && isSwitched_[Nwait] ? chip.nwaitN : true;
}
