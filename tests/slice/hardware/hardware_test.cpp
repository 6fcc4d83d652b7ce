// SPDX-License-Identifier: MIT
//
// hardware_test: tests that generated servants can call cores. A servant calls the FSMC driver. The
// driver's accesses go directly to the register bus of a slot, to which a generated wrapper
// connects the core.

#include "VCalculatorSlot.h"
#include "VManySlot.h"
#include "VWideEchoSlot.h"
#include "calculator_proxy.h"
#include "many_proxy.h"
#include "wide_echo_proxy.h"
#include <cstring>
#include <gtest/gtest.h>

namespace {

constexpr U32 slot = coreSlot, clocksOfMs = coreClocksOfMs;

template <class Call> Ice_Status statusOf(Call call) {
    try {
        call();
        return ICE_OK;
    } catch (const CoreError& e) {
        return e.status();
    }
}

class CalculatorServant : public ::testing::Test {
protected:
    ~CalculatorServant() override {
        EXPECT_EQ(core_.errors_, 0u) << "the test accessed words that are not registers";
    }
    Ice_Int divide(Ice_Int a, Ice_Int b) {
        core_.started_ = core_.bench_.cycles();
        return core_.divide(a, b, &remainder_);
    }
    Ice_Status divided(Ice_Int a, Ice_Int b) {
        return statusOf([&] { divide(a, b); });
    }

    CalculatorProxy<VCalculatorSlot> core_;
    Ice_Int remainder_ = 0;
    Ice_Bool negate_ = 9;
    Ice_Byte shift_ = 0;
};

TEST_F(CalculatorServant, IdentityIsTypeAndVersionOfTheInterface) {
    EXPECT_EQ(FSMC_read(slot, 0), 0x43410102u);
    Hw_Core other;
    EXPECT_EQ(Hw_Core_init(&other, slot, 0x43410103, &core_.port, &core_), HW_WRONG_CORE);
}

// With a separate clock (OWN_CLOCK) that has stopped, a read has no result.
TEST_F(CalculatorServant, ACoreThatStopsAnsweringCausesATimeOut) {
    core_.core_.core.id ^= 1;
    EXPECT_EQ(statusOf([&] { core_.add(2, 3); }), ICE_TIMEOUT);
    EXPECT_EQ(statusOf([&] { core_.setMode(Demo_wrap, 0, 0); }), ICE_TIMEOUT);
}

TEST(CoreSlot, AStatusIsPrintedWithItsText) {
    EXPECT_EQ(testing::PrintToString(ICE_TIMEOUT), "10 (::Ice::TimeoutException)");
}

TEST_F(CalculatorServant, SettersReachTheCoreAndGettersReadIt) {
    for (Demo_Mode mode : {Demo_wrap, Demo_saturate, Demo_refuse})
        for (Ice_Bool negate : {Ice_Bool(0), Ice_Bool(1)}) {
            auto shift = static_cast<Ice_Byte>(0xA0 + 2 * mode + negate);
            core_.setMode(mode, negate, shift);
            EXPECT_EQ(core_.getMode(&negate_, &shift_), mode);
            EXPECT_EQ(negate_, negate);
            EXPECT_EQ(shift_, shift);
        }
}

TEST_F(CalculatorServant, AnInvalidEnumeratorIsReportedAsAFaultOfTheCore) {
    core_.setMode(static_cast<Demo_Mode>(3), 0, 0);
    EXPECT_EQ(statusOf([&] { core_.getMode(&negate_, &shift_); }), ICE_UNKNOWN_EXCEPTION);
}

TEST_F(CalculatorServant, ReadingTheResultRunsTheOperation) {
    EXPECT_EQ(core_.add(40, -60), -20);
    core_.setMode(Demo_wrap, 1, 0);
    EXPECT_EQ(core_.add(40, -60), 20);
}

TEST_F(CalculatorServant, StructsAreTransferredMemberByMember) {
    Demo_Pair p = {-2, 32767}, swapped = core_.swap(&p);
    EXPECT_EQ(swapped.x, 32767);
    EXPECT_EQ(swapped.y, -2);
}

TEST_F(CalculatorServant, ALongOperationEndsWithItsEvent) {
    for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(divide(-1000 - round, 7), (-1000 - round) / 7);
        EXPECT_EQ(remainder_, (-1000 - round) % 7);
        EXPECT_GE(core_.waitedClocks_, 38u) << "the core takes 40 clocks";
        EXPECT_LE(core_.waitedClocks_, 60u) << "the event, not the time-out, must end the wait";
    }
}

