// SPDX-License-Identifier: MIT
//
// fir_test: the core through its generated servant, with a memory that stalls, against the model.

#include "Vfir_slot.h"
#include "fir_proxy.h"
#include "model/fir_model.h"
#include "sample_filter.h"
extern "C" {
#include "fir_regs.h"
}

namespace {

class FirCore : public SampleFilter<FirProxy<Vfir_slot>, Cores_Samples, FirModel> {
protected:
    void set(unsigned shift, Random& random) {
        model_.shift = shift % 32;
        core_.setShift(static_cast<Ice_Byte>(shift));
        for (size_t k = 0; k < FirModel::taps; ++k) {
            model_.coefficients[k] = static_cast<int32_t>(random.below(262144)) - 131072;
            core_.setCoefficient(static_cast<Ice_Byte>(k), model_.coefficients[k]);
        }
    }
};

TEST_F(FirCore, EqualsTheModelAndGoesOnFromCallToCall) {
    Random random(testSeed());
    for (int round = 0; round < 60; ++round) {
        if (round % 4 == 0)
            set(round < 8 ? 17 : random.below(256), random);
        if (round % 7 == 0) {
            core_.clear();
            model_.clear();
        }
        expectFiltered(samples(1 + random.below(round % 2 ? 12 : 256), random));
    }
    EXPECT_GT(model_.saturations, 0u);
}

TEST_F(FirCore, TheAnswerToAnImpulseIsTheCoefficients) {
    for (int k = 0; k < 16; ++k)
        core_.setCoefficient(static_cast<Ice_Byte>(k), 100 * k - 800);
    for (int k = 16; k < 256; ++k)
        core_.setCoefficient(static_cast<Ice_Byte>(k), 999); // an invalid index has no effect
    std::vector<Ice_Short> impulse(20, 0);
    impulse[0] = 1;
    auto answer = filter(impulse);
    for (int k = 0; k < 20; ++k)
        EXPECT_EQ(answer[static_cast<size_t>(k)], k < 16 ? 100 * k - 800 : 0) << k;
}

TEST_F(FirCore, BuffersMayBeAnywhereInMemory) {
    Random random(testSeed());
    core_.memory_.setLinger(0.95); // full now and then
    set(17, random);
    expectBuffersAnywhere(FIR_MEMORY, random);
}

TEST_F(FirCore, EveryResultMayBeTooLarge) {
    for (size_t k = 0; k < FirModel::taps; ++k) {
        model_.coefficients[k] = 131071;
        core_.setCoefficient(static_cast<Ice_Byte>(k), 131071);
    }
    expectFiltered(std::vector<Ice_Short>(256, 32767));
    EXPECT_EQ(saturations_, 256);
}

TEST_F(FirCore, HasNoWordBehindItsResults) {
    expectNoWordBehind(FIR_FILTER_OUT1);
}

TEST_F(FirCore, RefusesNothingAtAllAndTooMuch) {
    expectLimits();
}

TEST_F(FirCore, WhatIsGivenUpLeavesTheMemoryPortInOrder) {
    Random random(testSeed());
    auto list = samples(256, random);
    for (int clocks = 1; clocks < 190; clocks += 7) {
        // The steps of the servant after a time-out: start, then reset the core.
        filter(list);
        core_.bus_.write(FIR_CONTROL, 1u << 3);
        for (int i = 0; i < clocks; ++i)
            core_.tick();
        core_.bus_.write(FIR_CONTROL, 1u << 31);
        core_.posted_ = 0;
        model_.clear();
        set(16, random);
        expectFiltered(samples(50, random));
    }
}

TEST_F(FirCore, OneSampleAClockWhenTheMemoryKeepsUp) {
    double perSample = clocksOfASample(FIR_CONTROL, 1u << 3, FIR_EVENT);
    std::printf("%.4f clocks a sample\n", perSample);
    EXPECT_LE(perSample, 1.001);
}

} // namespace
