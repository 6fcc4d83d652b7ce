// SPDX-License-Identifier: MIT
//
// servo_test: the core's pins, reached through the model that the proxy holds.

#include "Vservo_slot.h"
#include "servo_proxy.h"

namespace {

class Servo : public ::testing::Test {
protected:
    // Returns how long a pin is high within one period of 2 ms.
    unsigned microsecondsHigh(unsigned channel) {
        unsigned clocks = 0;
        for (unsigned i = 0; i < 2 * coreClocksOfMs; ++i) {
            core_.tick();
            clocks += core_.bench_.top().pwm_o >> channel & 1;
        }
        return clocks * 1000 / coreClocksOfMs;
    }
    ServoProxy<Vservo_slot> core_;
};

TEST_F(Servo, PulsesAreMicrosecondsLongWhateverTheClock) {
    core_.setPulse(0, 1500);
    core_.setPulse(3, 400);
    EXPECT_EQ(microsecondsHigh(0), 1500u);
    EXPECT_EQ(microsecondsHigh(3), 400u);
    EXPECT_EQ(microsecondsHigh(1), 0u);
}

TEST_F(Servo, AFaultEndsThePulsesUntilItIsCleared) {
    core_.setPulse(0, 1500);
    core_.bench_.top().fault_i = 1;
    for (int i = 0; i < 4; ++i)
        core_.tick();
    core_.bench_.top().fault_i = 0;
    EXPECT_TRUE(core_.fault());
    EXPECT_EQ(microsecondsHigh(0), 0u);
    core_.clear();
    EXPECT_FALSE(core_.fault());
    EXPECT_EQ(microsecondsHigh(0), 1500u);
}

} // namespace
