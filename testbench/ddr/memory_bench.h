// SPDX-License-Identifier: MIT
//
// memory_bench: connects a memory controller to the MCB model as its memory, and one requester to
// each of the controller's PORTS ports.

#pragma once

#include "bench.h"
#include "mcb_model.h"
#include "npi_requester.h"
#include <algorithm>

template <class Module, unsigned ports, size_t bytes = 1 << 20> class MemoryBench {
public:
    explicit MemoryBench(uint64_t seed)
        : memory(bytes), requesters(bench.top(), ports, bytes, seed) {
        bench.addModel([this] { settle(); },
                       [this] {
                           driveMcb(bench.top(), memory);
                           requesters.drive();
                       });
        driveMcb(bench.top(), memory);
        Random random(seed);
        for (size_t i = 0; i < bytes && i < 1 << 20; ++i)
            memory.data()[i] = requesters.reference()[i] = static_cast<uint8_t>(random.next());
        bench.reset();
    }

    static constexpr size_t size = bytes;
    void run(uint64_t cycles) {
        for (uint64_t i = 0; i < cycles; ++i)
            bench.tick();
    }
    // Waits until all requests have ended, then checks that the memory equals the reference.
    void drain() {
        requesters.stop();
        bench.waitFor([this] { return requesters.idle(); }, "the requesters' end", 20000);
        run(500); // posted writes
        const uint8_t *is = memory.data(), *wanted = requesters.reference().data();
        if (std::memcmp(is, wanted, bytes) != 0)
            throw std::runtime_error(
                "the memory differs from the reference at address " +
                std::to_string(std::mismatch(is, is + bytes, wanted).first - is));
        requesters.go();
    }

    Bench<Module> bench;
    McbModel memory;
    NpiRequesters<Module> requesters;

private:
    void settle() {
        requesters.pops();
        bench.top().eval();
        requesters.sample();
        sampleMcb(bench.top(), memory);
    }
};
