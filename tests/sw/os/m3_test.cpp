// SPDX-License-Identifier: MIT
//
// m3_test: runs the cases of os_cases.c on the kernel's port for the Cortex-M3: the ARM binary runs
// on the model of the processor.

#include "plain_bus.h"
#include <cstdlib>
#include <gtest/gtest.h>

extern "C" {
#include "os_cases.h"
}

namespace {

class OsM3Cases : public ::testing::TestWithParam<unsigned> {};

// Returns the path of the program. UCOS2_CASES selects a build of the same program with the real
// uC/OS-II (docs/firmware.md).
std::string program() {
    const char* other = std::getenv("UCOS2_CASES");
    return other ? other : CASES_ELF;
}

TEST_P(OsM3Cases, BehavesAsInTheManual) {
    const OsCase& c = os_cases[GetParam()];
    PlainCpu m3(program());
    m3.setVariable("selected_case", GetParam());
    EXPECT_EQ(m3.run(1'000'000), 1)
        << m3.cpu.lastFault << " pc in " << m3.image.functionAt(m3.cpu.reg(CortexM3::Pc));
    EXPECT_EQ(m3.text("os_said"), c.expected);
}

// Each run interrupts the computation at a different instruction, and there wakes the task of
// higher priority. Tasks are therefore switched at many points of the computation.
TEST(OsM3, ASwitchAtAnyInstructionPreservesAllRegisters) {
    unsigned number = 0;
    while (std::string(os_cases[number].name) != "RegistersSurviveSwitches")
        ++number;
    uint64_t instructions = 0;
    for (uint64_t where = 0; where <= instructions; where += 7) {
        PlainCpu m3(program());
        uint64_t n = 0;
        bool said = false;
        m3.cpu.listener.instruction = [&](uint32_t) {
            if (++n == where)
                m3.cpu.pendInterrupt(0);
            said = said || (where == 0 && n % 64 == 0 && !m3.text("os_said").empty());
            // counts instructions until the computation has ended
            instructions += where == 0 && !said;
        };
        m3.setVariable("selected_case", number);
        ASSERT_EQ(m3.run(1'000'000), 1)
            << m3.cpu.lastFault << ", interrupted at instruction " << where;
        ASSERT_EQ(m3.text("os_said"), os_cases[number].expected)
            << "interrupted at instruction " << where;
    }
    EXPECT_GT(instructions, 500u);
}

INSTANTIATE_TEST_SUITE_P(All, OsM3Cases, ::testing::Range(0u, os_caseCount),
                         [](auto& c) { return std::string(os_cases[c.param].name); });

} // namespace

// On the host only the table of cases is used.
extern "C" void Runner_interrupt(void) {}
extern "C" void Runner_passTime(void) {}
