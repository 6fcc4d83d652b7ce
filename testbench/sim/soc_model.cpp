// SPDX-License-Identifier: MIT
//
// soc_model: the innermost loop of the simulator. Events that are rare are checked only when they
// are due.

#include "soc_model.h"
#include "mcb_model.h"
#include "tell_on_abort.h"
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace {

// Makes the Verilated model use a single thread, because after a fork only the calling thread
// exists.
VerilatedContext* oneThread() {
    auto* context = new VerilatedContext;
    context->threads(1);
    return context;
}

} // namespace

SocModel::SocModel(RfChannel& air, XBee::Options modemOptions, unsigned hclkPerUnit,
                   unsigned clkPerUnit)
    : context_(oneThread()), observer_(*context_), top_(new VSoc(context_.get())), span_(*top_),
      camera_(*top_), fsmc_(pins_,
                            {[this] { tick(); }, [this] { settle(); },
                             [this](uint64_t clocks, uint64_t ns) {
                                 return passQuiet(cycles_ + std::min(clocks, ns / clkNs));
                             }},
                            hclkPerUnit, clkPerUnit),
      air_(air), modem_(line_, air, std::move(modemOptions)) {
    top_->modem_rxd_i = 1;
    tellOnAbort(this, [this] {
        return "The chip stands at clock " + std::to_string(cycles_) + ", interrupt " +
               std::to_string(irq()) + ", cores' pins " + std::to_string(corePins()) +
               ", modem's RTS " + std::to_string(rtsN_) + ".";
    });
}

SocModel::~SocModel() {
    tellers.erase(this);
    // the destructors of the chip's scopes use this context
    Verilated::threadContextp(context_.get());
    top_->final();
    observer_.finish();
}

void SocModel::reset(bool memoryStarts) {
    wake();
    if (memoryStarts)
        memory_.restart(McbModel::startClocks);
    top_->rst_i = 1;
    settle();
    for (int i = 0; i < 8; ++i)
        tick();
    top_->rst_i = 0;
    // The chip leaves its reset some clocks after the reset pin falls, because of the synchroniser.
    const bool waits = !memoryStarts && hasClock_ && !memory_.neverStarts();
    for (int i = 0; i < 8 || (waits && !memory_.pins.calibDone); ++i)
        tick();
}

void SocModel::timeModels() {
    uint64_t time = now();
    if (cable_) {
        cable_->advance(time);
        nextEvent_ = cable_->nextEvent();
    } else {
        advanceAir_(time);
        modem_.advance(time);
        nextEvent_ = std::min(air_.nextEvent(), modem_.nextEvent());
    }
    if (others_)
        nextEvent_ = std::min(nextEvent_, others_(time));
    fromModem();
}

// Passes the levels of the modem's outputs to the chip. If a level changes, the clocks before the
// change are computed first.
void SocModel::fromModem() {
    bool rxd = line_.rxd(), ctsN = line_.ctsN();
    if (!wires_.areOthersStraight()) {
        wires_.drive(BoardWires::ModemRxd, rxd);
        wires_.drive(BoardWires::ModemCts, ctsN);
        rxd = wires_.arrives(BoardWires::ModemRxd);
        ctsN = wires_.arrives(BoardWires::ModemCts);
    }
    if (top_->modem_rxd_i == rxd && top_->modem_cts_n_i == ctsN)
        return;
    wake();
    top_->modem_rxd_i = rxd;
    top_->modem_cts_n_i = ctsN;
}

// Puts the chip's outputs, except the outputs of the FSMC, on the wires of the board, which may
// have faults.
void SocModel::throughWires() {
    wires_.drive(BoardWires::ModemTxd, top_->modem_txd_o);
    wires_.drive(BoardWires::ModemRts, top_->modem_rts_n_o);
    wires_.drive(BoardWires::ModemReset, top_->modem_reset_n_o);
    wires_.drive(BoardWires::Irq, top_->irq_o);
    fromModem();
}

void SocModel::changeClock(double percent) {
    hasClock_ = percent > -100;
    if (!hasClock_)
        return;
    const double rate = 1 + percent / 100;
    fsmc_.setClocks(6000, static_cast<unsigned>(std::lround(5000 * rate)));
    line_.drift(rate);
}

