// SPDX-License-Identifier: MIT
//
// wide_echo_test: calls every operation of the core.

#include "Vwide_echo_slot.h"
#include "wide_echo_proxy.h"

TEST(WideEchoCore, AnswersNegate) {
    WideEchoProxy<Vwide_echo_slot> core;
    Ice_Long v{};
    core.negate(v);
}

TEST(WideEchoCore, AnswersSame) {
    WideEchoProxy<Vwide_echo_slot> core;
    Ice_Double v{};
    core.same(v);
}

TEST(WideEchoCore, AnswersSameFloat) {
    WideEchoProxy<Vwide_echo_slot> core;
    Ice_Float v{};
    core.sameFloat(v);
}

TEST(WideEchoCore, AnswersPause) {
    WideEchoProxy<Vwide_echo_slot> core;
    core.pause();
}

TEST(WideEchoCore, AnswersNothing) {
    WideEchoProxy<Vwide_echo_slot> core;
    core.nothing();
}
