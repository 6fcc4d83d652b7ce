// SPDX-License-Identifier: MIT
//
// pin_delays: models the wires between the FSMC and the design. Each change of a pin is delayed
// separately. FsmcError is thrown if the data of a flip-flop changes within its set-up or hold
// time.

#pragma once

#include "fsmc_pins.h"
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <random>
#include <string>

// A delay, ps: random between two bounds, or one exact value (no skew).
struct PinDelay {
    constexpr PinDelay(int exact) : least(exact), most(exact) {}
    constexpr PinDelay(int atLeast, int atMost) : least(atLeast), most(atMost) {}
    int least, most;
};

// A corner: one set of delays for the STM32F2's pads (from HCLK's edge to the pin), the board, and
// the FPGA. The delays of the FPGA include its pads and the routing between a pad and the first or
// last flip-flop or LUT; synth/ise/chip.ucf limits these delays.
struct FsmcCorner {
    const char* name;
    PinDelay address, data, lanes, select, strobe; // processor
    PinDelay board;                                // delay of the board's tracks in each direction
    // padIn: delay of an input pad and its routing; clockIn: the same for NWE and NADV, which the
    // design uses as clocks
    PinDelay padIn, clockIn;
    PinDelay padOut; // delay of the last LUT, routing and output pad
    // set-up and hold time of the flip-flops that capture at NWE's edge
    int setup, hold;
    // set-up time that the FSMC needs for read data in addition to one HCLK cycle, ps
    int readSetup = 4000;
};

