// SPDX-License-Identifier: MIT
//
// board_wires: reads the list of nets and pins that `./icesoc board make` generates, and connects
// the pins.

#include "board_wires.h"
#include <algorithm>
#include <fstream>
#include <iterator>
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

// Returns the line of the net that a fault names, such as NE1; returns Lines if the net is not
// modelled here.
unsigned lineOfFault(const std::string& wire) {
    struct Net {
        const char* name;
        unsigned line, first, count;
    };
    constexpr Net nets[] = {{"A", BoardWires::A, 0, 25},
                            {"D", BoardWires::D, 0, 16},
                            {"NBL", BoardWires::Nbl, 0, 2},
                            {"NE", BoardWires::Ne, 1, 2},
                            {"NOE", BoardWires::Noe, 0, 0},
                            {"NWE", BoardWires::Nwe, 0, 0},
                            {"NADV", BoardWires::Nadv, 0, 0},
                            {"NWAIT", BoardWires::Nwait, 0, 0},
                            {"IRQ", BoardWires::Irq, 0, 0},
                            {"MODEM_RXD", BoardWires::ModemRxd, 0, 0},
                            {"MODEM_TXD", BoardWires::ModemTxd, 0, 0},
                            {"MODEM_CTS", BoardWires::ModemCts, 0, 0},
                            {"MODEM_RTS", BoardWires::ModemRts, 0, 0},
                            {"MODEM_RESET", BoardWires::ModemReset, 0, 0}};
    for (const Net& net : nets)
        for (unsigned i = 0; i < std::max(net.count, 1u); ++i)
            if (wire == net.name + (net.count ? std::to_string(net.first + i) : ""))
                return net.line + i;
    return BoardWires::Lines;
}

