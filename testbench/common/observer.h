// SPDX-License-Identifier: MIT
//
// observer: records a Verilated model in special builds: a waveform (-DTRACE=ON; WAVE=file,
// WAVE_FROM and WAVE_TO in clocks) and coverage (-DCOVERAGE=ON; COVERAGE_DIR). In other builds it
// only keeps the clock.
//
// CDC_SEED, a number in the environment, makes the model's synchronisers uncertain
// (hdl/cdc/cdc_random.vh); the draws follow from it and from SEED.

#pragma once

#include "random.h"
#include "tell_on_abort.h"
#include "wave_window.h"
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
    // Prepares the recording; call it before the model is made.
    explicit Observer(VerilatedContext& context) : context_(context) {
        const uint64_t seed = environmentNumber("CDC_SEED", 0);
        const char* arguments[] = {"", "+cdc_random"};
        context_.commandArgs(seed ? 2 : 1, arguments);
        context_.randSeed(static_cast<int>(Random(testSeed() * 1000 + seed).next() | 1));
#ifdef ICESOC_TRACE
        context_.traceEverOn(true);
#endif
    }
    // Ends the recording; call it before the model, which owns the counters, is destroyed.
    void finish() {
#ifdef ICESOC_TRACE
        if (wave_)
            wave_->close();
#endif
#ifdef ICESOC_COVERAGE
        if (const char* folder = std::getenv("COVERAGE_DIR")) {
            std::string file = std::string(folder) + "/XXXXXX.dat";
            close(mkstemps(file.data(), 4)); // process ids are reused in a long run
            context_.coveragep()->write(file.c_str());
        }
#endif
    }

    // Records a half of a clock: `half` is 0 with the clock high, 1 with it low.
    void step(Module& top, uint64_t clock, unsigned half) {
        observedClock = clock;
#ifdef ICESOC_TRACE
        if (window_.file.empty() || clock < window_.from || clock > window_.to)
            return;
        if (!wave_) { // a later model takes the file over, since a test fails in its last one
            wave_.reset(new VerilatedFstC);
            top.trace(wave_.get(), 99);
            wave_->open(window_.file.c_str());
        }
        wave_->dump(2 * clock + half);
        if (clock == window_.to && half == 1)
            wave_->flush();
#else
        (void)top;
        (void)half;
#endif
    }

private:
    VerilatedContext& context_;
#ifdef ICESOC_TRACE
    const WaveWindow window_;
    std::unique_ptr<VerilatedFstC> wave_;
#endif
};
