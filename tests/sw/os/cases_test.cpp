// SPDX-License-Identifier: MIT
//
// cases_test: runs the cases of os_cases.c on the kernel's port for the host, and additional cases
// for this port.

#include "os_host.h"
#include <gtest/gtest.h>

extern "C" {
#include "os_cases.h"
}

namespace {

bool tickPending = false, irqPending = false;

class OsHostCases : public ::testing::TestWithParam<unsigned> {};

TEST_P(OsHostCases, BehavesAsInTheManual) {
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
    OsCase_begin();
    c.prepare();
    OsHost::run();
    EXPECT_STREQ(os_said, c.expected);
}

INSTANTIATE_TEST_SUITE_P(All, OsHostCases, ::testing::Range(0u, os_caseCount),
                         [](auto& c) { return std::string(os_cases[c.param].name); });

TEST(OsHostPort, AnExceptionInATaskPropagatesFromRun) {
    OS_STK stack[16];
    OsHost::setMachine({[] { OsHost::stop(); }, [] { return false; }, [] {}});
    OSInit();
    OSTaskCreate([](void*) { throw std::runtime_error("the bus does not respond"); }, nullptr,
                 stack + 15, 5);
    EXPECT_THROW(OsHost::run(), std::runtime_error);
}

TEST(OsHostPort, PrioritiesAndTasksAreLimited) {
    OS_STK stack[16];
    auto create = [&](unsigned priority) {
        return OSTaskCreate([](void*) {}, nullptr, stack + 15, static_cast<INT8U>(priority));
    };
    INT8U err = 0;
    OSInit();
    OSMutexCreate(2, &err);
    EXPECT_EQ(create(2), OS_ERR_PRIO_EXIST) << "the priority is the ceiling of a mutex";
    EXPECT_EQ(create(OS_LOWEST_PRIO), OS_ERR_PRIO_INVALID);
    for (unsigned i = 0; i < OS_MAX_TASKS; ++i)
        EXPECT_EQ(create(10 + i), OS_ERR_NONE);
    EXPECT_EQ(create(40), OS_ERR_TASK_NO_MORE_TCB);
    EXPECT_EQ(create(10), OS_ERR_PRIO_EXIST);
}

} // namespace

extern "C" void Runner_interrupt(void) {
    irqPending = true;
    OsHost::interruptPoint();
}

extern "C" void Runner_passTime(void) {
    OsHost::interruptPoint();
}
