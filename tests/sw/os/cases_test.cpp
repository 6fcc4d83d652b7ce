// SPDX-License-Identifier: MIT
//
// cases_test: the cases of os_cases.c on the host's port.

#include "os_host.h"
#include <gtest/gtest.h>

extern "C" {
#include "os_cases.h"
}

namespace {

bool tickPending = false, irqPending = false;

class OsHostCases : public ::testing::TestWithParam<unsigned> {};

TEST_P(OsHostCases, SaysWhatTheManualSays) {
    const OsCase& c = os_cases[GetParam()];
    unsigned ticks = 0;
    tickPending = irqPending = false;
    OsHost::setMachine({[&] {
                            if (ticks++ >= c.ticks)
                                OsHost::stop();
                            tickPending = true;
                        },
                        [] { return tickPending || irqPending; },
                        [&] {
                            if (irqPending) {
                                irqPending = false;
                                c.interrupt();
                            } else {
                                tickPending = false;
                                OSTimeTick();
                            }
                        }});
    OSInit();
    c.prepare();
    OsHost::run();
    EXPECT_STREQ(os_said, c.expected);
}

INSTANTIATE_TEST_SUITE_P(All, OsHostCases, ::testing::Range(0u, os_caseCount),
                         [](auto& c) { return std::string(os_cases[c.param].name); });

} // namespace

extern "C" void Runner_interrupt(void) {
    irqPending = true;
    OsHost::interruptPoint();
}

extern "C" void Runner_passTime(void) {
    OsHost::interruptPoint();
}
