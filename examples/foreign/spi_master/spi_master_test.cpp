// SPDX-License-Identifier: MIT
//
// spi_master_test: the foreign entity sends bytes, and gets back what a device with a shift
// register returns.

#include "Vspi_master_slot.h"
#include "core_slot.h"
extern "C" {
#include "spi_master_regs.h"
}

namespace {

TEST(SpiMaster, ExchangesBytesWithADevice) {
    CoreSlot<Vspi_master_slot> slot;
    auto& top = slot.bench_.top();
    uint8_t device = 0x3C, sent = 0;
    bool wasHigh = false;
    // Mode 0: both sides sample at the rising edge, and change at the falling one.
    slot.bench_.addModel([] {},
                         [&] {
                             if (top.spi_clk_o && !wasHigh) {
                                 sent = static_cast<uint8_t>(sent << 1 | top.spi_dat_o);
                             } else if (!top.spi_clk_o && wasHigh) {
                                 device = static_cast<uint8_t>(device << 1 | 1);
                             }
                             wasHigh = top.spi_clk_o;
                             top.spi_dat_i = device >> 7;
                         });
    EXPECT_EQ(slot.bus_.read(SPI_MASTER_ID), SPI_MASTER_ID_VALUE);
    slot.bus_.write(SPI_MASTER_CTRL, 1);
    EXPECT_EQ(slot.bus_.read(SPI_MASTER_CTRL) & 0x3FF, 1u);
    EXPECT_EQ(top.spi_csn_o, 0xFF);
    slot.bus_.write(SPI_MASTER_DATA, 1u << 31 | 1u << 3 | 2); // chip select 2
    for (uint8_t byte : {uint8_t(0xA5), uint8_t(0x0F)}) {
        device = static_cast<uint8_t>(byte ^ 0x5A);
        uint8_t wanted = device;
        slot.bus_.write(SPI_MASTER_DATA, byte);
        for (int i = 0; i < 2000; ++i)
            slot.bench_.tick();
        EXPECT_FALSE(slot.bus_.read(SPI_MASTER_CTRL) >> 31) << "still busy";
        EXPECT_EQ(top.spi_csn_o, 0xFB);
        EXPECT_EQ(sent, byte);
        EXPECT_EQ(slot.bus_.read(SPI_MASTER_DATA) & 0xFF, wanted);
    }
    EXPECT_TRUE(slot.bus_.transfer(false, 9, 0).error);
}

} // namespace
