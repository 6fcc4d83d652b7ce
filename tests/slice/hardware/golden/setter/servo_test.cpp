// SPDX-License-Identifier: MIT
//
// servo_test: calls every operation of the core.

#include "Vservo_slot.h"
#include "servo_proxy.h"

TEST(ServoCore, AnswersSetPulse) {
    ServoProxy<Vservo_slot> core;
    Ice_Short pulse{};
    core.setPulse(pulse);
}
