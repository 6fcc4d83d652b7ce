// SPDX-License-Identifier: MIT
//
// polar_test: compares the core's angles with the results of atan2, for points on a circle.

#include "Vpolar_slot.h"
#include "polar_proxy.h"
#include <cmath>

namespace {

TEST(Polar, AnglesMatchAtan2) {
    PolarProxy<Vpolar_slot> core;
    for (int degrees = -179; degrees < 180; degrees += 7) {
        const double radians = degrees * M_PI / 180;
        const auto x = static_cast<Ice_Short>(std::lround(16000 * std::cos(radians)));
        const auto y = static_cast<Ice_Short>(std::lround(16000 * std::sin(radians)));
        EXPECT_NEAR(core.angle(x, y), degrees * 4096.0 / 180, 3) << degrees << " degrees";
    }
}

} // namespace
