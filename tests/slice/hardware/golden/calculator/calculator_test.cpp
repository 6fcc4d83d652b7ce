// SPDX-License-Identifier: MIT
//
// calculator_test: calls every operation of the core.

#include "Vcalculator_slot.h"
#include "calculator_proxy.h"

TEST(CalculatorCore, AnswersSetMode) {
    CalculatorProxy<Vcalculator_slot> core;
    Demo_Mode mode{};
    Ice_Bool negate{};
    Ice_Byte shift{};
    core.setMode(mode, negate, shift);
}

TEST(CalculatorCore, AnswersGetMode) {
    CalculatorProxy<Vcalculator_slot> core;
    Ice_Bool negate{};
    Ice_Byte shift{};
    core.getMode(&negate, &shift);
}

TEST(CalculatorCore, AnswersAdd) {
    CalculatorProxy<Vcalculator_slot> core;
    Ice_Int a{};
    Ice_Int b{};
    core.add(a, b);
}

TEST(CalculatorCore, AnswersDivide) {
    CalculatorProxy<Vcalculator_slot> core;
    Ice_Int a{};
    Ice_Int b{};
    Ice_Int remainder{};
    core.divide(a, b, &remainder);
}

TEST(CalculatorCore, AnswersSwap) {
    CalculatorProxy<Vcalculator_slot> core;
    Demo_Pair p{};
    core.swap(&p);
}
