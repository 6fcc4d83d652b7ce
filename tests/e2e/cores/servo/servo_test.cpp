// SPDX-License-Identifier: MIT
//
// servo_test: tests the pins of the core, which are accessed through the Verilated model.

#include "Vservo_slot.h"
#include "servo_proxy.h"
#include <array>

namespace {

class Servo : public ::testing::Test {
protected:
    // Returns the time for which each pin is high in one frame of 20 ms, us.
    std::array<uint64_t, 4> microsecondsHigh() {
        std::array<uint64_t, 4> clocks{};
        for (unsigned i = 0; i < 20 * coreClocksOfMs; ++i) {
            core_.tick();
            for (unsigned channel = 0; channel < 4; ++channel)
                clocks[channel] += core_.bench_.top().pwm_o >> channel & 1;
        }
        for (uint64_t& n : clocks)
            n = n * 1000 / coreClocksOfMs;
        return clocks;
    }
    ServoProxy<Vservo_slot> core_;
};

TEST_F(Servo, PulseWidthsDoNotDependOnTheClock) {
    core_.setPulse(0, 1500);
    core_.setPulse(3, 400);
    EXPECT_EQ(microsecondsHigh(), (std::array<uint64_t, 4>{1500, 0, 0, 400}));
}

TEST_F(Servo, AFaultStopsThePulsesUntilItIsCleared) {
    core_.setPulse(0, 1500);
    core_.bench_.top().fault_i = 1;
    for (int i = 0; i < 4; ++i)
        core_.tick();
    core_.bench_.top().fault_i = 0;
    EXPECT_TRUE(core_.fault());
    EXPECT_EQ(microsecondsHigh()[0], 0u);
    core_.clear();
    EXPECT_FALSE(core_.fault());
    EXPECT_EQ(microsecondsHigh()[0], 1500u);
}

} // namespace
