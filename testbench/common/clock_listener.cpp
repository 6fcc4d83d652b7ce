// SPDX-License-Identifier: MIT
//
// clock_listener: adds the model's current clock cycle to the message of a failed assertion, and
// prints that cycle if the program is aborted.

#include "tell_on_abort.h"
#include <cstdio>
#include <gtest/gtest.h>

namespace {

class ClockListener : public ::testing::EmptyTestEventListener {
    void OnTestPartResult(const ::testing::TestPartResult& result) override {
        if (result.failed() && observedClock)
            std::printf("at clock cycle %llu\n", static_cast<unsigned long long>(observedClock));
    }
};

const bool added = [] {
    tellOnAbort(&observedClock, [] {
        return "The model that ran last stands at clock " + std::to_string(observedClock) + ".";
    });
    ::testing::UnitTest::GetInstance()->listeners().Append(new ClockListener);
    return true;
}();

} // namespace
