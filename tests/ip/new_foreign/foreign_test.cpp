// SPDX-License-Identifier: MIT
//
// foreign_test: third-party cores as make new-foreign connects them: registers, pins, interrupt.

#include "Vmy_port_slot.h"
#include "Vmy_words_slot.h"
#include "core_slot.h"
extern "C" {
#include "my_port_regs.h"
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

} // namespace