TEST_F(CalculatorServant, ACoreCanRefuse) {
    EXPECT_EQ(divided(1, 0), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(divide(9, 3), 3);
}

TEST_F(CalculatorServant, AHungCoreCausesATimeOutAndIsResetForTheNextCall) {
    EXPECT_EQ(divided(1, 666), ICE_TIMEOUT);
    EXPECT_GE(core_.waitedClocks_, 20 * clocksOfMs);
    EXPECT_EQ(divide(100, 8), 12);
    EXPECT_EQ(remainder_, 4);
}

TEST_F(CalculatorServant, OtherOperationsWorkDuringALongOperation) {
    FSMC_write(slot, 3, 1u << 3); // starts `divide` by its register; both parameters are 0
    EXPECT_EQ(divided(8, 2), ICE_LIMIT) << "busy";
    EXPECT_EQ(core_.add(1, 2), 3);
    for (int i = 0; i < 60; ++i)
        core_.tick();
    EXPECT_EQ(divide(8, 2), 4);
}

// Calls operations with 64-bit values, with floating-point numbers, and with parameters in
// register words that metadata chooses. Checks the pins of the wrapper.
class WideEchoServant : public ::testing::Test {
protected:
    WideEchoServant() {
        core_.bench_.addModel([this] { nothings_ += top_.nothing_start_o; },
                              [this] {
                                  top_.negate_result_i = -top_.negate_v_o;
                                  top_.same_result_i = top_.same_v_o;
                                  top_.same_float_result_i = top_.same_float_v_o;
                                  top_.pause_done_i = pauses_;
                              });
    }

    WideEchoProxy<VWideEchoSlot> core_;
    VWideEchoSlot& top_ = core_.bench_.top();
    unsigned nothings_ = 0;
    bool pauses_ = false;
};

TEST_F(WideEchoServant, ValuesOf64BitsUseTwoWords) {
    Ice_Long negative = core_.negate({5, 7});
    EXPECT_EQ(negative.low, 0xFFFFFFFBu);
    EXPECT_EQ(negative.high, -8);
    EXPECT_EQ(core_.same(-1234.5678e-9), -1234.5678e-9);
    EXPECT_EQ(core_.errors_, 0u);
}

TEST_F(WideEchoServant, MetadataSelectsTheWord) {
    EXPECT_EQ(core_.sameFloat(1.5f), 1.5f);
    EXPECT_EQ(FSMC_read(slot, 9), 0x3FC00000u)
        << "the register contains the number in IEEE 754 single precision";
    EXPECT_EQ(core_.same(2.0), 2.0);
    EXPECT_EQ(FSMC_read(slot, 13), 0x40000000u)
        << "word 13 contains the high half of the result, word 12 the low half";
}

TEST_F(WideEchoServant, AStartLastsOneClock) {
    core_.nothing();
    core_.nothing();
    EXPECT_EQ(nothings_, 2u);
}

TEST_F(WideEchoServant, AStartWhileBusyIsIgnored) {
    unsigned starts = 0;
    core_.bench_.addModel([&] { starts += top_.pause_start_o; }, [] {});
    FSMC_write(slot, 3, 1u << 3);
    FSMC_write(slot, 3, 1u << 3);
    EXPECT_EQ(starts, 1u);
    EXPECT_EQ(FSMC_read(slot, 4), 1u << 3) << "busy";
}

TEST_F(WideEchoServant, ADoneWithoutAStartIsNoEvent) {
    pauses_ = true;
    for (int i = 0; i < 5; ++i)
        core_.bench_.tick();
    EXPECT_EQ(FSMC_read(slot, 1), 0u);
    core_.pause();
}

bool isSame(const Demo_Five& x, const Demo_Five& y) {
    return std::memcmp(&x, &y, sizeof x) == 0;
}

// Calls an operation with 20 words of parameters and 20 words of results, and another one with
// three words. Checks the pins of the wrapper. (slice.hardware.vhdl.many shows that the VHDL
// wrapper behaves the same.)
class ManyServant : public ::testing::Test {
protected:
    ManyServant() {
        VManySlot& top = rig_.bench_.top();
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
    ~ManyServant() override {
        EXPECT_EQ(rig_.errors_, 0u) << "the test accessed words that are not registers";
    }
    static Ice_Long number(U32 n) { return {n * 0x9E3779B9U, static_cast<Ice_Int>(n * 77 + 1)}; }
    static Ice_Long inverted(Ice_Long n) { return {~n.low, ~n.high}; }
    // Makes a call. Each call has other values, so that a value of an earlier call is detected.
    void turn() {
        Ice_Long n[10];
        for (Ice_Long& one : n)
            one = number(++numbers_);
        Demo_Five p = {n[0], n[1], n[2], n[3], n[4]}, q = {n[5], n[6], n[7], n[8], n[9]}, s;
        Demo_Five r = rig_.turn(&p, &q, &s);
        EXPECT_TRUE(isSame(s, {n[1], n[2], n[3], n[4], n[0]}));
        EXPECT_TRUE(isSame(
            r, {inverted(n[5]), inverted(n[6]), inverted(n[7]), inverted(n[8]), inverted(n[9])}));
    }
    void add() {
        Ice_Int a = number(++numbers_).high;
        EXPECT_EQ(rig_.add(a, 1000), a + 1000);
    }

    ManyProxy<VManySlot> rig_;
    U32 numbers_ = 0;
    bool started_ = false;
};

TEST_F(ManyServant, PagedRegistersWorkLikeOthers) {
    for (int round = 0; round < 3; ++round) {
        turn();
        add();
    }
    EXPECT_EQ(FSMC_read(slot, 5), 0u) << "PAGE must have its earlier value again";
}

TEST_F(ManyServant, ACoreInTheClockOfTheChipIsAccessedWithoutAProbe) {
    rig_.core_.core.id ^= 1;
    add();
}

TEST_F(ManyServant, ATaskThatInterruptsAnotherRestoresThePage) {
    U32 accesses = 0, last = 0;
    rig_.beforeAccess_ = [&] { ++accesses; };
    turn();
    last = accesses;
    for (U32 at = 1; at <= last; ++at) {
        accesses = 0;
        rig_.beforeAccess_ = [&] {
            if (++accesses == at)
                add();
        };
        turn();
        ASSERT_FALSE(HasFailure()) << "add interrupts access " << at;
    }
    EXPECT_GT(last, 100u);
}

TEST_F(ManyServant, AnAccessToAnUnusedPageIsAnError) {
    FSMC_write(slot, 5, 0xFFFFFFFF);
    EXPECT_EQ(FSMC_read(slot, 5), 0xFFu) << "eight pages; six have words";
    FSMC_read(slot, 15);
    FSMC_write(slot, 15, 1);
    EXPECT_EQ(rig_.errors_, 2u);
    FSMC_read(slot, 6);
    EXPECT_EQ(rig_.errors_, 2u) << "the words below 8 must be available in each page";
    rig_.errors_ = 0;
    FSMC_write(slot, 5, 0);
    turn();
}

} // namespace
