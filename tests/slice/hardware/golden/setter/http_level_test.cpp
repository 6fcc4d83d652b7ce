// SPDX-License-Identifier: MIT
//
// http_level_test: calls every operation of the core.

#include "Vhttp_level_slot.h"
#include "http_level_proxy.h"

TEST(HTTPLevelCore, AnswersSetLevel) {
    HTTPLevelProxy<Vhttp_level_slot> core;
    Ice_Byte level{};
    core.setLevel(level);
}

TEST(HTTPLevelCore, AnswersLevel) {
    HTTPLevelProxy<Vhttp_level_slot> core;
    core.level();
}
