// SPDX-License-Identifier: MIT
//
// hardware_test: generated servants call cores behind generated wrappers, through the FSMC driver
// and a port that has a slot's register bus behind it.

#include "VCalculatorSlot.h"
#include "VHttpLevelSlot.h"
#include "VManySlot.h"
#include "VManyVhdlSlot.h"
#include "VWideEchoSlot.h"
#include "core_slot.h"
extern "C" {
#include "calculator_servant.h"
#include "fsmc.h"
#include "http_level_servant.h"
#include "many_servant.h"
#include "wide_echo_servant.h"
}
#include <cstring>
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

// Its own clock stops (OWN_CLOCK): a read is no result then.
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

bool isSame(const Demo_Five& x, const Demo_Five& y) {
    return std::memcmp(&x, &y, sizeof x) == 0;
}

// 20 words in and 20 out of one operation, and three of another, at the wrapper's pins.
template <class Module> class ManyServant : public ::testing::Test {
protected:
    ManyServant() {
        EXPECT_EQ(Demo_Many_Core_init(&core_, slot, 0, &rig_.port, &rig_), HW_OK);
        rig_.core_ = &core_.core;
        Module& top = rig_.bench_.top();
        rig_.bench_.addModel([&top, this] { started_ = top.turn_start_o; },
                             [&top, this] {
                                 top.turn_s_a_i = top.turn_p_b_o;
                                 top.turn_s_b_i = top.turn_p_c_o;
                                 top.turn_s_c_i = top.turn_p_d_o;
                                 top.turn_s_d_i = top.turn_p_e_o;
                                 top.turn_s_e_i = top.turn_p_a_o;
                                 top.turn_result_a_i = ~top.turn_q_a_o;
                                 top.turn_result_b_i = ~top.turn_q_b_o;
                                 top.turn_result_c_i = ~top.turn_q_c_o;
                                 top.turn_result_d_i = ~top.turn_q_d_o;
                                 top.turn_result_e_i = ~top.turn_q_e_o;
                                 top.turn_done_i = started_;
                                 top.add_result_i = top.add_a_o + top.add_b_o;
                             });
    }
    ~ManyServant() override { EXPECT_EQ(rig_.errors_, 0u) << "accesses to no register"; }
    static Ice_Long number(U32 n) { return {n * 0x9E3779B9U, static_cast<Ice_Int>(n * 77 + 1)}; }
    static Ice_Long inverted(Ice_Long n) { return {~n.low, ~n.high}; }
    // Each call has other values, so stale ones are wrong.
    void turn() {
        Ice_Long n[10];
        for (Ice_Long& one : n)
            one = number(++numbers_);
        Demo_Five p = {n[0], n[1], n[2], n[3], n[4]}, q = {n[5], n[6], n[7], n[8], n[9]}, s, r;
        ASSERT_EQ(Demo_Many_turn(&core_.servant, &p, &q, &s, &r, nullptr), ICE_OK);
        EXPECT_TRUE(isSame(s, {n[1], n[2], n[3], n[4], n[0]}));
        EXPECT_TRUE(isSame(
            r, {inverted(n[5]), inverted(n[6]), inverted(n[7]), inverted(n[8]), inverted(n[9])}));
    }
    void add() {
        Ice_Int a = number(++numbers_).high, sum = 0;
        ASSERT_EQ(Demo_Many_add(&core_.servant, a, 1000, &sum, nullptr), ICE_OK);
        EXPECT_EQ(sum, a + 1000);
    }

    CoreSlot<Module> rig_;
    Demo_Many_Core core_{};
    U32 numbers_ = 0;
    bool started_ = false;
};
using ManyModules = ::testing::Types<VManySlot, VManyVhdlSlot>;
TYPED_TEST_SUITE(ManyServant, ManyModules);

TYPED_TEST(ManyServant, WordsBehindPageAreCalledAsOthers) {
    for (int round = 0; round < 3; ++round) {
        this->turn();
        this->add();
    }
    EXPECT_EQ(FSMC_read(slot, 5), 0u) << "PAGE is put back";
}

TYPED_TEST(ManyServant, InTheChipsClockACoreIsNotAskedWhetherItAnswers) {
    this->core_.core.id ^= 1;
    this->add();
}

TYPED_TEST(ManyServant, ATaskThatInterruptsAnotherLeavesItsPageAlone) {
    auto& rig = this->rig_;
    U32 accesses = 0, last = 0;
    rig.beforeAccess_ = [&] { ++accesses; };
    this->turn();
    last = accesses;
    for (U32 at = 1; at <= last; ++at) {
        accesses = 0;
        rig.beforeAccess_ = [&] {
            if (++accesses == at)
                this->add();
        };
        this->turn();
        ASSERT_FALSE(this->HasFailure()) << "add interrupts the access " << at;
    }
    EXPECT_GT(last, 100u);
}

TYPED_TEST(ManyServant, AWordThatNoPageHasIsAnError) {
    auto& rig = this->rig_;
    FSMC_write(slot, 5, 0xFFFFFFFF);
    EXPECT_EQ(FSMC_read(slot, 5), 0xFFu) << "eight pages, of which six have words";
    FSMC_read(slot, 15);
    FSMC_write(slot, 15, 1);
    EXPECT_EQ(rig.errors_, 2u);
    FSMC_read(slot, 6);
    EXPECT_EQ(rig.errors_, 2u) << "words below 8 are in each page";
    rig.errors_ = 0;
    FSMC_write(slot, 5, 0);
    this->turn();
}

} // namespace
