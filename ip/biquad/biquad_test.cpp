// SPDX-License-Identifier: MIT
//
// biquad_test: the core through its generated servant, with a memory that stalls: bit by bit as the
// model has it, and as a filter: a Butterworth low-pass against its formula.

#include "Vbiquad_slot.h"
#include "biquad_proxy.h"
#include "model/biquad_model.h"
#include "sample_filter.h"
#include <cmath>
extern "C" {
#include "biquad_regs.h"
}

namespace {

class BiquadCore
    : public SampleFilter<BiquadProxy<Vbiquad_slot>, Cores_BiquadSamples, BiquadModel> {
protected:
    void set(size_t section, const std::array<int32_t, 5>& coefficients) {
        model_.cascade[section].isUsed = true;
        model_.cascade[section].coefficients = coefficients;
        for (size_t k = 0; k < 5; ++k)
            core_.setCoefficient(static_cast<Ice_Byte>(8 * section + k), coefficients[k]);
    }
    void clear() {
        core_.clear();
        model_.clear();
    }
};

TEST_F(BiquadCore, EqualsTheModelAndGoesOnFromCallToCall) {
    Random random(testSeed());
    expectFiltered(samples(9, random)); // no section is in use yet
    for (int round = 0; round < 40; ++round) {
        if (round % 3 == 0) {
            std::array<int32_t, 5> c;
            // Small feedback now and then, so that not all of it is saturated.
            for (auto& value : c)
                value = round % 2 ? static_cast<int32_t>(random.below(262144)) - 131072
                                  : static_cast<int32_t>(random.below(40000)) - 20000;
            set(round < 12 ? 3u - static_cast<unsigned>(round) / 3 : random.below(4), c);
        }
        if (round % 5 == 0)
            clear();
        expectFiltered(samples(1 + random.below(round % 2 ? 12 : 100), random));
    }
    EXPECT_GT(model_.saturations, 0u);
}

TEST_F(BiquadCore, IsAButterworthLowPass) {
    // R. Bristow-Johnson, Audio EQ Cookbook, LPF: fs = 8 kHz, f0 = 200 Hz, Q = 1 / sqrt(2).
    const double pi = std::acos(-1.0), w0 = 2 * pi * 200 / 8000,
                 alpha = std::sin(w0) / std::sqrt(2.0);
    const double a0 = 1 + alpha, b[3] = {(1 - std::cos(w0)) / 2 / a0, (1 - std::cos(w0)) / a0,
                                         (1 - std::cos(w0)) / 2 / a0};
    const double a[2] = {-2 * std::cos(w0) / a0, (1 - alpha) / a0};
    auto fixed = [](double value) { return static_cast<int32_t>(std::lround(value * 65536)); };
    set(0, {fixed(b[0]), fixed(b[1]), fixed(b[2]), fixed(a[0]), fixed(a[1])});
    for (auto [hertz, gain] : {std::pair{20.0, 1.0}, {200.0, std::sqrt(0.5)}, {1000.0, 0.0377}}) {
        clear();
        double most = 0, x1 = 0, x2 = 0, y1 = 0, y2 = 0, difference = 0;
        for (int block = 0; block < 5; ++block) {
            std::vector<Ice_Short> list(200);
            for (int i = 0; i < 200; ++i)
                list[static_cast<size_t>(i)] = static_cast<Ice_Short>(
                    std::lround(20000 * std::sin(2 * pi * hertz * (200 * block + i) / 8000)));
            auto answer = filter(list);
            for (size_t i = 0; i < 200; ++i) {
                double y = b[0] * list[i] + b[1] * x1 + b[2] * x2 - a[0] * y1 - a[1] * y2;
                x2 = x1, x1 = list[i], y2 = y1, y1 = y;
                difference = std::max(difference, std::abs(answer[i] - y));
                if (block >= 3) // settled; 400 samples are a whole period of each
                    most = std::max(most, std::abs(static_cast<double>(answer[i])));
            }
        }
        EXPECT_NEAR(most / 20000, gain, 0.01) << hertz << " Hz";
        // The coefficients are off by 2^-17 at most, times a gain of 1/(1 + a1 + a2) = 46.
        EXPECT_LT(difference, 20000 * 5 * 46.0 / 131072) << hertz << " Hz";
    }
}

TEST_F(BiquadCore, BuffersMayBeAnywhereInMemory) {
    Random random(testSeed());
    core_.memory_.setLinger(0.99); // full now and then
    set(0, {20000, -10000, 30000, 5000, -2000});
    expectBuffersAnywhere(BIQUAD_MEMORY, random);
}

TEST_F(BiquadCore, WhatIsNoCoefficientChangesNone) {
    Random random(testSeed());
    set(0, {20000, -10000, 30000, 5000, -2000});
    for (unsigned k = 0; k < 256; ++k)
        if (k >= 32 || k % 8 > 4)
            core_.setCoefficient(static_cast<Ice_Byte>(k), 999);
    expectFiltered(samples(50, random));
}

TEST_F(BiquadCore, EveryResultOfEverySectionMayBeTooLarge) {
    for (size_t section = 0; section < BiquadModel::sections; ++section)
        set(section, {131071, 131071, 131071, -131072, 0});
    expectFiltered(std::vector<Ice_Short>(256, 32767)); // until all are at their limit
    expectFiltered(std::vector<Ice_Short>(256, 32767));
    EXPECT_EQ(saturations_, 4 * 256);
}

TEST_F(BiquadCore, HasNoWordBehindItsResults) {
    expectNoWordBehind(BIQUAD_FILTER_OUT1);
}

TEST_F(BiquadCore, RefusesNothingAtAllAndTooMuch) {
    expectLimits();
}

TEST_F(BiquadCore, WhatIsGivenUpLeavesTheMemoryPortInOrder) {
    Random random(testSeed());
    auto list = samples(64, random);
    for (int clocks = 1; clocks < 400; clocks += 23) {
        // The steps of the servant after a time-out: start, then reset the core.
        set(1, {30000, 20000, 10000, 5000, 2500}); // until the reset
        filter(list);
        core_.bus_.write(BIQUAD_CONTROL, 1u << 2);
        for (int i = 0; i < clocks; ++i)
            core_.tick();
        core_.bus_.write(BIQUAD_CONTROL, 1u << 31);
        core_.posted_ = 0;
        model_ = BiquadModel();
        set(2, {65536, -3000, 500, 20000, -9000});
        expectFiltered(samples(10, random));
    }
}

TEST_F(BiquadCore, EightClocksASection) {
    for (size_t sections = 0; sections <= 4; ++sections) {
        if (sections)
            set(sections - 1, {65536, 0, 0, 0, 0});
        double perSample = clocksOfASample(BIQUAD_CONTROL, 1u << 2, BIQUAD_EVENT);
        std::printf("%zu sections: %.2f clocks a sample\n", sections, perSample);
        EXPECT_NEAR(perSample, 7 + 7.0 * static_cast<double>(sections), 1.5);
    }
}

} // namespace
