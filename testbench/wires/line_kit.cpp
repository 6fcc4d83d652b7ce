// SPDX-License-Identifier: MIT
//
// line_kit: moves levels between the microcontroller pins, the wires and the tester.

#include "line_kit.h"

extern "C" {
#include "bringup_pins.h"
}

namespace {

constexpr unsigned ne1 = 41, noe = 43, nwe = 44, rxd = 50, txd = 51, cts = 52, rts = 53,
                   resetN = 54;
constexpr unsigned notWired = 255;

std::vector<std::string> netNames() {
#define NAME(name, place) #name,
    std::vector<std::string> names = {BRINGUP_LINES(NAME)};
#undef NAME
    for (const char* name : {"RXD", "TXD", "CTS", "RTS", "RESET"})
        names.push_back(std::string("MODEM_") + name);
    return names;
}

} // namespace

#define PLACE(name, place) {place},
const LineKit::Place LineKit::places[lines] = {BRINGUP_LINES(PLACE)};
#undef PLACE

LineKit::LineKit(const Options& options)
    : options_(options), wires_(netNames()),
      // 24 : 5 is the ratio of HCLK (120 MHz) to the oscillator (25 MHz)
      fsmc_(fsmcPins_, {[this] { tick(); }, [] {}}, 24, 5),
      stm32_(fsmc_, [this] { return now_; }, Stm32F2::Config()) {
    // cdc_bit reads an option from the arguments, so they must exist
    context_.commandArgs(0, static_cast<const char**>(nullptr));
    double mhz = options.fpgaMhz;
    for (const WireFault& fault : options.faults)
        plant(fault, mhz);
    clockHalfNs_ = mhz > 0 ? 500 * unitClocks / mhz : 0;
    if (isModemFitted_)
        for (unsigned pin : {txd, rts, resetN})
            wires_.set(pin, 0, {Wires::None, Wires::High}, 0); // pull-ups (PR)
    wires_.set(rxd, 1, {Wires::None, Wires::Low}, 0);          // synth/ise/lines.ucf
    wires_.set(cts, 1, {Wires::None, Wires::High}, 0);
    fsmc_.tolerate(); // no chip answers to an access
    stm32_.wire(this);
    stm32_.onSerial = [this](uint8_t byte) {
        printed_ += static_cast<char>(byte);
        const size_t line = printed_.rfind('\n', printed_.size() - 2);
        if (byte == '\n' && printed_.compare(line + 1, 3, "END") == 0)
            ended_ = true;
    };
    if (!options_.isConfigured)
        for (unsigned pin = 0; pin < pins; ++pin)
            wires_.set(pin, 1, {Wires::None, Wires::High}, 0);
    exchange();
}

void LineKit::plant(const WireFault& fault, double& mhz) {
    static const int banks[pins] = {
#define BANK(name, place) BOARD_BANK_##name,
        BRINGUP_LINES(BANK)
#undef BANK
            BOARD_BANK_MODEM_RXD,
        BOARD_BANK_MODEM_TXD, BOARD_BANK_MODEM_CTS, BOARD_BANK_MODEM_RTS, BOARD_BANK_MODEM_RESET};
    if (fault.wire == "CLK" || fault.bank() == BOARD_BANK_CLOCK)
        mhz = fault.kind == WireFault::Off ? mhz * (1 - fault.value / 100) : 0;
    if (fault.bank() >= 0) {
        for (unsigned pin = 0; pin < pins; ++pin)
            if (banks[pin] == fault.bank())
                wires_.powerOff(pin);
    } else if (fault.wire == "MODEM") {
        isModemFitted_ = false;
    } else if (fault.kind == WireFault::SecondDriver) {
        hasSecondMemory_ = true;
    } else if (fault.wire != "CLK") {
        wires_.plant(fault);
    }
}

uint16_t LineKit::levels(unsigned port, uint16_t inside) {
    for (unsigned i = 0; i < lines; ++i)
        if (places[i].port == port) {
            const auto bit = static_cast<uint16_t>(1u << places[i].pin);
            inside = static_cast<uint16_t>(wires_.level(i, 0, now_) ? inside | bit : inside & ~bit);
        }
    return inside;
}

void LineKit::changed(unsigned port) {
    for (unsigned i = 0; i < lines; ++i) {
        if (places[i].port != port)
            continue;
        const PinSetting s = stm32_.pinSetting(port, places[i].pin);
        Wires::End end;
        if (s.mode == PinSetting::Output)
            end.driver = !s.level ? Wires::Low : s.openDrain ? Wires::None : Wires::High;
        end.pull = s.pull > 0 ? Wires::High : s.pull < 0 ? Wires::Low : Wires::None;
        wires_.set(i, 0, end, now_);
    }
    exchange();
}

