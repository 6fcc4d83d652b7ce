// SPDX-License-Identifier: MIT
//
// results_m3_test: checks on a Cortex-M3 that each task gets the results of the call it made, at
// whatever instruction the kernel switches to another task that also makes calls.

#include "plain_bus.h"
#include "random.h"
#include <cstdlib>
#include <gtest/gtest.h>

namespace {

// instructions that are counted: all of them, or only those in the function that checks results
enum Counted { ALL, LOOKING };

// Runs a case. Counts instructions from the start of the first calling task, and raises the
// interrupt before instruction number `where`. Returns the number of counted instructions.
uint64_t run(unsigned number, Counted counted, uint64_t where) {
    PlainCpu m3(RESULTS_ELF);
    const uint32_t first = m3.image.symbol("callsOnce") & ~1u;
    const uint32_t looks = m3.image.symbol("call") & ~1u, end = looks + m3.image.size("call");
    bool begun = false;
    uint64_t n = 0;
    m3.cpu.listener.instruction = [&](uint32_t at) {
        begun = begun || at == first;
        if (!begun || (counted == LOOKING && (at < looks || at >= end)))
            return;
        if (n++ == where)
            m3.cpu.pendInterrupt(0);
    };
    m3.setVariable("selected_case", number);
    EXPECT_EQ(m3.run(4'000'000), 1)
        << m3.cpu.lastFault << " pc in " << m3.image.functionAt(m3.cpu.reg(CortexM3::Pc))
        << ", interrupted at instruction " << where;
    EXPECT_EQ(m3.text("os_said"), "ended ") << "interrupted at instruction " << where;
    return n;
}

class ResultsM3 : public ::testing::TestWithParam<unsigned> {
protected:
    void interruptEach(Counted counted, uint64_t step) {
        uint64_t whole = run(GetParam(), counted, ~0ull);
        EXPECT_GT(whole, 100u);
        for (uint64_t where = testSeed(0) % step; where < whole && !HasFailure(); where += step)
            run(GetParam(), counted, where);
    }
};

TEST_P(ResultsM3, StayValidWhileOtherTasksCall) {
    interruptEach(LOOKING, 2);
}

// Another seed interrupts at other instructions. RESULTS_M3_STEP=1 interrupts at every instruction.
TEST_P(ResultsM3, AreCorrectWhereverAnotherTaskInterrupts) {
    const char* step = std::getenv("RESULTS_M3_STEP");
    interruptEach(ALL, step ? std::strtoull(step, nullptr, 10) : 1499);
}

INSTANTIATE_TEST_SUITE_P(All, ResultsM3, ::testing::Values(0u, 1u),
                         [](auto& c) { return c.param ? "OfFourTasks" : "OfTwoTasks"; });

} // namespace
