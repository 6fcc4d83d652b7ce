// SPDX-License-Identifier: MIT
//
// fir_test: the generated servant filters buffers in a memory that stalls; the model says what must
// be there.

#include "VFir.h"
#include "core_slot.h"
#include "fir_model.h"
#include "npi_memory.h"
extern "C" {
#include "fir_regs.h"
#include "fir_servant.h"
}

namespace {

constexpr Ice_Int source = 0x4000, target = 0x10000;

class FirCore : public ::testing::Test {
protected:
    FirCore() {
        EXPECT_EQ(Cores_Fir_Core_init(&core_, coreSlot, &slot_.seam, &slot_), HW_OK);
        slot_.core_ = &core_.core;
    }
    void set(unsigned shift, Random& random) {
        model_.shift = shift;
        EXPECT_EQ(Cores_Fir_setShift(&core_.servant, static_cast<Ice_Byte>(shift), nullptr),
                  ICE_OK);
        for (size_t k = 0; k < FirModel::taps; ++k) {
            model_.coefficients[k] = static_cast<int32_t>(random.below(262144)) - 131072;
            EXPECT_EQ(Cores_Fir_setCoefficient(&core_.servant, static_cast<Ice_Byte>(k),
                                               model_.coefficients[k], nullptr),
                      ICE_OK);
        }
    }
    void setHalf(uint32_t at, int16_t value) {
        memory_.setByte(at, static_cast<uint8_t>(value));
        memory_.setByte(at + 1, static_cast<uint8_t>(value >> 8));
    }
    int16_t half(uint32_t at) const {
        return static_cast<int16_t>(memory_.byte(at) | memory_.byte(at + 1) << 8);
    }
    Ice_Status filter(Ice_Int count, Ice_Int from = source, Ice_Int to = target) {
        return Cores_Fir_filter(&core_.servant, from, to, count, &result_, nullptr);
    }
    std::vector<int16_t> samples(size_t count, Random& random) {
        std::vector<int16_t> list(count);
        for (size_t i = 0; i < count; ++i) {
            list[i] = static_cast<int16_t>(random.next());
            setHalf(static_cast<uint32_t>(source + 2 * i), list[i]);
        }
        return list;
    }
    void expectFiltered(const std::vector<int16_t>& list, uint32_t at = target) {
        unsigned before = model_.saturations;
        for (size_t i = 0; i < list.size(); ++i)
            ASSERT_EQ(half(static_cast<uint32_t>(at + 2 * i)), model_.step(list[i]))
                << i << " of " << list.size();
        EXPECT_EQ(static_cast<unsigned>(result_), model_.saturations - before);
    }

    CoreSlot<VFir> slot_;
    NpiMemory<VFir> memory_{slot_.bench_, 0.2, testSeed()};
    Cores_Fir_Core core_{};
    FirModel model_;
    Ice_Int result_ = 0;
};

TEST_F(FirCore, EqualsTheModelAndGoesOnFromBufferToBuffer) {
    Random random(testSeed());
    for (int round = 0; round < 40; ++round) {
        if (round % 4 == 0)
            set(round < 8 ? 17 : random.below(32), random);
        if (round % 7 == 0) {
            ASSERT_EQ(Cores_Fir_clear(&core_.servant, nullptr), ICE_OK);
            model_.clear();
        }
        auto list = samples(1 + random.below(round % 2 ? 12 : 300), random);
        int16_t behind = static_cast<int16_t>(random.next());
        setHalf(static_cast<uint32_t>(target + 2 * list.size()), behind);
        ASSERT_EQ(filter(static_cast<Ice_Int>(list.size())), ICE_OK);
        expectFiltered(list);
        EXPECT_EQ(half(static_cast<uint32_t>(target + 2 * list.size())), behind)
            << "not behind the last";
    }
    EXPECT_GT(model_.saturations, 0u);
}

TEST_F(FirCore, FiltersInPlace) {
    Random random(testSeed());
    set(18, random);
    auto list = samples(1000, random);
    ASSERT_EQ(filter(1000, source, source), ICE_OK);
    expectFiltered(list, source);
}

TEST_F(FirCore, TheAnswerToAnImpulseIsTheCoefficients) {
    for (int k = 0; k < 16; ++k)
        ASSERT_EQ(Cores_Fir_setCoefficient(&core_.servant, static_cast<Ice_Byte>(k), 100 * k - 800,
                                           nullptr),
                  ICE_OK);
    ASSERT_EQ(Cores_Fir_setCoefficient(&core_.servant, 16, 999, nullptr), ICE_OK)
        << "there is none, and none changes";
    for (uint32_t i = 0; i < 20; ++i)
        setHalf(static_cast<uint32_t>(source) + 2 * i, i == 0);
    ASSERT_EQ(filter(20), ICE_OK);
    for (int k = 0; k < 20; ++k)
        EXPECT_EQ(half(static_cast<uint32_t>(target + 2 * k)), k < 16 ? 100 * k - 800 : 0);
}

TEST_F(FirCore, RefusesWhatItCannotFilter) {
    EXPECT_EQ(filter(0), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(filter(-1), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(filter(1 << 24), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(filter(4, source + 8, target), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(filter(4, source, target + 32), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(filter(4), ICE_OK);
}

TEST_F(FirCore, ABufferThatIsGivenUpLeavesTheMemoryPortInOrder) {
    Random random(testSeed());
    for (int clocks = 1; clocks < 90; clocks += 7) {
        // By hand, as the servant does after a time-out: start, then reset the core.
        slot_.bus_.write(FIR_FILTER_IN0, source);
        slot_.bus_.write(FIR_FILTER_IN1, target);
        slot_.bus_.write(FIR_FILTER_IN2, 500);
        slot_.bus_.write(FIR_CONTROL, 1u << 3);
        for (int i = 0; i < clocks; ++i)
            slot_.tick();
        slot_.bus_.write(FIR_CONTROL, 1u << 31);
        slot_.posted_ = 0;
        model_.clear();
        set(16, random);
        auto list = samples(50, random);
        ASSERT_EQ(filter(50), ICE_OK);
        expectFiltered(list);
    }
}

TEST_F(FirCore, OneSampleAClockWhenTheMemoryKeepsUp) {
    memory_.setStall(0);
    auto clocksOf = [&](Ice_Int count) {
        uint64_t before = slot_.bench_.cycles();
        EXPECT_EQ(filter(count), ICE_OK);
        return static_cast<double>(slot_.bench_.cycles() - before);
    };
    double perSample = (clocksOf(9000) - clocksOf(1000)) / 8000;
    std::printf("%.4f clocks a sample\n", perSample);
    EXPECT_LE(perSample, 1.001);
}

} // namespace
