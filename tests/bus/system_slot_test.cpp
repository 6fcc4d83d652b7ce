// SPDX-License-Identifier: MIT
//
// system_slot_test: identity, the interrupt summary, the first bus error, the cycle count.

#include "VSystemSlot.h"
#include "bus_master.h"
#include "system_regs.h"
#include <gtest/gtest.h>

namespace {

class SystemSlot : public ::testing::Test {
protected:
    SystemSlot() { bench_.reset(); }
    void error(unsigned word, bool write, bool memory = false) {
        VSystemSlot& top = bench_.top();
        top.access_error_i = 1;
        top.error_memory_i = memory;
        top.error_addr_i = static_cast<uint16_t>(word);
        top.error_write_i = write;
        bench_.tick();
        top.access_error_i = 0;
        top.eval();
    }
    Bench<VSystemSlot> bench_;
    BusMaster<VSystemSlot> bus_{bench_};
};

TEST_F(SystemSlot, SaysWhatItIs) {
    EXPECT_EQ(bus_.read(SYSTEM_ID), SYSTEM_ID_VALUE);
    EXPECT_EQ(bus_.read(SYSTEM_SLOTS), 40u);
    EXPECT_EQ(bus_.read(SYSTEM_CLK_HZ), 25000000u);
    bus_.write(SYSTEM_SCRATCH, 0xA5A55A5A);
    EXPECT_EQ(bus_.read(SYSTEM_SCRATCH), 0xA5A55A5Au);
    bus_.write(SYSTEM_PAGE, 0xFFFFFFFF);
    EXPECT_EQ(bus_.read(SYSTEM_PAGE), 0x3Fu);
    EXPECT_EQ(bench_.top().page_o, 0x3F);
    for (unsigned slot = 0; slot < 64; ++slot) { // the parameter has those of slots 0 and 39
        bus_.write(SYSTEM_CONTRACT, slot);
        EXPECT_EQ(bus_.read(SYSTEM_CONTRACT), slot == 0    ? 0x12345678u
                                              : slot == 39 ? 0x9ABCDEF0u
                                                           : 0u)
            << slot;
    }
    for (unsigned word = SYSTEM_CONTRACT + 1; word < 16; ++word)
        EXPECT_TRUE(bus_.transfer(false, word, 0).error) << word;
}

TEST_F(SystemSlot, EveryLineIsSummarisedAndDrivesTheOne) {
    VSystemSlot& top = bench_.top();
    EXPECT_FALSE(top.irq_o);
    for (unsigned slot = 1; slot < 40; ++slot) {
        top.slot_irq_i = 1ull << (slot - 1);
        top.eval();
        EXPECT_TRUE(top.irq_o) << slot;
        uint64_t lines = bus_.read(SYSTEM_IRQ_LO) | uint64_t(bus_.read(SYSTEM_IRQ_HI)) << 32;
        EXPECT_EQ(lines, 1ull << slot);
    }
    // A spurious interrupt shows no slot: a line that falls before software looks leaves no trace.
    top.slot_irq_i = 0;
    top.eval();
    EXPECT_FALSE(top.irq_o);
    EXPECT_EQ(bus_.read(SYSTEM_IRQ_LO), 0u);
    EXPECT_EQ(bus_.read(SYSTEM_IRQ_HI), 0u);
}

TEST_F(SystemSlot, TheFirstErrorIsKeptUntilItIsCleared) {
    bus_.write(SYSTEM_MASK, SYSTEM_EVENT_BUS_ERROR_MASK);
    error(0x123, true);
    error(0x045, false, true);
    EXPECT_TRUE(bench_.top().irq_o);
    EXPECT_EQ(bus_.read(SYSTEM_IRQ_LO), 1u) << "slot 0 itself";
    EXPECT_EQ(bus_.read(SYSTEM_ERROR_ADDR), 0x123u | SYSTEM_ERROR_ADDR_WRITE_MASK);
    bus_.write(SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    EXPECT_FALSE(bench_.top().irq_o);
    error(0x045, false);
    EXPECT_EQ(bus_.read(SYSTEM_ERROR_ADDR), 0x45u);
    bus_.write(SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    error(0x045, false, true);
    EXPECT_EQ(bus_.read(SYSTEM_ERROR_ADDR), 0x3FFu) << "of memory";
}

// An error in the clock in which the event is cleared is a new one: event and place agree.
TEST_F(SystemSlot, AnErrorWhileItIsClearedIsANewOne) {
    error(0x001, false);
    VSystemSlot& top = bench_.top();
    top.access_error_i = 1;
    top.error_addr_i = 0x002;
    bus_.write(SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    top.access_error_i = 0;
    EXPECT_EQ(bus_.read(SYSTEM_EVENT), SYSTEM_EVENT_BUS_ERROR_MASK);
    EXPECT_EQ(bus_.read(SYSTEM_ERROR_ADDR), 0x002u);
}

TEST_F(SystemSlot, EveryBitOfScratchAndOfAnErrorsPlaceIsKept) {
    for (unsigned bit = 0; bit < 32; ++bit) {
        bus_.write(SYSTEM_SCRATCH, 1u << bit);
        EXPECT_EQ(bus_.read(SYSTEM_SCRATCH), 1u << bit);
        unsigned word = 1u << bit % 10;
        error(word, bit % 2);
        EXPECT_EQ(bus_.read(SYSTEM_ERROR_ADDR),
                  word | (bit % 2 ? SYSTEM_ERROR_ADDR_WRITE_MASK : 0));
        bus_.write(SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    }
}

TEST_F(SystemSlot, ALateAnswerOfTheBridgeIsAnEventOfItsOwn) {
    bus_.write(SYSTEM_MASK, SYSTEM_EVENT_LATE_MASK);
    bench_.top().late_i = 1;
    bench_.tick();
    bench_.top().late_i = 0;
    bench_.top().eval();
    EXPECT_EQ(bus_.read(SYSTEM_EVENT), SYSTEM_EVENT_LATE_MASK);
    EXPECT_TRUE(bench_.top().irq_o);
    bus_.write(SYSTEM_EVENT, SYSTEM_EVENT_LATE_MASK);
    EXPECT_FALSE(bench_.top().irq_o);
}

TEST_F(SystemSlot, TheHighHalfOfTheCycleCountIsThatOfTheLowHalf) {
    uint64_t before = bus_.read(SYSTEM_CYCLES_LO);
    before |= uint64_t(bus_.read(SYSTEM_CYCLES_HI)) << 32;
    uint64_t start = bench_.cycles();
    bench_.tick(1000);
    uint64_t ran = bench_.cycles() - start;
    uint64_t after = bus_.read(SYSTEM_CYCLES_LO);
    after |= uint64_t(bus_.read(SYSTEM_CYCLES_HI)) << 32;
    EXPECT_EQ(after - before, ran + 4) << "two reads of two clocks each lie between";
}

} // namespace
