// SPDX-License-Identifier: MIT
//
// hardware_test: generated servants call cores behind generated wrappers, through the FSMC driver
// and a port that has a slot's register bus behind it.

#include "VCalculatorSlot.h"
#include "VHttpLevelSlot.h"
#include "VWideEchoSlot.h"
#include "core_slot.h"
extern "C" {
#include "calculator_servant.h"
#include "fsmc.h"
#include "http_level_servant.h"
#include "wide_echo_servant.h"
}
#include <gtest/gtest.h>

namespace {

constexpr U32 slot = coreSlot, clocksOfMs = coreClocksOfMs;

class CalculatorServant : public ::testing::Test {
protected:
    CalculatorServant() {
        EXPECT_EQ(Demo_Calculator_Core_init(&core_, slot, 0, &slot_.port, &slot_), HW_OK);
        slot_.core_ = &core_.core;
    }
    ~CalculatorServant() override { EXPECT_EQ(slot_.errors_, 0u) << "accesses to no register"; }
    Ice_Status divide(Ice_Int a, Ice_Int b) {
        slot_.started_ = slot_.bench_.cycles();
        return Demo_Calculator_divide(self_, a, b, &remainder_, &quotient_, nullptr);
    }

    CoreSlot<VCalculatorSlot> slot_;
    Demo_Calculator_Core core_{};
    Demo_CalculatorPtr self_ = &core_.servant;
    Ice_Int quotient_ = 0, remainder_ = 0;
};

TEST_F(CalculatorServant, IdentityIsTypeAndVersionOfTheInterface) {
    EXPECT_EQ(FSMC_read(slot, 0), 0x43410102u);
    Hw_Core other;
    EXPECT_EQ(Hw_Core_init(&other, slot, 0x43410103, &slot_.port, &slot_), HW_WRONG_CORE);
}

// As one whose own clock stands still: what it reads as is no result.
TEST_F(CalculatorServant, ACoreThatNoLongerAnswersIsATimeOut) {
    Ice_Int sum = 0;
    core_.core.id ^= 1;
    EXPECT_EQ(Demo_Calculator_add(self_, 2, 3, &sum, nullptr), ICE_TIMEOUT);
    EXPECT_EQ(Demo_Calculator_setMode(self_, Demo_wrap, 0, 0, nullptr), ICE_TIMEOUT);
}

TEST_F(CalculatorServant, SettersReachTheCoreAndGettersReadIt) {
    for (Demo_Mode mode : {Demo_wrap, Demo_saturate, Demo_refuse})
        for (Ice_Bool negate : {Ice_Bool(0), Ice_Bool(1)}) {
            auto shift = static_cast<Ice_Byte>(0xA0 + 2 * mode + negate);
            ASSERT_EQ(Demo_Calculator_setMode(self_, mode, negate, shift, nullptr), ICE_OK);
            Demo_Mode readMode = Demo_wrap;
            Ice_Bool readNegate = 9;
            Ice_Byte readShift = 0;
            ASSERT_EQ(Demo_Calculator_getMode(self_, &readNegate, &readShift, &readMode, nullptr),
                      ICE_OK);
            EXPECT_EQ(readMode, mode);
            EXPECT_EQ(readNegate, negate);
            EXPECT_EQ(readShift, shift);
        }
}

TEST_F(CalculatorServant, AnEnumeratorThatDoesNotExistIsTheCoresFault) {
    Demo_Mode mode = Demo_wrap;
    Ice_Bool negate;
    Ice_Byte shift;
    Demo_Calculator_setMode(self_, static_cast<Demo_Mode>(3), 0, 0, nullptr);
    EXPECT_EQ(Demo_Calculator_getMode(self_, &negate, &shift, &mode, nullptr),
              ICE_UNKNOWN_EXCEPTION);
}

TEST_F(CalculatorServant, AnOperationIsDoneWhenItsResultIsRead) {
    Ice_Int sum = 0;
    ASSERT_EQ(Demo_Calculator_add(self_, 40, -60, &sum, nullptr), ICE_OK);
    EXPECT_EQ(sum, -20);
    Demo_Calculator_setMode(self_, Demo_wrap, 1, 0, nullptr);
    ASSERT_EQ(Demo_Calculator_add(self_, 40, -60, &sum, nullptr), ICE_OK);
    EXPECT_EQ(sum, 20);
}

TEST_F(CalculatorServant, StructsGoMemberByMember) {
    Demo_Pair p = {-2, 32767}, swapped = {0, 0};
    ASSERT_EQ(Demo_Calculator_swap(self_, &p, &swapped, nullptr), ICE_OK);
    EXPECT_EQ(swapped.x, 32767);
    EXPECT_EQ(swapped.y, -2);
}

TEST_F(CalculatorServant, ALongOperationEndsByItsEvent) {
    for (int round = 0; round < 3; ++round) {
        ASSERT_EQ(divide(-1000 - round, 7), ICE_OK);
        EXPECT_EQ(quotient_, (-1000 - round) / 7);
        EXPECT_EQ(remainder_, (-1000 - round) % 7);
        EXPECT_GE(slot_.waitedClocks_, 38u) << "the core takes 40 clocks";
        EXPECT_LE(slot_.waitedClocks_, 60u) << "it ends by the event, not by the time-out";
    }
}

TEST_F(CalculatorServant, ACoreCanRefuse) {
    EXPECT_EQ(divide(1, 0), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(divide(9, 3), ICE_OK);
    EXPECT_EQ(quotient_, 3);
}

TEST_F(CalculatorServant, AHungCoreIsATimeOutAndIsResetForTheNextCall) {
    EXPECT_EQ(divide(1, 666), ICE_TIMEOUT);
    EXPECT_GE(slot_.waitedClocks_, 20 * clocksOfMs);
    EXPECT_EQ(divide(100, 8), ICE_OK);
    EXPECT_EQ(quotient_, 12);
    EXPECT_EQ(remainder_, 4);
}

TEST_F(CalculatorServant, OtherCallsGoOnWhileALongOneIsUnderWay) {
    FSMC_write(slot, 3, 1u << 3); // divide begins; its parameters are 0 / 0
    EXPECT_EQ(divide(8, 2), ICE_LIMIT) << "busy";
    Ice_Int sum = 0;
    ASSERT_EQ(Demo_Calculator_add(self_, 1, 2, &sum, nullptr), ICE_OK);
    EXPECT_EQ(sum, 3);
    for (int i = 0; i < 60; ++i)
        slot_.tick();
    EXPECT_EQ(divide(8, 2), ICE_OK);
    EXPECT_EQ(quotient_, 4);
}

// Values of 64 bits, floating point, and words that metadata chose, at the wrapper's pins.
class WideEchoServant : public ::testing::Test {
protected:
    WideEchoServant() {
        EXPECT_EQ(Demo_WideEcho_Core_init(&core_, slot, 0, &slot_.port, &slot_), HW_OK);
        slot_.core_ = &core_.core;
        VWideEchoSlot& top = slot_.bench_.top();
        slot_.bench_.addModel([&top, this] { nothings_ += top.nothing_start_o; },
                              [&top, this] {
                                  top.negate_result_i = -top.negate_v_o;
                                  top.same_result_i = top.same_v_o;
                                  top.same_float_result_i = top.same_float_v_o;
                                  top.pause_done_i = pauses_;
                              });
    }

    CoreSlot<VWideEchoSlot> slot_;
    Demo_WideEcho_Core core_{};
    Demo_WideEchoPtr self_ = &core_.servant;
    unsigned nothings_ = 0;
    bool pauses_ = false;
};

TEST_F(WideEchoServant, ValuesOf64BitsAreTwoWords) {
    Ice_Long v = {5, 7}, negative = {0, 0};
    ASSERT_EQ(Demo_WideEcho_negate(self_, v, &negative, nullptr), ICE_OK);
    EXPECT_EQ(negative.low, 0xFFFFFFFBu);
    EXPECT_EQ(negative.high, -8);
    double same = 0;
    ASSERT_EQ(Demo_WideEcho_same(self_, -1234.5678e-9, &same, nullptr), ICE_OK);
    EXPECT_EQ(same, -1234.5678e-9);
    EXPECT_EQ(slot_.errors_, 0u);
}

TEST_F(WideEchoServant, MetadataChoosesTheWord) {
    float same = 0;
    ASSERT_EQ(Demo_WideEcho_sameFloat(self_, 1.5f, &same, nullptr), ICE_OK);
    EXPECT_EQ(same, 1.5f);
    EXPECT_EQ(FSMC_read(slot, 9), 0x3FC00000u) << "IEEE 754 single precision";
    double result = 0;
    ASSERT_EQ(Demo_WideEcho_same(self_, 2.0, &result, nullptr), ICE_OK);
    EXPECT_EQ(FSMC_read(slot, 13), 0x40000000u) << "high half of the result, word 12 being the low";
}

TEST_F(WideEchoServant, AStartIsOneClock) {
    ASSERT_EQ(Demo_WideEcho_nothing(self_, nullptr), ICE_OK);
    ASSERT_EQ(Demo_WideEcho_nothing(self_, nullptr), ICE_OK);
    EXPECT_EQ(nothings_, 2u);
}

TEST_F(WideEchoServant, AStartWhileBusyIsNone) {
    unsigned starts = 0;
    slot_.bench_.addModel([&] { starts += slot_.bench_.top().pause_start_o; }, [] {});
    FSMC_write(slot, 3, 1u << 3);
    FSMC_write(slot, 3, 1u << 3);
    EXPECT_EQ(starts, 1u);
    EXPECT_EQ(FSMC_read(slot, 4), 1u << 3) << "busy";
}

TEST_F(WideEchoServant, ADoneWithoutAStartIsNoEvent) {
    pauses_ = true;
    for (int i = 0; i < 5; ++i)
        slot_.bench_.tick();
    EXPECT_EQ(FSMC_read(slot, 1), 0u);
    EXPECT_EQ(Demo_WideEcho_pause(self_, nullptr), ICE_OK);
}

TEST(VhdlCore, IsCalledAsOneInVerilog) {
    CoreSlot<VHttpLevelSlot> rig;
    Demo_HTTPLevel_Core core{};
    ASSERT_EQ(Demo_HTTPLevel_Core_init(&core, slot, 0, &rig.port, &rig), HW_OK);
    for (unsigned level : {0u, 0x5Au, 0xFFu}) {
        Ice_Byte read = 1;
        ASSERT_EQ(Demo_HTTPLevel_setLevel(&core.servant, static_cast<Ice_Byte>(level), nullptr),
                  ICE_OK);
        ASSERT_EQ(Demo_HTTPLevel_level(&core.servant, &read, nullptr), ICE_OK);
        EXPECT_EQ(read, level);
    }
    FSMC_write(slot, 3, 1u << 31);
    Ice_Byte read = 1;
    ASSERT_EQ(Demo_HTTPLevel_level(&core.servant, &read, nullptr), ICE_OK);
    EXPECT_EQ(read, 0) << "CONTROL's bit 31 resets the core";
}

} // namespace
