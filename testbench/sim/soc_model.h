// SPDX-License-Identifier: MIT
//
// soc_model: simulates the Verilated chip with its memory, its modem and the FSMC of its processor.
// tick() computes one clock. Clocks in which only counters of the chip would change are not
// evaluated. They are counted, and are added to the chip's counters before anything reads the chip
// (quiet_span.h).

#pragma once

#include "VSoc.h"
#include "board_wires.h"
#include "camera_alone.h"
#include "fsmc_master.h"
#include "mcb_model.h"
#include "observer.h"
#include "quiet_span.h"
#include "rf_channel.h"
#include "serial_line.h"
#include "xbee.h"
#include <algorithm>
#include <functional>
#include <memory>
#include <verilated.h>

class SocModel {
public:
    // frequency of the design clock, Hz; set by `make run CLK_HZ=`
    static constexpr uint64_t clkHz = SOC_CLK_HZ;
    static constexpr uint64_t clkNs = 1'000'000'000 / clkHz;

    // `hclkPerUnit` and `clkPerUnit` set the ratio of HCLK to the design clock; the default is
    // the ratio of 120 MHz to 100 MHz.
    SocModel(RfChannel& air, XBee::Options modemOptions, unsigned hclkPerUnit = 6,
             unsigned clkPerUnit = 5);
    ~SocModel();

    // Resets the chip. If `memoryStarts` is false, the memory is ready when this function returns.
    // If it is true, the function returns at once, although the memory only becomes ready a
    // millisecond later; this suits a processor that does not wait for the memory.
    void reset(bool memoryStarts = false);
    void tick(); // computes one clock cycle

    // Skips clocks while the chip is quiet, or computes clocks in which only the camera works, but
    // not beyond clock `until`, and not beyond a call of the models of modem and air. Returns the
    // number of these clocks.
    uint64_t passQuiet(uint64_t until) {
        if (alone_ && until > cycles_)
            return workAlone(until - cycles_);
        uint64_t clocks = until > cycles_ ? std::min(quiet_, until - cycles_) : 0;
        if (clocks)
            clocks = std::min(clocks, untilModels());
        quiet_ -= clocks;
        owed_ += clocks;
        cycles_ += clocks;
        if (clocks && now() >= nextEvent_) {
            pay();
            if (now() >= nextEvent_)
                timeModels();
        }
        return clocks;
    }
    // Keeps the clocks of idle cores running (hdl/system/core_gate.v). Call it before reset(); used
    // for comparisons.
    void ungate() {
        const char* option = "+ungated";
        context_->commandArgsAdd(1, &option);
    }
    // If `all` is true, evaluates every clock and skips none; used for comparisons.
    void evaluateAll(bool all) {
        wake();
        skips_ = !all;
    }
    // Returns the number of clocks that were evaluated, and how many of them only for the camera.
    uint64_t evaluated() const { return evaluated_; }
    uint64_t evaluatedAlone() const { return evaluatedAlone_; }
    CameraAlone& camera() { return camera_; } // for tests
    // Returns the name of the core that changed in most of the evaluated clocks; empty if there is
    // no such core.
    std::string mover() const { return span_.mover(); }

    // Returns the complete current state of the chip.
    const VSoc& chip() {
        pay();
        return *top_;
    }
    uint64_t cycles() const { return cycles_; }
    uint64_t now() const { return cycles_ * clkNs; }
    bool nwaitN() const { return far_->nwaitN; } // level of NWAIT at the processor
    bool irq() const { return wires_.areOthersStraight() ? top_->irq_o : irq_; }

    // Sets the input pins of cores (MAP_PIN_...); they take effect with the next evaluation.
    // `sampled` means that the pins only lead to flip-flops, like the pins of a sensor; the
    // platform can then still be skipped.
    void setCorePins(uint32_t value, bool sampled = false) {
        if (!sampled) {
            wake();
        } else if (!resting_ && !alone_) {
            pay();
            quiet_ = 0;
        }
        top_->core_pins_i = value;
    }
    uint32_t corePins() const { return top_->core_pins_o; }

    // Sets the function that drives the input pins of the cores. The function is called before a
    // clock; it returns the number of the clock (cycles()) before which it must be called the next
    // time.
    void onClock(std::function<uint64_t()> drive) { drive_ = std::move(drive); }
    // Sets a function that is called at each change of the cores' output pins.
    void onCorePins(std::function<void(uint32_t)> changed) {
        corePinsChanged_ = std::move(changed);
    }

