// SPDX-License-Identifier: MIT
//
// pin_delays: the wires between the FSMC and the design: each change of each pin has its own delay,
// and a flip-flop whose data moves in its set-up or hold time throws.

#ifndef PIN_DELAYS_H
#define PIN_DELAYS_H

#include "fsmc_master.h"
#include <algorithm>
#include <cstdint>
#include <map>
#include <random>

// A delay in ps, random between two bounds, or exact: no skew.
struct PinDelay {
    constexpr PinDelay(int exact) : least(exact), most(exact) {}
    constexpr PinDelay(int atLeast, int atMost) : least(atLeast), most(atMost) {}
    int least, most;
};

// A corner of delays: the STM32F2's pads (from HCLK's edge to the pin), the board, and Spartan-6's
// pads and routing up to the first flip-flop or LUT, and from the last one. The chip's share is the
// limit in synth/ise/chip.ucf.
struct FsmcCorner {
    const char* name;
    PinDelay address, data, lanes, select, strobe; // processor
    PinDelay board;                                // each way
    PinDelay padIn, clockIn;                       // clockIn: NWE, NADV, as clocks
    PinDelay padOut;                               // LUTs and pad
    int setup, hold;                               // of the design's capture by NWE
    int readSetup = 4000;                          // of the FSMC, before HCLK's length
};

extern const FsmcCorner fsmcCorners[];
extern const unsigned fsmcCornerCount;

class PinDelays {
public:
    // `near` are the processor's pins, `far` the design's; clocks' lengths in ps.
    PinDelays(FsmcPins& near, FsmcPins& far, FsmcMaster::Design design, const FsmcCorner& corner,
              uint64_t seed, int hclk, int clk);

    // Sends on changes at the processor's pins.
    void show();
    // Lets time pass; clocks the design meanwhile.
    void pass(unsigned hclks);
    // True if the data at the processor's pins has been stable for its set-up time.
    bool dataIsSetUp() const { return now_ - dataMoved_ >= corner_.readSetup + hclk_; }

private:
    enum { dataBit = 25, laneBit = 41, selectBit = 43, nwe = 47, noe = 48, nadv = 49, drives = 50 };
    static uint64_t driven(const FsmcPins& pins);
    static void drive(FsmcPins& pins, uint64_t levels);
    int between(PinDelay delay);
    int delayOf(unsigned pin);
    void arrive(unsigned pin, bool level);
    void settled();
    void at(int64_t time, unsigned pin, bool level, bool toDesign);

    struct Change {
        unsigned pin;
        bool level, toDesign;
    };
    FsmcPins &near_, &far_;
    FsmcMaster::Design design_;
    const FsmcCorner& corner_;
    std::mt19937_64 random_;
    int64_t now_ = 0, nextEdge_, captured_ = -1000000, inputMoved_ = 0, dataMoved_ = 0;
    int hclk_, clk_;
    uint64_t sent_, arrived_;
    uint32_t shown_ = 1u << 17; // the design's present outputs: data, its driver, NWAIT
    int64_t last_[64] = {}, lastOut_[18] = {};
    std::multimap<int64_t, Change> changes_;
};

#endif