// Lets one clock period pass for a chip without a clock.
void SocModel::standStill() {
    ++cycles_;
    if (now() >= nextEvent_)
        timeModels();
    quiet_ = now() < nextEvent_ ? (nextEvent_ - now() - 1) / clkNs : 0;
}

// Returns three numbers of clocks: until an input of the chip may change, except for the pins from
// the modem; until any input of the platform may change; and the first one again for a camera whose
// pins change in each clock. If a pin from the modem changes, fromModem() ends the span.
QuietSpan::Clocks SocModel::mayBeQuiet() const {
    if (!skips_ || now() >= nextEvent_)
        return {};
    const uint64_t platform = (nextEvent_ - now() - 1) / clkNs;
    uint64_t clocks = memory_.untilEvent();
    if (drive_)
        clocks = std::min(clocks, std::max(driveAt_, cycles_) - cycles_);
    const bool isSensed = drive_ && driveAt_ <= cycles_ + 1 && camera_.exists();
    return {clocks, platform, isSensed ? ~uint64_t(0) : 0};
}

// Adds the clocks that have passed without evaluation to the chip's counters.
void SocModel::pay() {
    if (ahead_)
        endAlone();
    alone_ = 0;
    if (rested_)
        (void)span_.pass(rested_); // these clocks contain no tick of the baud rate
    rested_ = 0;
    if (!hasClock_)
        owed_ = 0;
    if (!owed_)
        return;
    uint64_t left = span_.pass(owed_);
    memory_.pass(owed_ - left);
    owed_ = 0;
    if (left) // a tick of the baud rate has begun, so the remaining clocks are evaluated
        quiet_ = 0;
    for (cycles_ -= left; left; --left)
        evaluate();
}

// Ends a quiet span, because an input is about to change.
void SocModel::wake() {
    pay();
    quiet_ = resting_ = 0;
    span_.forget();
}

// Computes up to `clocks` clocks with the camera alone; returns their number.
uint64_t SocModel::workAlone(uint64_t clocks) {
    uint64_t done = 0;
    for (bool goesOn = true; goesOn && alone_ && done < clocks;) {
        if (isDriven()) {
            driveAt_ = drive_();
            if (!alone_) // the function has looked at the chip, or has changed it
                break;
            if (driveAt_ > cycles_ + 1) { // the sensor sends nothing
                pay();
                break;
            }
        }
        if (ahead_ == markAt_) {
            camera_.mark();
            markAt_ = span_.untilCarry(++carry_);
        }
        goesOn = camera_.clock(memory_);
        ++cycles_;
        ++ahead_;
        ++done;
        --alone_;
        observedClock = cycles_;
        if (!goesOn)
            pay();
        if (now() >= nextEvent_)
            timeModels();
    }
    evaluated_ += done;
    evaluatedAlone_ += done;
    return done;
}

// Brings the chip to the state that the camera has reached alone.
void SocModel::endAlone() {
    const uint64_t left = span_.pass(ahead_);
    const uint32_t pins = top_->core_pins_i; // the pins for the next clock
    ahead_ = 0;
    if (!left) {
        camera_.store();
    } else {
        // A tick of the baud rate has begun after the mark; the clocks since then are evaluated.
        if (camera_.storeMarked() != left)
            throw std::logic_error("the camera's state was not marked before the tick");
        for (uint64_t number = 0; number < left; ++number) {
            camera_.repeat(number);
            span_.rest(false);
            top_->tick_i = !top_->tick_i;
            top_->eval();
            span_.sample();
        }
    }
    top_->core_pins_i = pins;
    span_.replaced();
}

// Finds out what need not be evaluated in the next clocks.
void SocModel::look() {
    const QuietSpan::Clocks clocks = span_.look(mayBeQuiet());
    quiet_ = clocks.chip;
    resting_ = quiet_ ? 0 : clocks.platform;
    if (clocks.begins)
        camera_.load();
    if (!clocks.camera)
        return;
    if (!camera_.follows()) {
        span_.refuseCamera();
        return;
    }
    alone_ = clocks.camera;
    resting_ = 0;
    carry_ = 1;
    markAt_ = span_.untilCarry(carry_);
}

