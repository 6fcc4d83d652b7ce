// SPDX-License-Identifier: MIT
//
// scaler_test: calls every operation of the core.

#include "Vscaler_slot.h"
#include "scaler_proxy.h"

TEST(ScalerCore, AnswersSetLimit) {
    ScalerProxy<Vscaler_slot> core;
    Ice_Short limit{};
    core.setLimit(limit);
}

TEST(ScalerCore, AnswersShift) {
    ScalerProxy<Vscaler_slot> core;
    Demo_Samples list{};
    Ice_Short offset{};
    Demo_Samples shifted{};
    core.shift(&list, offset, &shifted);
}
