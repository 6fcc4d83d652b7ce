// SPDX-License-Identifier: MIT
//
// registers_test: a register file of every kind of word, against a model in C++.

#include "VRegisters.h"
#include "bus_master.h"
#include "random.h"
#include <gtest/gtest.h>

namespace {

enum Word { ID, EVENT, MASK, WIDE, NARROW, STATUS, STICKY, STROBE };

class BusRegisters : public ::testing::Test {
protected:
    BusRegisters() { bench_.reset(); }
    uint32_t value(unsigned word) { return bench_.top().value_o[word - 3]; }

    Bench<VRegisters> bench_;
    BusMaster<VRegisters> bus_{bench_};
};

TEST_F(BusRegisters, IdentityIsReadOnly) {
    bus_.write(ID, 0xFFFFFFFF);
    EXPECT_EQ(bus_.read(ID), 0x12340100u);
}

TEST_F(BusRegisters, ReadWriteWordsKeepTheirWidth) {
    bus_.write(WIDE, 0xDEADBEEF);
    bus_.write(NARROW, 0xFFFFFFFF);
    EXPECT_EQ(bus_.read(WIDE), 0xDEADBEEFu);
    EXPECT_EQ(bus_.read(NARROW), 0x1Fu) << "5 bits";
    EXPECT_EQ(value(WIDE), 0xDEADBEEFu);
    EXPECT_EQ(value(NARROW), 0x1Fu);
    bench_.reset();
    EXPECT_EQ(bus_.read(WIDE), 0u);
}

TEST_F(BusRegisters, ReadOnlyShowsTheBlocksWordAndIgnoresWrites) {
    bench_.top().value_i[STATUS - 3] = 0xABCDE;
    EXPECT_EQ(bus_.read(STATUS), 0xCDEu) << "12 bits";
    auto answer = bus_.transfer(true, STATUS, 0);
    EXPECT_FALSE(answer.error);
    EXPECT_EQ(bus_.read(STATUS), 0xCDEu);
}

TEST_F(BusRegisters, ClearOnWriteLosesNoBitSetInTheSameClock) {
    VRegisters& top = bench_.top();
    top.value_i[STICKY - 3] = 0x0F;
    bench_.tick();
    top.value_i[STICKY - 3] = 0;
    EXPECT_EQ(bus_.read(STICKY), 0x0Fu);
    top.value_i[STICKY - 3] = 0x05; // set again while it is cleared
    bus_.write(STICKY, 0x07);
    top.value_i[STICKY - 3] = 0;
    EXPECT_EQ(bus_.read(STICKY), 0x0Du);
}

TEST_F(BusRegisters, AWriteStrobesOnceAndStoresNothing) {
    VRegisters& top = bench_.top();
    unsigned strobes = 0;
    uint32_t seen = 0;
    bench_.addModel(
        [&] {
            if (top.strobe_o >> (STROBE - 3) & 1) {
                ++strobes;
                seen = top.wdata_o;
            }
        },
        [] {});
    bus_.write(STROBE, 0x55);
    bus_.write(WIDE, 1);
    bus_.read(STROBE);
    EXPECT_EQ(strobes, 1u);
    EXPECT_EQ(seen, 0x55u);
    EXPECT_EQ(bus_.read(STROBE), 0u);
}

TEST_F(BusRegisters, WordsThatDoNotExistAnswerWithAnErrorAndZero) {
    for (unsigned word = STROBE + 1; word < 16; ++word)
        for (bool write : {false, true}) {
            auto answer = bus_.transfer(write, word, 0xFFFFFFFF);
            EXPECT_TRUE(answer.error) << word;
            EXPECT_EQ(answer.data, 0u) << word;
            EXPECT_EQ(answer.cycles, 1u);
        }
}

// Events, mask and line against a model, with an event in any clock, also that of its clear.
TEST_F(BusRegisters, EventsAreStickyAndMaskedAndNeverLost) {
    VRegisters& top = bench_.top();
    Random random(testSeed(3));
    uint32_t sticky = 0, mask = 0;
    for (int i = 0; i < 20000; ++i) {
        uint32_t event = random.chance(0.2) ? random.below(8) : 0;
        uint32_t data = random.below(8);
        unsigned what = random.below(4);
        top.event_i = static_cast<uint8_t>(event);
        top.bus_valid_i = what != 0;
        top.bus_write_i = what == 1 || what == 2;
        top.bus_addr_i = what == 1 ? EVENT : MASK;
        top.bus_wdata_i = data;
        top.eval();
        ASSERT_EQ(top.irq_o, (sticky & mask) != 0) << "step " << i << ", SEED " << testSeed(3);
        if (what == 3) {
            ASSERT_EQ(top.bus_rdata_o, mask);
        }
        bench_.tick();
        if (what == 1)
            sticky &= ~data;
        sticky |= event;
        if (what == 2)
            mask = data;
    }
}

} // namespace
