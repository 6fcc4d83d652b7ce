// SPDX-License-Identifier: MIT
//
// pin_waves: what the FSMC's pins do in one synchronous burst, as WaveJSON: a page's waveform that
// a test compares.

#ifndef PIN_WAVES_H
#define PIN_WAVES_H

#include "fsmc_master.h"
#include <string>
#include <vector>

// Sampled after each cycle of the design's clock, from which NE1 falls in step; a brick of the
// waveform is half a cycle of FSMC_CLK, so many clocks: pins as they are at its end.
class PinWaves {
public:
    PinWaves(const FsmcPins& pins, unsigned clocksOfABrick) : pins_(pins), brick_(clocksOfABrick) {}

    void sample() {
        bool selected = !(pins_.neN & 1);
        if (samples_.empty() && !selected) {
            before_ = pins_;
            return;
        }
        if (samples_.empty())
            samples_.push_back(before_);
        if (++clocks_ % brick_ == 0)
            samples_.push_back(pins_);
    }

    // `values` are the burst's data: other levels on D mean nothing to anybody. FSMC_CLK's edges
    // are numbered from the address's, which is 0.
    std::string json(const std::string& head, const std::string& foot,
                     const std::vector<uint16_t>& values) {
        Row clk, edges, a, ne, nadv, noe, nwe, nwait, d;
        unsigned edge = 0;
        bool wasClk = false, isWrite = false;
        for (const FsmcPins& p : samples_) {
            bool selected = !(p.neN & 1);
            isWrite = isWrite || (selected && !p.nweN);
            clk.level(p.clk);
            if (p.clk && !wasClk) {
                edges.bus('2', std::to_string(edge++));
            } else if (!p.clk) {
                edges.bus('z', "");
            }
            wasClk = p.clk;
            a.bus(selected && !p.nadvN ? '2' : 'x', selected && !p.nadvN ? "n" : "");
            ne.level(p.neN & 1);
            nadv.level(p.nadvN);
            noe.level(p.noeN);
            nwe.level(p.nweN);
            nwait.level(p.nwaitN);
            size_t which = 0;
            uint16_t value = p.dOut ? p.d : p.dFromDesign;
            while (which < values.size() && values[which] != value)
                ++which;
            bool driven = p.dOut || p.dDriven, known = driven && p.nadvN && which < values.size();
            d.bus(known    ? (p.dOut ? '3' : '4')
                  : driven ? 'x'
                           : 'z',
                  known ? "n+" + std::to_string(which) : "");
        }
        std::string text = "{\"signal\": [\n";
        text += clk.json("FSMC_CLK") + edges.json("edge") + a.json("A") + ne.json("NE1") +
                nadv.json("NADV");
        text += (isWrite ? nwe.json("NWE") : noe.json("NOE")) + nwait.json("NWAIT") + d.json("D");
        text.erase(text.size() - 2, 1); // the last comma
        return text + " ],\n \"head\": {\"text\": \"" + head + "\"},\n \"foot\": {\"text\": \"" +
               foot + "\"}}\n";
    }

private:
    struct Row {
        std::string wave, data;
        char last = 0;
        std::string label;

        void bus(char state, const std::string& name) {
            bool same = state == last && name == label;
            wave += same ? '.' : state;
            if (!same && state >= '2' && state <= '9')
                data += (data.empty() ? "\"" : ", \"") + name + "\"";
            last = state, label = name;
        }
        void level(bool high, char low = '0') { bus(high ? '1' : low, ""); }
        std::string json(const std::string& name) const {
            return "  {\"name\": \"" + name + "\", \"wave\": \"" + wave + "\"" +
                   (data.empty() ? "" : ", \"data\": [" + data + "]") + "},\n";
        }
    };

    const FsmcPins& pins_;
    unsigned brick_, clocks_ = 0;
    FsmcPins before_;
    std::vector<FsmcPins> samples_;
};

#endif
