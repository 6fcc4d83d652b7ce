// SPDX-License-Identifier: MIT
//
// olo_spi_test: a slave that echoes its input, and the clock at its pins.

#include "Volo_spi_slot.h"
#include "olo_spi_proxy.h"

namespace {

TEST(OloSpi, GivesBackWhatComes) {
    OloSpiProxy<Volo_spi_slot> core;
    unsigned edges = 0;
    bool before = false;
    core.bench_.addModel([] {},
                         [&] {
                             auto& top = core.bench_.top();
                             top.miso_i = top.mosi_o;
                             edges += top.sclk_o && !before && !top.cs_n_o;
                             before = top.sclk_o;
                         });
    for (Ice_Int value : {0x5AC3F00D, -1, 0, 1}) {
        edges = 0;
        EXPECT_EQ(core.transfer(value), value);
        EXPECT_EQ(edges, 32u);
    }
}

} // namespace
