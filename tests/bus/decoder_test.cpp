// SPDX-License-Identifier: MIT
//
// decoder_test: every word of 64 slots in decoders of 1, 3 and 64 slots: the selected slot, and the
// answer.

#include "VDecoder1.h"
#include "VDecoder3.h"
#include "VDecoder64.h"
#include "observer.h"
#include "random.h"
#include <gtest/gtest.h>
#include <verilated.h>

namespace {

template <class Port> void set(Port& port, uint64_t value) {
    port = static_cast<Port>(value);
}
// Verilator's ports: an integer up to 64 bits, an array of words above.
void setData(uint32_t& port, unsigned, uint32_t value) {
    port = value;
}
template <std::size_t N> void setData(VlWide<N>& port, unsigned slot, uint32_t value) {
    port[slot] = value;
}

// The word address of a slot, 4 bits each.
uint32_t wordOf(uint64_t port, unsigned slot) {
    return static_cast<uint32_t>(port >> (4 * slot)) & 15;
}
template <std::size_t N> uint32_t wordOf(const VlWide<N>& port, unsigned slot) {
    return port[slot / 8] >> (4 * (slot % 8)) & 15;
}

template <class Decoder> void checkAll(unsigned slots) {
    VerilatedContext context;
    Observer<Decoder> observer(context);
    Decoder top(&context);
    Random random(testSeed(7));
    for (unsigned address = 0; address < 1024; ++address) {
        SCOPED_TRACE("word address " + std::to_string(address) + ", SEED " +
                     std::to_string(testSeed(7)));
        unsigned slot = address >> 4;
        uint64_t mask = slots == 64 ? ~0ull : (1ull << slots) - 1;
        uint64_t ready = (uint64_t(random.next()) << 32 | random.next()) & mask;
        uint64_t error = (uint64_t(random.next()) << 32 | random.next()) & mask;
        uint32_t answer = 0;
        for (unsigned s = 0; s < slots; ++s) {
            uint32_t value = random.next();
            setData(top.slot_rdata_i, s, value);
            if (s == slot)
                answer = value;
        }
        set(top.slot_ready_i, ready);
        set(top.slot_error_i, error);
        top.bus_valid_i = 0;
        top.bus_write_i = random.chance(0.5);
        top.bus_addr_i = static_cast<uint16_t>(address);
        for (int clock : {0, 1}) { // the address comes a clock before valid
            top.clk_i = static_cast<uint8_t>(clock);
            top.eval();
            ASSERT_EQ(uint64_t(top.slot_valid_o), 0u);
        }
        top.bus_valid_i = random.chance(0.8);
        top.bus_wdata_i = random.next();
        top.eval();

        bool mapped = slot < slots;
        uint64_t selected = top.bus_valid_i && mapped ? 1ull << slot : 0;
        ASSERT_EQ(uint64_t(top.slot_valid_o), selected);
        for (unsigned s = 0; s < slots; ++s)
            ASSERT_EQ(wordOf(top.slot_addr_o, s), s == slot ? address & 15 : 0) << "slot " << s;
        ASSERT_EQ(top.slot_write_o, top.bus_write_i);
        ASSERT_EQ(top.slot_wdata_o, top.bus_wdata_i);
        ASSERT_EQ(top.bus_rdata_o, answer);
        ASSERT_EQ(top.bus_ready_o, mapped ? ready >> slot & 1 : 1);
        ASSERT_EQ(top.bus_error_o, mapped ? error >> slot & 1 : 1)
            << "an unmapped slot answers with an error";
    }
    top.final();
    observer.finish();
}

TEST(BusDecoder, OneSlot) {
    checkAll<VDecoder1>(1);
}
TEST(BusDecoder, ThreeSlots) {
    checkAll<VDecoder3>(3);
}
TEST(BusDecoder, SixtyFourSlots) {
    checkAll<VDecoder64>(64);
}

} // namespace
