// SPDX-License-Identifier: MIT
//
// modem_baud_test: mean rate of the baud generator at both ends of its clock range, against the
// modem's rates as its manual has them.

#include "VModemBaud100.h"
#include "VModemBaud2.h"
#include "bench.h"
#include <gtest/gtest.h>

namespace {

template <class Module> double measure(unsigned bd, double clkHz, double wanted) {
    Bench<Module> bench;
    bench.top().bd_i = static_cast<uint8_t>(bd);
    bench.reset();
    // Long enough that one tick more or less is a fiftieth of a percent.
    auto clocks = static_cast<uint64_t>(5000 * clkHz / (8 * wanted));
    uint64_t ticks = 0;
    for (uint64_t i = 0; i < clocks; ++i) {
        ticks += bench.top().tick_o;
        bench.tick();
    }
    return static_cast<double>(ticks) / static_cast<double>(clocks) * clkHz / 8;
}

class ModemBaud : public ::testing::TestWithParam<std::pair<unsigned, double>> {};

TEST_P(ModemBaud, IsRightWithinATenthOfAPercent) {
    auto [bd, wanted] = GetParam();
    EXPECT_NEAR(measure<VModemBaud2>(bd, 2e6, wanted) / wanted, 1, 0.001);
    EXPECT_NEAR(measure<VModemBaud100>(bd, 100e6, wanted) / wanted, 1, 0.001);
}

INSTANTIATE_TEST_SUITE_P(Codes, ModemBaud,
                         ::testing::Values(std::pair{0u, 1200.}, std::pair{1u, 2400.},
                                           std::pair{2u, 4800.}, std::pair{3u, 9600.},
                                           std::pair{4u, 19200.}, std::pair{5u, 38400.},
                                           std::pair{6u, 57600.}, std::pair{7u, 16e6 / 9 / 16},
                                           std::pair{8u, 250000.}));

} // namespace
