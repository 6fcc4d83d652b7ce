// SPDX-License-Identifier: MIT
//
// biquad_test: the core through its generated servant, with a memory that stalls: bit by bit as the
// model has it, and as a filter: a Butterworth low-pass against its formula.

#include "Vbiquad_slot.h"
#include "biquad_proxy.h"
#include "model/biquad_model.h"
#include "random.h"
#include <cmath>
extern "C" {
#include "biquad_regs.h"
}

namespace {

class BiquadCore : public ::testing::Test {
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
    std::vector<Ice_Short> samples(size_t count, Random& random) {
        std::vector<Ice_Short> list(count);
        for (auto& s : list)
            s = static_cast<Ice_Short>(random.next());
        return list;
    }
    std::vector<Ice_Short> filter(std::vector<Ice_Short> list) {
        Cores_BiquadSamples in{static_cast<Ice_Int>(list.size()), list.data()}, out{};
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

    BiquadProxy<Vbiquad_slot> core_;
    BiquadModel model_;
    int saturations_ = 0;
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
        // Of a gain of 1/(1 + a1 + a2) = 46 for what coefficients are off by, at most 2^-17.
        EXPECT_LT(difference, 20000 * 5 * 46.0 / 131072) << hertz << " Hz";
    }
}

TEST_F(BiquadCore, BuffersMayBeAnywhereInMemory) {
    Random random(testSeed());
    core_.memory_.setLinger(0.99); // full now and then
    set(0, {20000, -10000, 30000, 5000, -2000});
    for (int round = 0; round < 12; ++round) {
        core_.memoryAt_ = random.next() & ~1023u;
        core_.bus_.write(BIQUAD_MEMORY, core_.memoryAt_ >> 10);
        SCOPED_TRACE(core_.memoryAt_);
        expectFiltered(samples(256, random));
    }
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
    for (unsigned word = 0; word < 16; ++word)
        for (bool write : {false, true})
            EXPECT_EQ(core_.bus_.transfer(write, word, 0).error, word > BIQUAD_FILTER_OUT1) << word;
}

TEST_F(BiquadCore, RefusesNothingAtAllAndTooMuch) {
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

TEST_F(BiquadCore, WhatIsGivenUpLeavesTheMemoryPortInOrder) {
    Random random(testSeed());
    auto list = samples(64, random);
    for (int clocks = 1; clocks < 400; clocks += 23) {
        // By hand, as the servant does after a time-out: start, then reset the core.
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
    core_.memory_.setStall(0);
    auto clocksOf = [&](size_t count) {
        filter(std::vector<Ice_Short>(count, 1));
        uint64_t before = core_.bench_.cycles(); // once more, without the driver's copying
        core_.bus_.write(BIQUAD_CONTROL, 1u << 2);
        core_.bench_.waitFor([&] { return core_.bench_.top().irq_o; }, "the core's interrupt",
                             20000);
        core_.bus_.write(BIQUAD_EVENT, ~0u);
        return static_cast<double>(core_.bench_.cycles() - before);
    };
    for (size_t sections = 0; sections <= 4; ++sections) {
        if (sections)
            set(sections - 1, {65536, 0, 0, 0, 0});
        double perSample = (clocksOf(248) - clocksOf(56)) / 192;
        std::printf("%zu sections: %.2f clocks a sample\n", sections, perSample);
        EXPECT_NEAR(perSample, 7 + 7.0 * static_cast<double>(sections), 1.5);
    }
}

} // namespace