// Updates the design after a change of the processor pins between two clock edges.
void SocModel::settle() {
    wake();
    VSoc& top = *top_;
    const bool isStraight = wires_.isStraight();
    FsmcPins bent;
    if (!isStraight)
        bent = wires_.atChip(*far_);
    const FsmcPins& pins = isStraight ? *far_ : bent;
    const bool risesTwice = wires_.rings() && pins.nweN && !top.fsmc_nwe_n_i;
    top.fsmc_a_i = pins.a;
    top.fsmc_d_i = pins.d;
    top.fsmc_ne_n_i = pins.neN & 3;
    top.fsmc_nbl_n_i = pins.nblN;
    top.fsmc_noe_n_i = pins.noeN;
    top.fsmc_nwe_n_i = pins.nweN;
    top.fsmc_nadv_n_i = pins.nadvN;
    top.eval();
    for (unsigned level = 0; risesTwice && level < 2; ++level) {
        top.fsmc_nwe_n_i = level != 0;
        top.eval();
    }
    showOutputs();
}

// Copies the outputs of the chip to the pins that the processor reads.
void SocModel::showOutputs() {
    far_->dFromDesign = top_->fsmc_d_o;
    far_->dDriven = top_->fsmc_d_oe_o;
    far_->nwaitN = top_->fsmc_nwait_n_o;
    if (!wires_.isStraight())
        wires_.toProcessor(FsmcPins(*far_), *far_);
}

void SocModel::tick() {
    if (quiet_) {
        (void)passQuiet(cycles_ + 1);
        return;
    }
    if (alone_ && workAlone(1))
        return;
    if (!hasClock_) {
        standStill();
        return;
    }
    if (span_.stirs())
        resting_ = 0;
    if (!resting_)
        pay();
    if (isDriven())
        driveAt_ = drive_();
    if (resting_) {
        --resting_;
        ++rested_;
        evaluate(true);
        return;
    }
    evaluate();
    look();
}

// Passes the levels of the chip's outputs, except the outputs of the FSMC, to the modem and the
// processor.
void SocModel::passOutputs() {
    const bool isStraight = wires_.areOthersStraight();
    if (!isStraight)
        throughWires();
    auto level = [&](bool output, BoardWires::Line line) {
        return isStraight ? output : wires_.arrives(line);
    };
    const bool txd = level(top_->modem_txd_o, BoardWires::ModemTxd),
               resetN = level(top_->modem_reset_n_o, BoardWires::ModemReset),
               rtsN = level(top_->modem_rts_n_o, BoardWires::ModemRts),
               irq = level(top_->irq_o, BoardWires::Irq);
    if (txd != txd_ || resetN != resetN_ || rtsN != rtsN_)
        nextEvent_ = 0;
    if (txd != txd_)
        line_.setTxd(txd_ = txd, now());
    if (resetN != resetN_ || rtsN != rtsN_) {
        modem_.resetPin(!(resetN_ = resetN), now());
        line_.setRts(!(rtsN_ = rtsN), now());
    }
    if (irq != irq_) {
        irq_ = irq;
        if (irqEdge_)
            irqEdge_(irq_);
    }
}

void SocModel::evaluate(bool rests) {
    // The design has settled; now the memory pins get the values that they have after this clock.
    VSoc& top = *top_;
    sampleMcb(top, memory_);
    driveMcb(top, memory_);
    span_.rest(rests);
    ++cycles_;
    ++evaluated_;
#ifdef ICESOC_TRACE // a waveform contains both halves of a clock (sim_soc.v)
    for (unsigned half : {0u, 1u}) {
#else
    for (unsigned half : {0u}) {
#endif
        top.tick_i = !top.tick_i;
        top.eval();
        observer_.step(top, cycles_, half);
    }
    passOutputs();
    if (top.core_pins_o != corePins_) {
        corePins_ = top.core_pins_o;
        if (corePinsChanged_)
            corePinsChanged_(corePins_);
    }
    if (now() >= nextEvent_)
        timeModels();
    showOutputs();
    span_.sample();
}
