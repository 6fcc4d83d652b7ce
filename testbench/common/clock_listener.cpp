// SPDX-License-Identifier: MIT
//
// clock_listener: adds the model's clock to a failed assertion.

#include "observed_clock.h"
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
    ::testing::UnitTest::GetInstance()->listeners().Append(new ClockListener);
    return true;
}();

} // namespace