// Follows the modem's state. An XBee in reset drives nothing (xbee.h); without power it has no
// pulls either.
void LineKit::followModem() {
    const bool reset = !isModemFitted_ || !wires_.level(resetN, 0, now_);
    if (reset == inReset_ && now_)
        return;
    inReset_ = reset;
    wires_.setOther(rxd, reset ? Wires::None : Wires::High, now_);
    wires_.setOther(cts, reset ? Wires::None : Wires::Low, now_);
}

// Models another memory, which drives the data lines while NE1 and NOE are low.
void LineKit::followSecondMemory() {
    constexpr unsigned contents = 0x5AA5;
    const bool isSelected = !wires_.level(ne1, 0, now_) && !wires_.level(noe, 0, now_);
    for (unsigned line = 0; line < 16; ++line)
        wires_.setOther(line,
                        !isSelected             ? Wires::None
                        : contents >> line & 1u ? Wires::High
                                                : Wires::Low,
                        now_);
}

// Passes edges of NWE to the FPGA, and adds a second edge if the line rings.
void LineKit::pulseNwe(bool level) {
    const uint64_t bit = 1ull << nwe;
    for (int i = wires_.isRinging(nwe) ? 1 : 0; i >= 0; --i) {
        top_.pins_i = level ? top_.pins_i | bit : top_.pins_i & ~bit;
        top_.eval();
        if (i) {
            top_.pins_i ^= bit;
            top_.eval();
        }
    }
}

// Passes levels between the wires and the FPGA in both directions, until nothing changes.
void LineKit::exchange() {
    if (!options_.isConfigured)
        return;
    for (unsigned turn = 0; turn < 4; ++turn) {
        followModem();
        if (hasSecondMemory_)
            followSecondMemory();
        uint64_t inputs = 0;
        for (unsigned i = 0; i < pins; ++i)
            inputs |= uint64_t(wires_.level(i, 1, now_)) << i;
        if ((inputs ^ inputs_) >> nwe & 1)
            pulseNwe(inputs >> nwe & 1);
        if (inputs != inputs_) {
            inputs_ = inputs;
            top_.pins_i = inputs;
            top_.eval();
        }
        if (top_.pins_o == outputs_ && top_.pins_oe_o == enables_)
            return;
        const uint64_t moved = (top_.pins_o ^ outputs_) | (top_.pins_oe_o ^ enables_);
        outputs_ = top_.pins_o;
        enables_ = top_.pins_oe_o;
        for (unsigned i = 0; i < pins; ++i)
            if (moved >> i & 1) {
                Wires::End end;
                if (enables_ >> i & 1)
                    end.driver = outputs_ >> i & 1 ? Wires::High : Wires::Low;
                end.pull = i == rxd ? Wires::Low : i == cts ? Wires::High : Wires::None;
                wires_.set(i, 1, end, now_);
            }
    }
}

// Runs one clock of the FPGA's internal oscillator.
void LineKit::tick() {
    now_ += oscNs;
    if (now_ >= wires_.nextChange())
        exchange();
    if (!options_.isConfigured)
        return;
    for (; clockHalfNs_ > 0 && clockAt_ < static_cast<double>(now_); clockAt_ += clockHalfNs_) {
        top_.clk_i = !top_.clk_i;
        top_.eval();
    }
    for (const bool level : {true, false}) {
        top_.osc_i = level;
        top_.eval();
    }
    if (top_.pins_o != outputs_ || top_.pins_oe_o != enables_)
        exchange();
}

std::string LineKit::run(const std::string& elf, unsigned limitMs) {
    if (ElfImage(elf).segments().at(0).address < 0x20000000)
        stm32_.load(elf);
    stm32_.powerOn();
    if (!stm32_.image())
        stm32_.startInRam(elf);
    if (change_) { // only after the program has initialised its variables
        stm32_.cpu().breakpoints = {stm32_.image()->symbol("main") & ~1u};
        (void)stm32_.run();
        stm32_.cpu().breakpoints.clear();
        change_(stm32_);
    }
    const uint64_t end = now_ + uint64_t(limitMs) * 1'000'000;
    stm32_.onTime([this, end] {
        if (ended_ || now_ >= end)
            stm32_.cpu().stop();
        return end;
    });
    while (!ended_ && now_ < end)
        stm32_.run();
    return printed_;
}
