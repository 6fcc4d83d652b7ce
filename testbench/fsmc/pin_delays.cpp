// SPDX-License-Identifier: MIT
//
// pin_delays: changes of pins as events in time.

#include "pin_delays.h"
#include <algorithm>

namespace {

constexpr unsigned nwaitOut = 17, drivenOut = 16;

} // namespace

// The tables of the two data sheets (STM32F2, "FSMC characteristics"; Spartan-6, DS162, IOB and CLB
// switching) could not be had. The pads' values are from memory, rounded to the safe side. Routing
// in the chip is what synth/ise/chip.ucf allows; boards are 2 cm to 8 cm. Address to read data and
// NE to NWAIT are at most 10 ns through the chip, and 15 ns with the rest.
const FsmcCorner fsmcCorners[] = {
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
const unsigned fsmcCornerCount = sizeof fsmcCorners / sizeof *fsmcCorners;

PinDelays::PinDelays(FsmcPins& near, FsmcPins& far, FsmcMaster::Design design,
                     const FsmcCorner& corner, uint64_t seed, int hclk, int clk)
    : near_(near), far_(far), design_(std::move(design)), corner_(corner), random_(seed),
      nextEdge_(clk), hclk_(hclk), clk_(clk), sent_(driven(near)), arrived_(sent_) {
    nextEdge_ = 1 + static_cast<int64_t>(random_() % static_cast<uint64_t>(clk)); // any phase
}

uint64_t PinDelays::driven(const FsmcPins& p) {
    return (p.a & 0x1FFFFFFu) | uint64_t(p.d) << dataBit | uint64_t(p.nblN & 3) << laneBit |
           uint64_t(p.neN & 15) << selectBit | uint64_t(p.nweN) << nwe | uint64_t(p.noeN) << noe |
           uint64_t(p.nadvN) << nadv | uint64_t(p.dOut) << drives;
}

void PinDelays::drive(FsmcPins& p, uint64_t levels) {
    p.a = levels & 0x1FFFFFFu;
    p.d = static_cast<uint16_t>(levels >> dataBit);
    p.nblN = levels >> laneBit & 3;
    p.neN = levels >> selectBit & 15;
    p.nweN = levels >> nwe & 1;
    p.noeN = levels >> noe & 1;
    p.nadvN = levels >> nadv & 1;
    p.dOut = levels >> drives & 1;
}

int PinDelays::between(PinDelay delay) {
    return std::uniform_int_distribution<int>(delay.least, delay.most)(random_);
}

int PinDelays::delayOf(unsigned pin) {
    bool clock = pin == nwe || pin == nadv;
    PinDelay processor = pin < dataBit                    ? corner_.address
                         : pin < laneBit || pin == drives ? corner_.data
                         : pin < selectBit                ? corner_.lanes
                         : pin < nwe                      ? corner_.select
                                                          : corner_.strobe;
    return between(processor) + between(corner_.board) +
           between(clock ? corner_.clockIn : corner_.padIn);
}

// Schedules a pin's change; its changes keep their order.
void PinDelays::at(int64_t time, unsigned pin, bool level, bool toDesign) {
    int64_t& last = toDesign ? last_[pin] : lastOut_[pin];
    last = std::max(time, last);
    changes_.insert({last, {pin, level, toDesign}});
}

void PinDelays::show() {
    uint64_t levels = driven(near_);
    for (unsigned pin = 0; pin <= drives; ++pin)
        if ((levels ^ sent_) >> pin & 1)
            at(now_ + delayOf(pin), pin, levels >> pin & 1, true);
    sent_ = levels;
    pass(0);
}

// Lets a pin's change arrive at the design or at the processor.
void PinDelays::arrive(unsigned pin, bool level) {
    bool selected = (arrived_ >> selectBit & 3) != 3;
    if (level && selected && pin == nwe) {
        if (now_ - inputMoved_ < corner_.setup)
            throw FsmcError("a pin moved in the set-up time of NWE's rising edge");
        captured_ = now_;
    } else if (pin < nwe) {
        if (now_ - captured_ < corner_.hold)
            throw FsmcError("a pin moved in the hold time of NWE's rising edge");
        inputMoved_ = now_;
    }
    arrived_ = (arrived_ & ~(uint64_t(1) << pin)) | uint64_t(level) << pin;
    drive(far_, arrived_);
    design_.settle();
    settled();
}

// Sends on changes at the design's pins.
void PinDelays::settled() {
    uint32_t out =
        far_.dFromDesign | uint32_t(far_.dDriven) << drivenOut | uint32_t(far_.nwaitN) << nwaitOut;
    for (unsigned pin = 0; pin < 18; ++pin)
        if ((out ^ shown_) >> pin & 1)
            at(now_ + between(corner_.padOut) + between(corner_.board), pin, out >> pin & 1, false);
    shown_ = out;
}

void PinDelays::pass(unsigned hclks) {
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
