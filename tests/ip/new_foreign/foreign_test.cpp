// SPDX-License-Identifier: MIT
//
// foreign_test: third-party cores as make new-foreign connects them: registers, pins, interrupt; a
// clock of its own.

#include "Va_bridge_slot.h"
#include "Vmy_late_slot.h"
#include "Vmy_port_slot.h"
#include "Vmy_requests_slot.h"
#include "Vmy_words_slot.h"
#include "core_slot.h"
extern "C" {
#include "a_bridge_regs.h"
#include "my_late_regs.h"
#include "my_port_regs.h"
#include "my_requests_regs.h"
#include "my_words_regs.h"
}

namespace {

TEST(Wishbone, RegistersReachThePinsAndTheInterruptComesThrough) {
    CoreSlot<Vmy_port_slot> slot;
    auto& top = slot.bench_.top();
    slot.bus_.write(MY_PORT_PAGE, 0);
    slot.bus_.write(MY_PORT_DRIVEN, 0xA5);
    EXPECT_EQ(top.port_out_o, 0xA5);
    top.port_in_i = 0x42;
    EXPECT_EQ(slot.bus_.read(MY_PORT_LEVELS), 0x42u);
    EXPECT_EQ(slot.bus_.read(1), 0u);
    top.port_in_i = 0x80;
    slot.tick();
    slot.tick();
    EXPECT_EQ(slot.bus_.read(1), MY_PORT_EVENT_CORE_MASK);
}

TEST(Axi4Lite, EveryWordIsARegisterOfItsOwn) {
    CoreSlot<Vmy_words_slot> slot;
    for (uint32_t i = 0; i < 4; ++i)
        slot.bus_.write(MY_WORDS_REG0 + i, 0x1000 + i);
    for (uint32_t i = 0; i < 4; ++i)
        EXPECT_EQ(slot.bus_.read(MY_WORDS_REG0 + i), 0x1000 + i);
    EXPECT_EQ(slot.bus_.read(1), 0u);
}

TEST(Apb, TransfersBeginWithoutEnableAndEndWithReady) {
    CoreSlot<Va_bridge_slot> slot;
    slot.bus_.write(A_BRIDGE_REG1, 0x12345678);
    slot.bus_.write(A_BRIDGE_REG2, 0x9ABCDEF0);
    EXPECT_EQ(slot.bus_.read(A_BRIDGE_REG1), 0x12345678u);
    EXPECT_EQ(slot.bus_.read(A_BRIDGE_REG2), 0x9ABCDEF0u);
    EXPECT_TRUE(slot.bus_.transfer(false, A_BRIDGE_REG3, 0).error) << "refused by PSLVERR";
    EXPECT_EQ(slot.bus_.read(A_BRIDGE_REG0), 6u);
    EXPECT_EQ(slot.bus_.read(1), 0u);
    slot.bench_.top().clk_div_i = 3; // the second of its interrupts
    slot.tick();
    slot.tick();
    EXPECT_EQ(slot.bus_.read(1), A_BRIDGE_EVENT_CORE_MASK);
}

TEST(Late, AValueIsReadOnceAndAClockLater) {
    CoreSlot<Vmy_late_slot> slot;
    EXPECT_EQ(slot.bus_.read(MY_LATE_REG2), 0x3222u) << "of its file, wherever the test runs";
    for (uint32_t i = 0; i < 4; ++i)
        slot.bus_.write(MY_LATE_REG0 + i, 0xA5C0 + i);
    for (uint32_t i = 0; i < 4; ++i) {
        EXPECT_EQ(slot.bus_.read(MY_LATE_REG0 + i), 0xA5C0 + i);
        EXPECT_EQ(slot.bus_.read(MY_LATE_REG0 + i), 0u);
    }
}

TEST(OwnClock, AnyRatioOfTheTwoClocksWillDo) {
    CoreSlot<Vmy_requests_slot> slot;
    for (unsigned hz : {9000000u, 24576000u, 76000000u, 99999999u, 100000000u}) {
        slot.ownClock_.run(hz);
        for (uint32_t i = 0; i < 40; ++i) {
            const uint32_t value = i * 0x9E3779B9u;
            EXPECT_FALSE(slot.bus_.transfer(true, MY_REQUESTS_REG0 + i % 3, value).error) << hz;
            EXPECT_EQ(slot.bus_.read(MY_REQUESTS_REG0 + i % 3), value) << hz;
            EXPECT_EQ(slot.bus_.read(0), MY_REQUESTS_ID_VALUE) << hz;
            EXPECT_TRUE(slot.bus_.transfer(false, 4, 0).error) << hz << ": there is no word 4";
        }
    }
}

// The core's time-out is an event; its interrupt crosses, and has gone when the write that takes it
// is done.
TEST(OwnClock, TheInterruptComesAndGoes) {
    CoreSlot<Vmy_requests_slot> slot;
    slot.interrupt_ = [] {};
    slot.bus_.write(2, MY_REQUESTS_EVENT_TIMEOUT_MASK);
    EXPECT_TRUE(slot.bus_.transfer(false, MY_REQUESTS_REG3, 0).error);
    EXPECT_EQ(slot.bus_.read(1), MY_REQUESTS_EVENT_TIMEOUT_MASK);
    EXPECT_TRUE(slot.bench_.top().irq_o);
    slot.bus_.write(1, MY_REQUESTS_EVENT_TIMEOUT_MASK);
    EXPECT_FALSE(slot.bench_.top().irq_o);
}

TEST(OwnClock, OneThatStandsStillIsAnErrorAndHangsNothing) {
    CoreSlot<Vmy_requests_slot> slot;
    slot.bus_.write(MY_REQUESTS_REG0, 5);
    slot.ownClock_.run(0);
    for (int i = 0; i < 3; ++i) {
        auto answer = slot.bus_.transfer(false, MY_REQUESTS_REG0, 0);
        EXPECT_TRUE(answer.error);
        EXPECT_EQ(answer.data, 0u);
        EXPECT_LE(answer.cycles, 251u);
        EXPECT_FALSE(slot.bench_.top().irq_o);
    }
    slot.ownClock_.run(24576000);
    EXPECT_EQ(slot.bus_.read(0), MY_REQUESTS_ID_VALUE); // not the late answer to the read before
    EXPECT_EQ(slot.bus_.read(MY_REQUESTS_REG0), 5u);
}

} // namespace
