// SPDX-License-Identifier: MIT
//
// scaler_test: tests sequences in DDR3, exceptions, calls that end later, and events. It also tests
// the generated proxy, which drives the pins of a wrapper.

#include "VScalerSlot.h"
#include "VScalerWrapper.h"
#include "VStoreWrapper.h"
#include "random.h"
#include "scaler_proxy.h"
#include "store_proxy.h"

namespace {

class Scaler : public ::testing::Test {
protected:
    int shift(std::vector<Ice_Short> values, int offset) {
        Demo_Samples list{static_cast<Ice_Int>(values.size()), values.data()}, shifted{};
        int sum = core_.shift(&list, static_cast<Ice_Short>(offset), &shifted);
        shifted_.assign(shifted.data, shifted.data + shifted.size);
        return sum;
    }
    ScalerProxy<VScalerSlot> core_;
    std::vector<Ice_Short> shifted_;
};

TEST_F(Scaler, SequencesOfEveryLengthPassThroughMemory) {
    Random random(testSeed());
    for (unsigned size : {1u, 2u, 3u, 4u, 5u, 31u, 32u, 33u, 99u, 100u}) {
        std::vector<Ice_Short> values(size), expected(size);
        int sum = 0, offset = static_cast<int>(random.below(100)) - 50;
        for (unsigned i = 0; i < size; ++i) {
            values[i] = static_cast<Ice_Short>(static_cast<int>(random.below(60000)) - 30000);
            expected[i] = static_cast<Ice_Short>(values[i] + offset);
            sum += expected[i];
        }
        EXPECT_EQ(shift(values, offset), sum) << size << " elements";
        EXPECT_SAME(shifted_, expected);
    }
}

TEST_F(Scaler, MisalignedBuffersAreRefused) {
    Demo_Scaler_Core other;
    for (U32 past : {128u, 256u, 384u})
        EXPECT_EQ(Demo_Scaler_Core_init(&other, coreSlot, coreMemory + past, &core_.port, &core_),
                  HW_UNALIGNED);
    EXPECT_EQ(Demo_Scaler_Core_init(&other, coreSlot, coreMemory + 512, &core_.port, &core_),
              HW_OK);
}

TEST_F(Scaler, TooManyElementsAreRefusedBeforeTheCoreStarts) {
    try {
        shift(std::vector<Ice_Short>(101), 1);
        FAIL() << "101 elements were accepted for a buffer of 100";
    } catch (const CoreError& e) {
        EXPECT_EQ(e.status(), ICE_LIMIT);
    }
    EXPECT_EQ(shift(std::vector<Ice_Short>(100, 2), 1), 300);
}

TEST_F(Scaler, ACoreThrowsAnExceptionWithAllFields) {
    std::vector<Ice_Short> values(20, 5);
    values[13] = values[17] = 32000;
    try {
        shift(values, 1000);
        FAIL() << "the call threw no exception";
    } catch (const Demo_Scaler_shift_Exception& e) {
        EXPECT_EQ(e.type, Demo_Scaler_shift_Exception::Demo_Scaler_shift_Overflow);
        EXPECT_EQ(e.u.Overflow.index, 13);
        EXPECT_EQ(e.u.Overflow.base.code, 42);
    }
    EXPECT_EQ(shift(values, 0), 18 * 5 + 2 * 32000) << "a call after the exception must succeed";
}

TEST_F(Scaler, ACoreMayRefuseOrHangInALaterCall) {
    for (auto [values, offset, status] :
         {std::tuple{std::vector<Ice_Short>(), 1, ICE_UNKNOWN_EXCEPTION},
          std::tuple{std::vector<Ice_Short>(3), 0x7777, ICE_TIMEOUT}})
        try {
            shift(values, offset);
            ADD_FAILURE() << "offset " << offset;
        } catch (const CoreError& e) {
            EXPECT_EQ(e.status(), status);
        }
    EXPECT_EQ(shift({1, 2, 3}, 1), 9);
}

TEST_F(Scaler, TheExceptionOfAFailedCallNamesTheOperation) {
    try {
        shift(std::vector<Ice_Short>(3), 0x7777);
        FAIL() << "the call did not fail";
    } catch (const CoreError& e) {
        EXPECT_STREQ(e.what(), "shift: the core did not finish the call in time");
    }
}

TEST_F(Scaler, ASecondSimultaneousCallExceedsALimit) {
    std::vector<Ice_Short> values(100, 1);
    Demo_Samples list{100, values.data()};
    ASSERT_EQ(Demo_Scaler_Core_shift_begin(&core_.core_, &list, 1), ICE_OK);
    EXPECT_EQ(Demo_Scaler_Core_shift_begin(&core_.core_, &list, 1), ICE_LIMIT);
    core_.setLimit(7);
    core_.hw_finish("shift", 3);
    EXPECT_EQ(shift({1}, 1), 2);
}

TEST_F(Scaler, EachEventIsReportedOnceWithItsValues) {
    Demo_Peak peak{};
    core_.setLimit(100);
    EXPECT_FALSE(core_.peak(&peak));
    shift({5, 90, -7}, 9);
    EXPECT_FALSE(core_.peak(&peak)) << "99 is not above the limit";
    EXPECT_TRUE(core_.finished());
    EXPECT_FALSE(core_.finished());
    shift({5, 95, -7}, 9);
    ASSERT_TRUE(core_.peak(&peak));
    EXPECT_EQ(peak.index, 1);
    EXPECT_EQ(peak.value, 104);
    EXPECT_FALSE(core_.peak(&peak));
}

TEST(Proxy, MovesThePins) {
    ScalerProxy<VScalerWrapper> core;
    auto& pins = core.bench_.top();
    core.setLimit(12);
    EXPECT_EQ(pins.set_limit_limit_o, 12);
    core.setLimit(-3);
    EXPECT_EQ(pins.set_limit_limit_o, 0xFFFD);
    EXPECT_EQ(pins.shift_list_base_o, coreMemory);
    EXPECT_EQ(pins.shift_shifted_base_o, coreMemory + 256)
        << "the second buffer begins at the first multiple of 128 after 200 bytes";
}

TEST(Proxy, ElementsAreStoredAsInC) {
    StoreProxy<VStoreWrapper> core;
    auto& pins = core.bench_.top();
    core.port(9);
    EXPECT_EQ(pins.port_pins_o, 9);
    Demo_Vector v{2, {1.5, -2.0}}, w{};
    Demo_Peak peaks[7] = {{1, 2}, {0x1234, -1}};
    Demo_Peaks list{2, peaks};
    Demo_Bytes bytes{};
    pins.exchange_bytes_count_i = 5;
    pins.exchange_w_count_i = 1;
    pins.exchange_result_i = 77;
    for (unsigned i = 0; i < 4000; ++i)
        core.memory_.setByte(pins.exchange_bytes_base_o + i, static_cast<uint8_t>(i + 1));
    for (unsigned i = 0; i < 8; ++i)
        core.memory_.setByte(pins.exchange_w_base_o + i, i == 7 ? 0x40 : 0); // 2.0
    EXPECT_EQ(core.exchange(&v, &list, &bytes, &w), 77);
    EXPECT_EQ(pins.exchange_v_count_o, 2);
    EXPECT_EQ(pins.exchange_peaks_count_o, 2);
    EXPECT_EQ(core.memory_.byte(pins.exchange_v_base_o + 7), 0x3F);
    EXPECT_EQ(core.memory_.byte(pins.exchange_v_base_o + 15), 0xC0);
    EXPECT_EQ(core.memory_.byte(pins.exchange_peaks_base_o + 4), 0x34);
    EXPECT_EQ(core.memory_.byte(pins.exchange_peaks_base_o + 7), 0xFF);
    ASSERT_EQ(bytes.size, 5);
    EXPECT_EQ(bytes.data[4], 5);
    ASSERT_EQ(w.size, 1);
    EXPECT_EQ(w.data[0], 2.0);
    pins.exchange_bytes_count_i = 4001;
    EXPECT_THROW(core.exchange(&v, &list, &bytes, &w), CoreError)
        << "the core must reject more bytes than the buffer holds";
}

} // namespace
