// SPDX-License-Identifier: MIT
//
// memory_bench: a memory controller with PORTS requesters in front and a memory model behind.
//
// A back-end is a memory model with its pins: sample() before the clock's edge, drive() after it.

#ifndef MEMORY_BENCH_H
#define MEMORY_BENCH_H

#include "bench.h"
#include "litedram_pins.h"
#include "mcb_pins.h"
#include "npi_requester.h"
#include <algorithm>

struct McbBackend {
    McbModel model;
    explicit McbBackend(size_t bytes) : model(bytes) {}
    template <class Module> void sample(Module& top) { sampleMcb(top, model); }
    template <class Module> void drive(Module& top) { driveMcb(top, model); }
    uint8_t* data() { return model.data(); }
};

struct LitedramBackend {
    LitedramModel model;
    explicit LitedramBackend(size_t bytes) : model(bytes) {}
    template <class Module> void sample(Module& top) { sampleLitedram(top, model); }
    template <class Module> void drive(Module& top) { driveLitedram(top, model); }
    uint8_t* data() { return model.data(); }
};

template <class Module, class Backend, unsigned ports, size_t bytes = 1 << 20> class MemoryBench {
public:
    explicit MemoryBench(uint64_t seed)
        : backend(bytes), requesters(bench.top(), ports, bytes, seed) {
        bench.addModel([this] { settle(); },
                       [this] {
                           backend.drive(bench.top());
                           requesters.drive();
                       });
        backend.drive(bench.top());
        Random random(seed);
        for (size_t i = 0; i < bytes && i < 1 << 20; ++i)
            backend.data()[i] = requesters.reference()[i] = static_cast<uint8_t>(random.next());
        bench.reset();
    }

    static constexpr size_t size = bytes;
    void run(uint64_t cycles) {
        for (uint64_t i = 0; i < cycles; ++i)
            bench.tick();
    }
    // Lets what is under way end; the memory must then equal the reference.
    void drain() {
        requesters.stop();
        bench.waitFor([this] { return requesters.idle(); }, "the requesters' end", 20000);
        run(500); // posted writes
        const uint8_t *is = backend.data(), *wanted = requesters.reference().data();
        if (std::memcmp(is, wanted, bytes) != 0)
            throw std::runtime_error(
                "the memory differs from the reference at address " +
                std::to_string(std::mismatch(is, is + bytes, wanted).first - is));
        requesters.go();
    }

    Bench<Module> bench;
    Backend backend;
    NpiRequesters<Module> requesters;

private:
    void settle() {
        requesters.pops();
        bench.top().eval();
        requesters.sample();
        backend.sample(bench.top());
    }
};

#endif
