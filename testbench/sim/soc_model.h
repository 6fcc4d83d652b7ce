// SPDX-License-Identifier: MIT
//
// soc_model: the Verilated chip with its memory, its modem and its processor's FSMC: one clock.

#ifndef SOC_MODEL_H
#define SOC_MODEL_H

#include "VSoc.h"
#include "fsmc_master.h"
#include "mcb_model.h"
#include "observer.h"
#include "rf_channel.h"
#include <functional>
#include <memory>
#include <verilated.h>

class SocModel {
public:
    static constexpr uint64_t clkHz = 2'000'000; // see docs/simulation.md
    static constexpr uint64_t clkNs = 1'000'000'000 / clkHz;

    // HCLK to clkHz: 120 MHz to 100 MHz, scaled down, unless stated otherwise.
    SocModel(RfChannel& air, XBee::Options modemOptions, unsigned hclkPerUnit = 6,
             unsigned clkPerUnit = 5);
    ~SocModel();

    void reset();
    void tick(); // one clock cycle
    uint64_t cycles() const { return cycles_; }
    uint64_t now() const { return cycles_ * clkNs; }
    bool irq() const { return top_->irq_o; }

    // The pins of cores (MAP_PIN_...): inputs as they are from the next settling on.
    void setCorePins(uint32_t value) { top_->core_pins_i = value; }

    // Before each clock: what drives those pins.
    void onClock(std::function<void()> drive) { drive_ = std::move(drive); }

    FsmcMaster& fsmc() { return fsmc_; }
    McbModel& memory() { return memory_; }
    XBee& modem() { return modem_; }

    // Something else that has events in simulated time (the ground's modem): it is called when due.
    void onTime(std::function<uint64_t(uint64_t now)> advance) { others_ = std::move(advance); }

    // Told of each edge of the interrupt line.
    void onIrq(std::function<void(bool high)> edge) { irqEdge_ = std::move(edge); }

private:
    void timeModels();
    void settle();

    std::unique_ptr<VerilatedContext> context_;
    Observer<VSoc> observer_;
    std::unique_ptr<VSoc> top_;
    FsmcPins pins_;
    FsmcMaster fsmc_;
    McbModel memory_;
    RfChannel& air_;
    UartPins line_;
    XBee modem_;
    std::function<void()> drive_;
    std::function<uint64_t(uint64_t)> others_;
    uint64_t cycles_ = 0, nextEvent_ = 0;
    std::function<void(bool)> irqEdge_;
    bool irq_ = false, txd_ = true, resetN_ = true, rtsN_ = false;
};

#endif
