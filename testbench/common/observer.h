// SPDX-License-Identifier: MIT
//
// observer: records a Verilated model in special builds. It writes a waveform with -DTRACE=ON (file
// WAVE, from clock WAVE_FROM to WAVE_TO), and coverage data with -DCOVERAGE=ON (folder
// COVERAGE_DIR). In other builds it only counts the clock cycles.
//
// If the environment variable CDC_SEED contains a number, the model's synchronisers get random
// delays (hdl/cdc/cdc_random.vh). The delays depend only on CDC_SEED and SEED.

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
    // Prepares the recording. Call this before the model is created.
    explicit Observer(VerilatedContext& context) : context_(context) {
        const uint64_t seed = environmentNumber("CDC_SEED", 0);
        const char* arguments[] = {"", "+cdc_random"};
        context_.commandArgs(seed ? 2 : 1, arguments);
        context_.randSeed(static_cast<int>(Random(testSeed() * 1000 + seed).next() | 1));
#ifdef ICESOC_TRACE
        context_.traceEverOn(true);
#endif
    }
    // Ends the recording. Call this before the model is destroyed, because the coverage counters
    // are part of the model.
    void finish() {
#ifdef ICESOC_TRACE
        if (wave_)
            wave_->close();
#endif
#ifdef ICESOC_COVERAGE
        if (const char* folder = std::getenv("COVERAGE_DIR")) {
            std::string file = std::string(folder) + "/XXXXXX.dat";
            // mkstemps makes a unique name; a process id would not be unique, since ids repeat in a
            // long run
            close(mkstemps(file.data(), 4));
            context_.coveragep()->write(file.c_str());
        }
#endif
    }

    // Records half a clock: `half` is 0 while the clock is high, 1 while it is low.
    void step(Module& top, uint64_t clock, unsigned half) {
        observedClock = clock;
#ifdef ICESOC_TRACE
        if (window_.file.empty() || clock < window_.from || clock > window_.to)
            return;
        // Each model of a test overwrites the file. After a failure, the file therefore shows the
        // model in which the test failed.
        if (!wave_) {
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
