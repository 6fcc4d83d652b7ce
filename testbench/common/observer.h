// SPDX-License-Identifier: MIT
//
// observer: what a Verilated model leaves behind in builds that are made for looking: a waveform
// (-DTRACE=ON; WAVE=file, WAVE_FROM and WAVE_TO in clocks) and coverage (-DCOVERAGE=ON;
// COVERAGE_DIR). In other builds it only keeps the clock.
//
// CDC_SEED, a number in the environment, makes the model's synchronisers uncertain
// (hdl/cdc/cdc_random.vh); the numbers drawn follow from it and from SEED. UNGATED, any value: the
// clocks of cores never stand still (hdl/system/core_gate.v).

#ifndef OBSERVER_H
#define OBSERVER_H

#include "observed_clock.h"
#include "random.h"
#include <cstdlib>
#include <memory>
#include <string>
#include <unistd.h>
#include <verilated.h>
#ifdef ICESOC_TRACE
#include <verilated_fst_c.h>
#endif
#ifdef ICESOC_COVERAGE
#include <verilated_cov.h>
#endif

template <class Module> class Observer {
public:
    // Prepares the recording; to be called before the model is made.
    explicit Observer(VerilatedContext& context) : context_(context) {
        const uint64_t seed = number("CDC_SEED", 0);
        const char* arguments[] = {"", std::getenv("UNGATED") ? "+ungated" : "", "+cdc_random"};
        context_.commandArgs(seed ? 3 : 2, arguments);
        context_.randSeed(static_cast<int>(Random(testSeed() * 1000 + seed).next() | 1));
#ifdef ICESOC_TRACE
        context_.traceEverOn(true);
        from_ = number("WAVE_FROM", 0);
        to_ = number("WAVE_TO", ~0ull);
        const char* name = std::getenv("WAVE");
        name_ = name ? name : "";
#endif
    }
    // Ends the recording; to be called before the model, which owns the counters, is destroyed.
    void finish() {
#ifdef ICESOC_TRACE
        if (wave_)
            wave_->close();
#endif
#ifdef ICESOC_COVERAGE
        static unsigned count = 0;
        if (const char* folder = std::getenv("COVERAGE_DIR"))
            context_.coveragep()->write((std::string(folder) + "/" + std::to_string(getpid()) +
                                         "-" + std::to_string(count++) + ".dat")
                                            .c_str());
#endif
    }

    // Records a half of a clock: `half` is 0 with the clock high, 1 with it low.
    void step(Module& top, uint64_t clock, unsigned half) {
        observedClock = clock;
#ifdef ICESOC_TRACE
        if (name_.empty() || clock < from_ || clock > to_)
            return;
        if (!wave_) { // a later model takes the file over: the test fails in its last one
            wave_.reset(new VerilatedFstC);
            top.trace(wave_.get(), 99);
            wave_->open(name_.c_str());
        }
        wave_->dump(2 * clock + half);
        if (clock == to_ && half == 1)
            wave_->flush();
#else
        (void)top;
        (void)half;
#endif
    }

private:
    static uint64_t number(const char* variable, uint64_t otherwise) {
        const char* text = std::getenv(variable);
        return text && *text ? std::strtoull(text, nullptr, 0) : otherwise;
    }

    VerilatedContext& context_;
#ifdef ICESOC_TRACE
    uint64_t from_ = 0, to_ = 0;
    std::string name_;
    std::unique_ptr<VerilatedFstC> wave_;
#endif
};

#endif
