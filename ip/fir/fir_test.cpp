// SPDX-License-Identifier: MIT
//
// fir_test: compares the core with the model. The core is called through its generated servant, and
// its memory stalls.

#include "Vfir_slot.h"
#include "core_slot.h"
#include "fir_proxy.h"
#include "fir_regs.h"
#include "model/fir_model.h"
#include "random.h"
#include "same.h"
#include <vector>

namespace {

class FirCore : public ::testing::Test {
protected:
    std::vector<Ice_Short> filter(std::vector<Ice_Short> list) {
        Cores_Samples in{static_cast<Ice_Int>(list.size()), list.data()}, out{};
        saturations_ = core_.filter(&in, &out);
        return {out.data, out.data + out.size};
    }
    void expectFiltered(const std::vector<Ice_Short>& list) {
        unsigned before = model_.saturations;
        std::vector<Ice_Short> want;
        for (Ice_Short s : list)
            want.push_back(model_.step(s));
        ASSERT_SAME(filter(list), want) << list.size() << " samples";
        EXPECT_EQ(saturations_, static_cast<int>(model_.saturations - before));
    }
    void set(unsigned shift, Random& random) {
        model_.shift = shift % 32;
        core_.setShift(static_cast<Ice_Byte>(shift));
        for (size_t k = 0; k < FirModel::taps; ++k) {
            model_.coefficients[k] = static_cast<int32_t>(random.below(262144)) - 131072;
            core_.setCoefficient(static_cast<Ice_Byte>(k), model_.coefficients[k]);
        }
    }

    FirProxy<Vfir_slot> core_;
    FirModel model_;
    int saturations_ = 0;
};

TEST_F(FirCore, EqualsTheModelAcrossSeveralCalls) {
    Random random(testSeed());
    for (int round = 0; round < 60; ++round) {
        if (round % 4 == 0)
            set(round < 8 ? 17 : random.below(256), random);
        if (round % 7 == 0) {
            core_.clear();
            model_.clear();
        }
        expectFiltered(random.items<Ice_Short>(1 + random.below(round % 2 ? 12 : 256)));
    }
    EXPECT_GT(model_.saturations, 0u);
}

TEST_F(FirCore, TheImpulseResponseEqualsTheCoefficients) {
    for (int k = 0; k < 16; ++k)
        core_.setCoefficient(static_cast<Ice_Byte>(k), 100 * k - 800);
    for (int k = 16; k < 256; ++k)
        // an index that does not exist has no effect
        core_.setCoefficient(static_cast<Ice_Byte>(k), 999);
    std::vector<Ice_Short> impulse(20, 0);
    impulse[0] = 1;
    auto answer = filter(impulse);
    for (int k = 0; k < 20; ++k)
        EXPECT_EQ(answer[static_cast<size_t>(k)], k < 16 ? 100 * k - 800 : 0) << k;
}

TEST_F(FirCore, BuffersMayBeAnywhereInMemory) {
    Random random(testSeed());
    core_.memory_.setLinger(0.95); // the FIFOs of the memory are sometimes full
    set(17, random);
    for (int round = 0; round < 12; ++round) {
        core_.memoryAt_ = random.next() & ~1023u;
        core_.bus_.write(FIR_MEMORY, core_.memoryAt_ >> 10);
        SCOPED_TRACE(core_.memoryAt_);
        expectFiltered(random.items<Ice_Short>(256));
    }
}

TEST_F(FirCore, EveryResultMaySaturate) {
    for (size_t k = 0; k < FirModel::taps; ++k) {
        model_.coefficients[k] = 131071;
        core_.setCoefficient(static_cast<Ice_Byte>(k), 131071);
    }
    expectFiltered(std::vector<Ice_Short>(256, 32767));
    EXPECT_EQ(saturations_, 256);
}

TEST_F(FirCore, AccessesAfterTheLastRegisterAreErrors) {
    for (unsigned word = 0; word < 16; ++word)
        for (bool write : {false, true})
            EXPECT_EQ(core_.bus_.transfer(write, word, 0).error, word > FIR_FILTER_OUT1) << word;
}

TEST_F(FirCore, RefusesEmptyAndTooLongBlocks) { // a block has at most 256 samples
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

TEST_F(FirCore, AnAbortedCallLeavesTheMemoryPortUsable) {
    Random random(testSeed());
    auto list = random.items<Ice_Short>(256);
    for (int clocks = 1; clocks < 190; clocks += 7) {
        // Starts the core and resets it later, as the servant does after a time-out.
        filter(list);
        core_.bus_.write(FIR_CONTROL, 1u << 3);
        for (int i = 0; i < clocks; ++i)
            core_.tick();
        core_.bus_.write(FIR_CONTROL, 1u << 31);
        core_.posted_ = 0;
        model_.clear();
        set(16, random);
        expectFiltered(random.items<Ice_Short>(50));
    }
}

TEST_F(FirCore, ACountWrittenAfterTheStartDoesNotChangeTheCall) {
    Random random(testSeed());
    const uint32_t results = 512; // byte offset of the results; the samples are in front of them
    for (int clocks = 10; clocks < 100; clocks += 7) {
        set(16, random);
        filter(random.items<Ice_Short>(256));
        core_.bus_.write(FIR_CONTROL, 1u << 3);
        for (int i = 0; i < clocks; ++i)
            core_.tick();
        // The next call must wait until the words that this call requested have arrived.
        core_.bus_.write(FIR_CONTROL, 1u << 31);
        core_.bus_.write(FIR_CONTROL, 1u << 3);
        core_.bus_.write(FIR_FILTER_IN0, 8);
        core_.bench_.waitFor([&] { return core_.bench_.top().irq_o; }, "the core's interrupt",
                             20000);
        core_.bus_.write(FIR_EVENT, ~0u);
        core_.posted_ = 0;
        // all results are 0, because the reset has cleared the coefficients
        for (uint32_t i = 0; i < 512; ++i)
            ASSERT_EQ(core_.memory_.byte(core_.memoryAt_ + results + i), 0) << i;
    }
}

TEST_F(FirCore, ProcessesOneSamplePerClockIfTheMemoryKeepsUp) {
    core_.memory_.setStall(0);
    // Starts the core again on data that is already in memory, so copying is not counted. The
    // difference between a long and a short block leaves only the time per sample.
    auto clocksOf = [&](size_t count) {
        filter(std::vector<Ice_Short>(count, 1));
        uint64_t before = core_.bench_.cycles();
        core_.bus_.write(FIR_CONTROL, 1u << 3); // again
        core_.bench_.waitFor([&] { return core_.bench_.top().irq_o; }, "the core's interrupt",
                             20000);
        core_.bus_.write(FIR_EVENT, ~0u);
        return static_cast<double>(core_.bench_.cycles() - before);
    };
    double perSample = (clocksOf(248) - clocksOf(56)) / 192;
    std::printf("%.4f clocks a sample\n", perSample);
    EXPECT_LE(perSample, 1.001);
}

} // namespace
