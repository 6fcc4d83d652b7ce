// SPDX-License-Identifier: MIT
//
// store_test: calls every operation of the core.

#include "Vstore_slot.h"
#include "store_proxy.h"

TEST(StoreCore, AnswersExchange) {
    StoreProxy<Vstore_slot> core;
    Demo_Vector v{};
    Demo_Peaks peaks{};
    Demo_Bytes bytes{};
    Demo_Vector w{};
    core.exchange(&v, &peaks, &bytes, &w);
}
