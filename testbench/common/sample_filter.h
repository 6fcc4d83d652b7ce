// SPDX-License-Identifier: MIT
//
// sample_filter: a core that filters lists of 16-bit samples through its memory port, beside its
// model, which computes the expected results.

#ifndef SAMPLE_FILTER_H
#define SAMPLE_FILTER_H

#include "core_slot.h"
#include "random.h"
#include <vector>

// Proxy: the generated one, with filter(in, out); Samples: its Slice sequence<short>; Model:
// step(sample), saturations.
template <class Proxy, class Samples, class Model> class SampleFilter : public ::testing::Test {
protected:
    std::vector<Ice_Short> samples(size_t count, Random& random) {
        std::vector<Ice_Short> list(count);
        for (auto& s : list)
            s = static_cast<Ice_Short>(random.next());
        return list;
    }
    std::vector<Ice_Short> filter(std::vector<Ice_Short> list) {
        Samples in{static_cast<Ice_Int>(list.size()), list.data()}, out{};
        saturations_ = core_.filter(&in, &out);
        return {out.data, out.data + out.size};
    }
    void expectFiltered(const std::vector<Ice_Short>& list) {
        unsigned before = model_.saturations;
        std::vector<Ice_Short> want;
        for (Ice_Short s : list)
            want.push_back(model_.step(s));
        ASSERT_EQ(filter(list), want) << list.size() << " samples";
        EXPECT_EQ(saturations_, static_cast<int>(model_.saturations - before));
    }
    // The core's blocks are of 256 samples at most.
    void expectLimits() {
        auto statusOf = [&](size_t count) {
            try {
                filter(std::vector<Ice_Short>(count));
                return ICE_OK;
            } catch (const CoreError& e) {
                return e.status();
            }
        };
        EXPECT_EQ(statusOf(0), ICE_UNKNOWN_EXCEPTION);
        EXPECT_EQ(statusOf(257), ICE_LIMIT);
        EXPECT_EQ(statusOf(256), ICE_OK);
    }
    void expectNoWordBehind(unsigned last) {
        for (unsigned word = 0; word < 16; ++word)
            for (bool write : {false, true})
                EXPECT_EQ(core_.bus_.transfer(write, word, 0).error, word > last) << word;
    }
    // `memory`: the register with the address of the buffers.
    void expectBuffersAnywhere(unsigned memory, Random& random) {
        for (int round = 0; round < 12; ++round) {
            core_.memoryAt_ = random.next() & ~1023u;
            core_.bus_.write(memory, core_.memoryAt_ >> 10);
            SCOPED_TRACE(core_.memoryAt_);
            expectFiltered(samples(256, random));
        }
    }
    // Clocks that one more sample costs: a long block against a short one, without the driver's
    // copying, when the memory keeps up. `control`, `start`, `event`: the operation's registers and
    // bit.
    double clocksOfASample(unsigned control, U32 start, unsigned event) {
        core_.memory_.setStall(0);
        auto clocksOf = [&](size_t count) {
            filter(std::vector<Ice_Short>(count, 1));
            uint64_t before = core_.bench_.cycles();
            core_.bus_.write(control, start); // once more
            core_.bench_.waitFor([&] { return core_.bench_.top().irq_o; }, "the core's interrupt",
                                 20000);
            core_.bus_.write(event, ~0u);
            return static_cast<double>(core_.bench_.cycles() - before);
        };
        return (clocksOf(248) - clocksOf(56)) / 192;
    }

    Proxy core_;
    Model model_;
    int saturations_ = 0;
};

#endif
