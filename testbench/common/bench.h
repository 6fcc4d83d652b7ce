// SPDX-License-Identifier: MIT
//
// bench: provides clock, reset and bounded waits for a Verilated module with clk_i and rst_i.
//
// Read outputs before you call tick() and set inputs after it; when tick() returns, the outputs are
// stable.

#pragma once

#include "observer.h"
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>
#include <verilated.h>

template <class Module> class Bench {
public:
    Bench()
        : context_(new VerilatedContext), observer_(*context_), top_(new Module(context_.get())) {}
    ~Bench() {
        // The destructor of a Verilated module removes the module's scopes from the context of the
        // current thread. That context may belong to a bench that no longer exists, so this bench
        // first makes its own context the thread's context.
        Verilated::threadContextp(context_.get());
        top_->final();
        observer_.finish();
    }
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;

    Module& top() { return *top_; }
    uint64_t cycles() const { return cycles_; }

    // Adds a synchronous model. `sample` reads the stable ports before each rising edge; `drive`
    // sets inputs after it, as registers would.
    void addModel(std::function<void()> sample, std::function<void()> drive) {
        models_.emplace_back(std::move(sample), std::move(drive));
    }

    // Adds a clock that is independent of clk_i. `half` is called twice per cycle, between the
    // edges of clk_i.
    void addClock(std::function<void()> half) { half_ = std::move(half); }

    // Runs one clock cycle: settles the module, samples with the models, raises the clock, drives
    // with the models, lowers the clock, and settles the module again.
    void tick() {
        top_->eval();
        for (auto& model : models_)
            model.first();
        top_->clk_i = 1;
        top_->eval();
        for (auto& model : models_)
            model.second();
        observer_.step(*top_, cycles_, 0);
        if (half_)
            half_();
        top_->clk_i = 0;
        top_->eval();
        observer_.step(*top_, cycles_, 1);
        if (half_)
            half_();
        ++cycles_;
    }

    void tick(uint64_t cycles) {
        while (cycles--)
            tick();
    }

    void reset(unsigned cycles = 4) {
        top_->rst_i = 1;
        tick(cycles);
        top_->rst_i = 0;
        top_->eval();
    }

    // Runs clocks until the condition holds. Throws after `limit` cycles; the message contains
    // `what`.
    template <class Condition>
    void waitFor(Condition condition, const std::string& what, uint64_t limit = 10000) {
        for (uint64_t i = 0; i < limit; ++i) {
            top_->eval();
            if (condition())
                return;
            tick();
        }
        throw std::runtime_error("waited " + std::to_string(limit) + " cycles for " + what);
    }

private:
    std::unique_ptr<VerilatedContext> context_;
    Observer<Module> observer_;
    std::unique_ptr<Module> top_;
    std::vector<std::pair<std::function<void()>, std::function<void()>>> models_;
    std::function<void()> half_;
    uint64_t cycles_ = 0;
};