    FsmcMaster& fsmc() { return fsmc_; }
    // The wires of the board between processor, modem and chip.
    BoardWires& wires() { return wires_; }
    // Changes the rate of the chip clock, in percent; -100 stops it. Call it before the reset.
    // The processor and the modem keep their rates; now() returns the time of the chip.
    void changeClock(double percent);
    // Adds delays to the FSMC's wires; only with a clock of 100 MHz.
    void delay(const FsmcCorner& corner, uint64_t seed, bool looksTwice) {
        delayed_ = pins_;
        far_ = &delayed_;
        fsmc_.delay(corner, delayed_, seed, looksTwice);
        fsmc_.pauseWrites(looksTwice);
    }
    McbModel& memory() {
        wake(); // the caller may start or end a fault of the memory
        return memory_;
    }
    XBee& modem() { return modem_; }
    // Returns the serial line at the chip's modem pins, to connect a cable instead of the modem.
    UartPins& line() { return line_; }
    void plugIn(Cable& cable) { cable_ = &cable; }

    // Replaces the function that advances the air whenever the models are updated. This is
    // necessary if several chips share the air.
    void onAir(std::function<void(uint64_t now)> advance) { advanceAir_ = std::move(advance); }
    // Adds a model with events in simulated time, such as the ground's modem. The function is
    // called when an event is due, and returns the time of the next event.
    void onTime(std::function<uint64_t(uint64_t now)> advance) { others_ = std::move(advance); }

    // Sets a function that is called at each edge of the interrupt line.
    void onIrq(std::function<void(bool high)> edge) { irqEdge_ = std::move(edge); }

private:
    void timeModels();
    void passOutputs();
    void fromModem();
    void throughWires();
    void standStill();
    void settle();
    void showOutputs();
    void evaluate(bool rests = false);
    void pay();
    void wake();
    void look();
    uint64_t workAlone(uint64_t clocks);
    // Returns the number of clocks after which the models outside the chip must be called.
    uint64_t untilModels() const {
        return nextEvent_ > now() ? (nextEvent_ - now() - 1) / clkNs + 1 : 1;
    }
    // Returns true if drive_ must be called before the next clock.
    bool isDriven() const { return drive_ && cycles_ >= driveAt_; }
    void endAlone();
    QuietSpan::Clocks mayBeQuiet() const;

    std::unique_ptr<VerilatedContext> context_;
    Observer<VSoc> observer_;
    std::unique_ptr<VSoc> top_;
    QuietSpan span_;
    bool skips_ = true;
    uint64_t quiet_ = 0; // number of future clocks that need not be evaluated
    // number of skipped clocks that are not yet added to the chip's counters
    uint64_t owed_ = 0;
    uint64_t resting_ = 0; // number of future clocks in which the platform need not be evaluated
    // number of skipped clocks of the platform that are not yet added to the platform's counters
    uint64_t rested_ = 0;
    uint64_t evaluated_ = 0, evaluatedAlone_ = 0;
    CameraAlone camera_;
    uint64_t alone_ = 0; // number of future clocks in which only the camera need be evaluated
    // number of clocks that the camera has computed alone and that the chip does not have yet
    uint64_t ahead_ = 0;
    // clock at which the camera's state must be marked, as a value of ahead_, and the number of the
    // carry of the baud rate's phase that follows
    uint64_t markAt_ = 0, carry_ = 0;
    BoardWires wires_;
    FsmcPins pins_, delayed_;
    FsmcPins* far_ = &pins_; // FSMC pins at the chip
    FsmcMaster fsmc_;
    McbModel memory_;
    RfChannel& air_;
    std::function<void(uint64_t)> advanceAir_ = [this](uint64_t now) { air_.advance(now); };
    UartPins line_;
    XBee modem_;
    Cable* cable_ = nullptr;
    std::function<uint64_t()> drive_;
    uint64_t driveAt_ = 0; // number of the clock by which drive_ must be called again
    std::function<void(uint32_t)> corePinsChanged_;
    uint32_t corePins_ = 0;
    std::function<uint64_t(uint64_t)> others_;
    uint64_t cycles_ = 0, nextEvent_ = 0;
    std::function<void(bool)> irqEdge_;
    // levels at the processor and at the modem
    bool irq_ = false, txd_ = true, resetN_ = true, rtsN_ = false;
    bool hasClock_ = true;
};