// The tables of the two data sheets (STM32F2, "FSMC characteristics"; Spartan-6, DS162, IOB and CLB
// switching) were not available. Therefore the delays of the pads are remembered values, which were
// not compared with the tables and are rounded to the safe side. The routing delays in the FPGA are
// the limits in synth/ise/chip.ucf. The tracks on the board are assumed to be 2 cm to 8 cm long.
// From address to read data, and from NE to NWAIT, a signal needs at most 10 ns through the chip,
// and 15 ns including the other delays.
inline const FsmcCorner fsmcCorners[] = {
    {"no delay", 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {"fast", 0, 0, 0, 0, 500, 100, 1000, 1500, 2500, 1000, 500},
    {"slow", 4000, 9000, 2000, 1000, 2500, 500, 3000, 5000, 7000, 1000, 500},
    {"late strobes", 0, 0, 0, 0, 2500, 100, 1000, 5000, 7000, 1000, 500},
    {"early strobes", 4000, 9000, 2000, 1000, 500, 500, 3000, 1500, 7000, 1000, 500},
    {"every pin its own",
     {0, 4000},
     {0, 9000},
     {0, 2000},
     {0, 1000},
     {500, 2500},
     {100, 500},
     {1000, 3000},
     {1500, 5000},
     {2500, 7000},
     1000,
     500},
};

// Returns a corner of delays; in the tests *.cdc.* (CDC_SEED is set), a simplified corner. In these
// tests each synchroniser may be late by a whole clock, which already covers the effect of the
// delays (docs/fsmc.md). In a simplified corner the address arrives no later than NOE, the bits of
// the address arrive together, and NWE's delay into the chip is equal at both edges. At 60 MHz the
// bits of the address may still arrive at different times before NOE.
inline FsmcCorner cornerOf(unsigned index, unsigned hclk = 100) {
    FsmcCorner corner = fsmcCorners[index];
    if (std::getenv("CDC_SEED")) {
        corner.address = 0;
        if (hclk < 100)
            corner.strobe = 4000, corner.address = {0, 4000};
        corner.board.most = corner.board.least;
        corner.padIn.most = corner.padIn.least;
        corner.clockIn.least = corner.clockIn.most;
    }
    return corner;
}

class PinDelays {
public:
    // `near` are the pins of the processor, `far` the pins of the design; clock periods are in ps.
    PinDelays(FsmcPins& near, FsmcPins& far, FsmcDesign design, const FsmcCorner& corner,
              uint64_t seed, int hclk, int clk)
        : near_(near), far_(far), design_(std::move(design)), corner_(corner), random_(seed),
          nextEdge_(clk), hclk_(hclk), clk_(clk), sent_(driven(near)), arrived_(sent_) {
        nextEdge_ = 1 + static_cast<int64_t>(random_() % static_cast<uint64_t>(clk)); // any phase
    }

    // Starts a delay for each processor pin that has changed.
    void show() {
        uint64_t levels = driven(near_);
        for (unsigned pin = 0; pin <= drives; ++pin)
            if ((levels ^ sent_) >> pin & 1)
                at(now_ + delayOf(pin), pin, levels >> pin & 1, true);
        sent_ = levels;
        pass(0);
    }
    // Advances the time by HCLK cycles, and runs the design clock.
    void pass(unsigned hclks) {
        int64_t end = now_ + int64_t(hclks) * hclk_;
        for (;;) {
            int64_t change = changes_.empty() ? end + 1 : changes_.begin()->first;
            if (std::min(change, nextEdge_) > end)
                break;
            if (nextEdge_ <= change) {
                now_ = nextEdge_;
                nextEdge_ += clk_;
                design_.tick();
                settled();
                continue;
            }
            Change c = changes_.begin()->second;
            now_ = change;
            changes_.erase(changes_.begin());
            if (c.toDesign) {
                arrive(c.pin, c.level);
                continue;
            }
            if (c.pin == nwaitOut)
                near_.nwaitN = c.level;
            else if (c.pin == drivenOut)
                near_.dDriven = c.level;
            else
                near_.dFromDesign = static_cast<uint16_t>((near_.dFromDesign & ~(1u << c.pin)) |
                                                          unsigned(c.level) << c.pin);
            if (c.pin != nwaitOut)
                dataMoved_ = now_;
        }
        now_ = end;
    }
    // Sets the period of HCLK, ps.
    void setHclk(int hclk) { hclk_ = hclk; }
    // Adds a delay, ps, to a pin: one of the processor's outputs, or NWAIT.
    void addDelay(const std::string& pin, int ps) {
        static const std::map<std::string, unsigned> bits = {
            {"NE1", selectBit}, {"NE2", selectBit + 1}, {"NWE", nwe},  {"NOE", noe},
            {"NBL0", laneBit},  {"NBL1", laneBit + 1},  {"NADV", nadv}};
        if (pin == "NWAIT")
            nwaitExtra_ = ps;
        else if (bits.count(pin))
            extra_[bits.at(pin)] = ps;
        else if (pin.size() > 1 && (pin[0] == 'A' || pin[0] == 'D'))
            extra_.at((pin[0] == 'D' ? unsigned(dataBit) : 0u) +
                      static_cast<unsigned>(std::stoul(pin.substr(1)))) = ps;
        else
            throw std::runtime_error("late " + pin + ": expected a line of the FSMC");
    }
    // Accepts signals that change at the wrong time as they are, instead of throwing FsmcError.
    void tolerate() { tolerant_ = true; }
    // Returns true if the data at the processor pins has been stable for the set-up time.
    bool dataIsSetUp() const { return now_ - dataMoved_ >= corner_.readSetup + hclk_; }

private:
    static constexpr unsigned nwaitOut = 17, drivenOut = 16;

    enum { dataBit = 25, laneBit = 41, selectBit = 43, nwe = 47, noe = 48, nadv = 49, drives = 50 };
    static uint64_t driven(const FsmcPins& p) {
        return (p.a & 0x1FFFFFFu) | uint64_t(p.d) << dataBit | uint64_t(p.nblN & 3) << laneBit |
               uint64_t(p.neN & 15) << selectBit | uint64_t(p.nweN) << nwe |
               uint64_t(p.noeN) << noe | uint64_t(p.nadvN) << nadv | uint64_t(p.dOut) << drives;
    }
    static void drive(FsmcPins& p, uint64_t levels) {
        p.a = levels & 0x1FFFFFFu;
        p.d = static_cast<uint16_t>(levels >> dataBit);
        p.nblN = levels >> laneBit & 3;
        p.neN = levels >> selectBit & 15;
        p.nweN = levels >> nwe & 1;
        p.noeN = levels >> noe & 1;
        p.nadvN = levels >> nadv & 1;
        p.dOut = levels >> drives & 1;
    }
    int between(PinDelay delay) {
        return std::uniform_int_distribution<int>(delay.least, delay.most)(random_);
    }
    int delayOf(unsigned pin) {
        bool clock = pin == nwe || pin == nadv;
        PinDelay processor = pin < dataBit                    ? corner_.address
                             : pin < laneBit || pin == drives ? corner_.data
                             : pin < selectBit                ? corner_.lanes
                             : pin < nwe                      ? corner_.select
                                                              : corner_.strobe;
        return extra_[pin] + between(processor) + between(corner_.board) +
               between(clock ? corner_.clockIn : corner_.padIn);
    }
    // Applies the delayed change of a pin at the design or at the processor.
    void arrive(unsigned pin, bool level) {
        bool selected = (arrived_ >> selectBit & 3) != 3;
        if (level && selected && pin == nwe) {
            if (!tolerant_ && now_ - inputMoved_ < corner_.setup)
                throw FsmcError("a pin moved in the set-up time of NWE's rising edge");
            captured_ = now_;
        } else if (pin < nwe) {
            if (!tolerant_ && now_ - captured_ < corner_.hold)
                throw FsmcError("a pin moved in the hold time of NWE's rising edge");
            inputMoved_ = now_;
        }
        arrived_ = (arrived_ & ~(uint64_t(1) << pin)) | uint64_t(level) << pin;
        drive(far_, arrived_);
        design_.settle();
        settled();
    }
    // Starts a delay for each of the design's outputs that has changed.
    void settled() {
        uint32_t out = far_.dFromDesign | uint32_t(far_.dDriven) << drivenOut |
                       uint32_t(far_.nwaitN) << nwaitOut;
        for (unsigned pin = 0; pin < 18; ++pin)
            if ((out ^ shown_) >> pin & 1)
                at(now_ + between(corner_.padOut) + between(corner_.board) +
                       (pin == nwaitOut ? nwaitExtra_ : 0),
                   pin, out >> pin & 1, false);
        shown_ = out;
    }
    // Schedules the change of a pin at `time`. Several changes of one pin keep their order.
    void at(int64_t time, unsigned pin, bool level, bool toDesign) {
        int64_t& last = toDesign ? last_[pin] : lastOut_[pin];
        last = std::max(time, last);
        changes_.insert({last, {pin, level, toDesign}});
    }

    struct Change {
        unsigned pin;
        bool level, toDesign;
    };
    FsmcPins &near_, &far_;
    FsmcDesign design_;
    const FsmcCorner& corner_;
    std::mt19937_64 random_;
    int64_t now_ = 0, nextEdge_, captured_ = -1000000, inputMoved_ = 0, dataMoved_ = 0;
    int hclk_, clk_;
    std::array<int, drives + 1> extra_{};
    int nwaitExtra_ = 0;
    bool tolerant_ = false;
    uint64_t sent_, arrived_;
    // current outputs of the design: data in bits 15..0, data enable in bit 16, NWAIT in bit 17
    uint32_t shown_ = 1u << 17;
    int64_t last_[64] = {}, lastOut_[18] = {};
    std::multimap<int64_t, Change> changes_;
};
