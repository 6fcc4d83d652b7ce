// SPDX-License-Identifier: MIT
//
// cpu_test: the CPU model against the ARMv7-M Architecture Reference Manual and the Cortex-M3 TRM.

#include "plain_bus.h"
#include <gtest/gtest.h>

namespace {

class Cpu : public ::testing::Test {
protected:
    static void select(PlainCpu& m, const std::string& name) {
        m.setVariable("selected", m.image.symbol(name) | 1); // in Thumb state
    }
    // Runs a case and returns what it prints.
    std::string run(const std::string& name) {
        select(m3, name);
        EXPECT_EQ(m3.run(100'000), 1) << m3.cpu.lastFault << ", said " << m3.text("said");
        return m3.text("said");
    }
    uint32_t value(unsigned n) { return m3.cpu.word(m3.image.symbol("value") + 4 * n); }

    PlainCpu m3{CASES_ELF};
};

TEST_F(Cpu, AnInterruptOfHigherPriorityPreempts) {
    EXPECT_EQ(run("Case_nesting"), "abBA");
}
TEST_F(Cpu, OneOfTheSamePriorityWaits) {
    EXPECT_EQ(run("Case_samePriority"), "aAbB");
}
TEST_F(Cpu, OfEqualOnesTheLowestNumberComesFirst) {
    EXPECT_EQ(run("Case_lowestNumberFirst"), "aAbBcC");
}
TEST_F(Cpu, SubPrioritiesOrderAndDoNotPreempt) {
    EXPECT_EQ(run("Case_subPriority"), "aAcCbB");
}

TEST_F(Cpu, PrimaskHoldsBackAndUnmaskingIsExact) {
    EXPECT_EQ(run("Case_primaskExact"), "1aA2");
    EXPECT_EQ(value(0),
              5u); // r0 when the handler ran: no instruction behind CPSIE has been executed
}

TEST_F(Cpu, BasepriHoldsBackItsPriorityAndBelow) {
    EXPECT_EQ(run("Case_basepri"), "1bB2aA3");
}
TEST_F(Cpu, FaultmaskHoldsBackAll) {
    EXPECT_EQ(run("Case_faultmask"), "1aA2");
}
TEST_F(Cpu, PendSvRunsBehindInterrupts) {
    EXPECT_EQ(run("Case_switchLast"), "aAp");
}

TEST_F(Cpu, SvcEntersAtOnceAndReturnsBehindItself) {
    EXPECT_EQ(run("Case_supervisorCall"), "s.");
    EXPECT_EQ(value(0), 42u);
}

TEST_F(Cpu, SysTickHasItsPeriodExactly) {
    EXPECT_EQ(run("Case_systick"), "tttt");
    EXPECT_EQ(value(0), 1000u);
    EXPECT_EQ(value(1), 1000u);
    EXPECT_GT(m3.cpu.sleepingCycles(), 2000u);
}

TEST_F(Cpu, SleepEndsThoughPrimaskIsSet) {
    EXPECT_EQ(run("Case_sleepMasked"), "wt.");
}

TEST_F(Cpu, ALoadThatNobodyAnswersIsAPreciseBusFault) {
    EXPECT_EQ(run("Case_busFault"), "u.");
    EXPECT_EQ(value(0), 1u << 9 | 1u << 15); // PRECISERR, BFARVALID
    EXPECT_EQ(value(1), 0x60000010u);
}

// TRM r2p1, 3.5: the fault of a store comes later, and has no address.
TEST_F(Cpu, TheFaultOfAStoreIsImpreciseAndABarrierWaitsForIt) {
    EXPECT_EQ(run("Case_storeFault"), "u.");
    EXPECT_EQ(value(0), 1u << 10); // IMPRECISERR
    EXPECT_EQ(value(1), 0u);
    EXPECT_EQ(value(4), 2u); // what stood between the store and the DSB had been executed
}

TEST_F(Cpu, WithoutTheWriteBufferTheFaultOfAStoreIsPrecise) {
    EXPECT_EQ(run("Case_unbuffered"), "u.");
    EXPECT_EQ(value(0), 1u << 9 | 1u << 15);
    EXPECT_EQ(value(1), 0x60000010u);
    EXPECT_EQ(value(4), 0u);
}

TEST_F(Cpu, TheFaultOfAStoreWaitsWhileItIsMasked) {
    EXPECT_EQ(run("Case_storeMasked"), "1u2");
    EXPECT_EQ(value(2), 0u) << "no hard fault";
}

TEST_F(Cpu, AnAcknowledgementWithoutABarrierMayEnterTheRoutineAgain) {
    std::vector<unsigned> entered;
    unsigned line = 0;
    m3.bus.onWrite = [&](uint32_t address, uint32_t value) {
        if (address == 0x60000000)
            line = value;
        m3.cpu.setInterrupt(line, address == 0x60000000);
    };
    m3.cpu.listener.entered = [&](unsigned number) { entered.push_back(number - 16); };
    run("Case_lateAck");
    EXPECT_EQ(entered, (std::vector<unsigned>{4, 4, 5}));
}

TEST_F(Cpu, WhereThereIsNoMemoryOrItIsFlashAWriteIsABusFault) {
    EXPECT_EQ(run("Case_noMemory"), "u.u.");
    EXPECT_EQ(value(0), 1u << 10);
}

TEST_F(Cpu, WithoutAHandlerOfItsOwnAFaultIsAHardFault) {
    EXPECT_EQ(run("Case_escalation"), "h.");
    EXPECT_EQ(value(2), 1u << 30); // FORCED
}

TEST_F(Cpu, AnUndefinedInstructionIsAUsageFault) {
    EXPECT_EQ(run("Case_undefinedInstruction"), "f.");
    EXPECT_EQ(value(0), 1u << 16); // UNDEFINSTR
}

TEST_F(Cpu, AJumpOutOfThumbStateIsAUsageFault) {
    EXPECT_EQ(run("Case_armState"), "f.");
    EXPECT_EQ(value(0), 1u << 17); // INVSTATE
}

TEST_F(Cpu, AFaultInTheHardFaultHandlerLocksUpUntilReset) {
    select(m3, "Case_lockUp");
    EXPECT_EQ(m3.run(100'000), -1);
    EXPECT_TRUE(m3.cpu.isLockedUp());
    m3.cpu.reset();
    EXPECT_EQ(run("Case_nesting"), "abBA");
}

TEST_F(Cpu, TheMpuForbidsWritingToAGuardAndNothingBesides) {
    EXPECT_EQ(run("Case_guard"), "0m..");
    EXPECT_EQ(value(0), 1u << 1 | 1u << 7); // DACCVIOL, MMARVALID
    EXPECT_EQ(value(3), m3.image.symbol("guarded") + 32);
}

TEST_F(Cpu, AnInterruptedProcessHasItsFrameOnItsOwnStack) {
    EXPECT_EQ(run("Case_process"), "aA");
    EXPECT_EQ(value(0), 0u); // the frame is where PSP points
    EXPECT_EQ(value(1), 1u); // and the handler has another stack
    EXPECT_EQ(value(2), 2u); // CONTROL.SPSEL is back afterwards
    EXPECT_EQ(value(3), 0xFFFFFFFDu);
}

TEST_F(Cpu, FramesAreAlignedToEight) {
    EXPECT_EQ(run("Case_alignment"), "aA");
    EXPECT_EQ(value(2), 0u);
    EXPECT_EQ(value(3), 0u);
}

// TRM, table 3-1; a taken branch costs 1 + 2 here.
TEST_F(Cpu, InstructionsTakeTheCyclesOfTheManual) {
    run("Case_cycles");
    uint32_t nothing = value(0);
    EXPECT_EQ(value(1) - nothing, 10u); // 10 NOP
    EXPECT_EQ(value(2) - nothing, 4u);  // 2 LDR
    EXPECT_EQ(value(3) - nothing, 10u); // PUSH and POP of four registers
    EXPECT_EQ(value(4) - nothing, 3u);  // B
    EXPECT_EQ(value(5) - nothing, 4u);  // MOV, CBZ taken
    EXPECT_EQ(value(6) - nothing, 6u);  // MOV, CMP, IT, two skipped, one executed
}

TEST_F(Cpu, AResetRequestStartsAgainAndKeepsMemory) {
    unsigned told = 0;
    m3.cpu.listener.systemReset = [&] { ++told; };
    EXPECT_EQ(run("Case_resetRequest"), "r");
    EXPECT_EQ(told, 1u);
    EXPECT_EQ(m3.variable("boots"), 2u);
}

// The strongest one: two nested interrupts before each single instruction of a computation.
TEST_F(Cpu, AnInterruptAtAnyInstructionDoesNotChangeAResult) {
    run("Case_work");
    const uint32_t expected = value(0);
    const uint64_t instructions = m3.cpu.instructions();
    ASSERT_GT(instructions, 300u);
    for (uint64_t where = 1; where < instructions; ++where) {
        PlainCpu other(CASES_ELF);
        uint64_t n = 0;
        other.cpu.listener.instruction = [&](uint32_t) {
            if (++n == where) {
                other.cpu.pendInterrupt(0);
                other.cpu.pendInterrupt(1);
            }
        };
        select(other, "Case_work");
        ASSERT_EQ(other.run(100'000), 1) << where;
        ASSERT_EQ(other.cpu.word(other.image.symbol("value")), expected)
            << "interrupted at instruction " << where;
    }
}

TEST_F(Cpu, InterruptEntryTakesTwelveCyclesAndTailChainingSix) {
    std::vector<uint64_t> entered, left;
    m3.cpu.listener.entered = [&](unsigned) { entered.push_back(m3.cpu.cycles()); };
    m3.cpu.listener.left = [&](unsigned) { left.push_back(m3.cpu.cycles()); };
    uint64_t first = 0;
    m3.cpu.listener.instruction = [&](uint32_t address) {
        if (!first && entered.size() == 1 && address == (m3.image.symbol("Handler") & ~1u))
            first = m3.cpu.cycles();
    };
    EXPECT_EQ(run("Case_samePriority"), "aAbB");
    ASSERT_EQ(entered.size(), 2u);
    EXPECT_EQ(first - entered[0], 12u);
    EXPECT_EQ(entered[1], left[0]); // and then 6 cycles until the first instruction
}

TEST_F(Cpu, MaskedTimeIsMeasured) {
    m3.cpu.countMasked(0x80);
    run("Case_primaskExact");
    EXPECT_GT(m3.cpu.longestMasked().cycles, 5u);
    EXPECT_LT(m3.cpu.longestMasked().cycles, 100u);
    EXPECT_EQ(m3.image.functionAt(m3.cpu.longestMasked().from), "Case_primaskExact");
}

} // namespace
