// SPDX-License-Identifier: MIT
//
// standstill_test: tests that a computation that never ends is reported once, with its functions. A
// computation in which simulated time passes must not be reported.

#include "standstill.h"
#include <gtest/gtest.h>

namespace {

uint64_t simulated = 0;

__attribute__((noinline)) void computes(const std::function<bool()>& goesOn) {
    for (volatile unsigned work = 0; goesOn(); work = work + 1) {
    }
}

extern "C" __attribute__((noinline)) void servantWithoutEnd(const Standstill& watch,
                                                            unsigned reports) {
    while (watch.reports() == reports) {
    }
    asm volatile(""); // prevents a tail call
}

TEST(Standstill, IsReportedOnceWithTheRunningFunction) {
    const Standstill watch([] { return simulated; }, 0.2);
    simulated = 1'500'000;
    testing::internal::CaptureStderr();
    servantWithoutEnd(watch, 0);
    const clock_t begin = clock();
    computes([&] { return clock() - begin < CLOCKS_PER_SEC / 2; });
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(watch.reports(), 1u);
    EXPECT_NE(said.find("simulated time has stopped at 0.001500 s; the firmware is in "
                        "servantWithoutEnd, called by "),
              std::string::npos)
        << said;
}

TEST(Standstill, IsReportedAgainAfterTimeHasPassed) {
    const Standstill watch([] { return simulated; }, 0.1);
    testing::internal::CaptureStderr();
    servantWithoutEnd(watch, 0);
    ++simulated;
    servantWithoutEnd(watch, 1);
    testing::internal::GetCapturedStderr();
    EXPECT_EQ(watch.reports(), 2u);
}

TEST(Standstill, IsNotReportedWhileTimePasses) {
    const Standstill watch([] { return ++simulated; }, 0.1);
    const clock_t begin = clock();
    computes([&] { return clock() - begin < CLOCKS_PER_SEC / 2; });
    EXPECT_EQ(watch.reports(), 0u);
}

} // namespace