std::string textOf(const std::string& file) {
    std::ifstream in(file);
    if (!in)
        throw std::runtime_error("cannot read '" + file +
                                 "': expected a folder made by ./icesoc board make");
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

BoardWires::BoardWires() : BoardWires(defaultWires, defaultUcf) {}

BoardWires BoardWires::fromFolder(const std::string& folder) {
    return BoardWires(textOf(folder + "/board.wires"), textOf(folder + "/board.ucf"));
}

BoardWires::BoardWires(const std::string& wires, const std::string& ucf) {
    from_.fill(-1);
    bank_.fill(-1);
    isSwitched_.fill(true);
    for (unsigned line = 0; line < Lines; ++line)
        joined_[line] = 1ull << line;
    // Lines with a pull-up in synth/ise/chip.ucf.
    for (unsigned line : {unsigned(Ne), Ne + 1, unsigned(Noe), unsigned(Nwe), unsigned(ModemRxd)})
        isHigh_[line] = true;
    readWires(wires);
    static const std::regex place("NET \"([^\"]+)\" LOC = \"([A-Z0-9]+)\"( \\| PULLUP)?;");
    for (std::sregex_iterator at(ucf.begin(), ucf.end(), place), end; at != end; ++at) {
        const Line port = lineOf((*at)[1]);
        const auto found = balls_.find((*at)[2]);
        if (port == Lines)
            continue;
        if ((*at)[3].matched)
            isHigh_[port] = true;
        if (found == balls_.end())
            continue;
        bank_[port] = found->second.bank;
        if (found->second.isPowered) // a bank without supply neither drives nor reads its balls
            from_[port] = found->second.signal;
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
void BoardWires::readWires(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string end, number, function, net, ball;
        int bank = -1;
        double volts = 0;
        if (line.empty() || line[0] == '#')
            continue;
        words >> end >> number;
        if (end == "oscillator")
            oscillatorHz_ = static_cast<uint32_t>(std::stoul(number));
        else if (end == "muxed")
            isMuxed_ = number == "1";
        else if (end == "modem")
            modem_ = number;
        if (end == "board" || end == "oscillator" || end == "muxed" || end == "modem")
            continue;
        if (!(words >> function >> net >> ball >> bank >> volts))
            throw std::runtime_error("board.wires: expected pin, number, function, net, ball, bank "
                                     "and volts, got '" +
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
        balls_[ball] = {int(signal), bank, volts > 0};
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
    auto reaches = [this](unsigned line) {
        return from_[line] == int(line) && isSwitched_[line] && !(faulty_ >> line & 1);
    };
    isStraight_ = !hasSecondDriver_;
    areOthersStraight_ = true;
    for (unsigned line = 0; line < Irq; ++line) {
        const bool isUsed = isMuxed_ ? line >= 16 : line != Nadv; // address bits 15..0, NADV
        isStraight_ = isStraight_ && (!isUsed || reaches(line));
    }
    for (unsigned line = Irq; line < Lines; ++line)
        areOthersStraight_ = areOthersStraight_ && reaches(line);
}

// ---- faults ----

// Separates a port of the chip from its wire.
void BoardWires::cut(unsigned line) {
    from_[line] = -1;
}

bool BoardWires::plant(const WireFault& fault) {
    const unsigned a = lineOfFault(fault.wire);
    const unsigned b = fault.other.empty() ? a : lineOfFault(fault.other);
    const uint64_t bits = a < Lines && b < Lines ? 1ull << a | 1ull << b : 0;
    switch (fault.kind) {
    case WireFault::Open:
        if (!bits)
            return false;
        cut(a);
        break;
    case WireFault::Stuck0:
    case WireFault::Stuck1:
        if (!bits)
            return false;
        stuck_ |= bits;
        stuckHigh_ |= fault.kind == WireFault::Stuck1 ? bits : 0;
        break;
    case WireFault::Pull0:
    case WireFault::Pull1:
        pulled_ |= bits;
        pulledHigh_ |= fault.kind == WireFault::Pull1 ? bits : 0;
        break;
    case WireFault::Short: {
        if (!bits)
            return false;
        const uint64_t all = joined_[a] | joined_[b];
        for (unsigned line = 0; line < Lines; ++line)
            if (all >> line & 1)
                joined_[line] = all;
        break;
    }
    case WireFault::Swapped:
        std::swap(from_[a], from_[b]);
        break;
    case WireFault::Inverted:
        inverted_ ^= bits;
        break;
    case WireFault::Ringing:
        rings_ = true;
        return true;
    case WireFault::SecondDriver:
        hasSecondDriver_ = true;
        break;
    case WireFault::Shifted:
        if (fault.wire != "A")
            return false;
        for (unsigned line = 24; line > 0; --line)
            from_[A + line] = from_[A + line - 1];
        cut(A);
        break;
    case WireFault::Missing:
        if (fault.wire != "MODEM")
            return false;
        for (unsigned line = ModemRxd; line < Lines; ++line)
            cut(line);
        break;
    case WireFault::Unpowered:
        for (unsigned line = 0; line < Lines; ++line)
            if (bank_[line] == fault.bank())
                cut(line);
        break;
    default:
        return false;
    }
    faulty_ |= bits;
    updateStraight();
    return true;
}

// ---- levels ----

void BoardWires::Drivers::set(int signal, bool isOn, bool isHigh) {
    if (signal < 0)
        return;
    const uint64_t bit = 1ull << signal;
    on = isOn ? on | bit : on & ~bit;
    high = isHigh ? high | bit : high & ~bit;
}

// Returns the level of a wire; -1 if nothing drives or pulls it. Low wins against high.
int BoardWires::level(int signal) const {
    if (signal < 0)
        return -1;
    const uint64_t wires = joined_[unsigned(signal)];
    const bool isInverted = inverted_ >> signal & 1;
    if (stuck_ & wires)
        return (stuckHigh_ & wires) != 0;
    bool isDriven = false, isLow = false;
    for (const Drivers* side : {&processor_, &chip_, &modemsOutputs_}) {
        isDriven = isDriven || (side->on & wires);
        isLow = isLow || (side->on & ~side->high & wires);
    }
    if (isDriven)
        return isLow == isInverted;
    return pulled_ & wires ? (pulledHigh_ & wires) != 0 : -1;
}

FsmcPins BoardWires::atChip(const FsmcPins& near) {
    for (unsigned line = 0; line < Nwait; ++line)
        processor_.set(int(line), isSwitched_[line] && (line < D || line >= Nbl || near.dOut),
                       bitOf(near, line));
    FsmcPins chip = near;
    auto seen = [this](unsigned port) {
        const int now = level(from_[port]);
        return now < 0 ? isHigh_[port] : now == 1;
    };
    auto bits = [&](unsigned first, unsigned count) {
        uint32_t value = 0;
        for (unsigned bit = 0; bit < count; ++bit)
            value |= uint32_t(seen(first + bit)) << bit;
        return value;
    };
    chip.a = bits(A, 25);
    chip.d = static_cast<uint16_t>(bits(D, 16));
    chip.nblN = static_cast<uint8_t>(bits(Nbl, 2));
    chip.neN = static_cast<uint8_t>((near.neN & ~3u) | bits(Ne, 2));
    chip.noeN = seen(Noe);
    chip.nweN = seen(Nwe);
    chip.nadvN = seen(Nadv);
    return chip;
}

void BoardWires::toProcessor(const FsmcPins& chip, FsmcPins& near) {
    for (unsigned bit = 0; bit < 16; ++bit)
        chip_.set(from_[D + bit], chip.dDriven, chip.dFromDesign >> bit & 1);
    chip_.set(from_[Nwait], true, chip.nwaitN);
    const bool reads = !near.noeN && !near.dOut;
    // The second memory's contents differ from the contents of the chip's memory.
    const bool isOtherDriving = hasSecondDriver_ && reads && !(near.neN & 1);
    const auto other = static_cast<uint16_t>(near.a * 0x9E37u >> 3 ^ 0x5AA5u);
    near.dFromDesign = 0;
    for (unsigned bit = 0; bit < 16; ++bit) {
        // A data pin that nothing drives reads as low, because a processor cannot detect this.
        int now = isSwitched_[D + bit] ? level(int(D + bit)) : 0;
        if (isOtherDriving)
            now = now != 0 && (other >> bit & 1);
        near.dFromDesign = static_cast<uint16_t>(near.dFromDesign | (now == 1) << bit);
    }
    near.dDriven = chip.dDriven || (reads && (near.neN & 3) != 3);
    near.nwaitN = !isSwitched_[Nwait] || level(int(Nwait)) != 0;
}

void BoardWires::drive(Line line, bool high) {
    if (isOfModem(line))
        modemsOutputs_.set(int(line), true, high);
    else
        chip_.set(from_[line], true, high);
}

// An input of the chip without a driver has the level of its pull resistor in the chip. An input of
// the modem without a driver is high, because the modem pulls it up. IRQ without a driver is low,
// because nothing pulls it.
bool BoardWires::arrives(Line line) const {
    if (!isOfModem(line))
        return line == Irq ? level(int(line)) == 1 : level(int(line)) != 0;
    const int now = level(from_[line]);
    return now < 0 ? isHigh_[line] : now == 1;
}
