// SPDX-License-Identifier: MIT
//
// cpu_test: checks that the CPU model behaves as the ARMv7-M Architecture Reference Manual and the
// Cortex-M3 TRM demand.

#include "plain_bus.h"
#include <gtest/gtest.h>
#include <map>

namespace {

class Cpu : public ::testing::Test {
protected:
    static void select(PlainCpu& m, const std::string& name) {
        m.setVariable("selected", m.image.symbol(name) | 1); // bit 0 selects Thumb state
    }
    // Runs a case and returns its output.
    std::string run(const std::string& name) {
        select(m3, name);
        EXPECT_EQ(m3.run(100'000), 1) << m3.cpu.lastFault << ", said " << m3.text("said");
        return m3.text("said");
    }
    uint32_t value(unsigned n) { return m3.cpu.word(m3.image.symbol("value") + 4 * n); }

    PlainCpu m3{CASES_ELF};
};

// a case: its name, its output, and its results as {n, value[n]}
struct Case {
    const char *name, *symbol, *said;
    std::map<unsigned, uint32_t> values = {};
    friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

class Manual : public Cpu, public ::testing::WithParamInterface<Case> {};

TEST_P(Manual, IsFollowed) {
    EXPECT_EQ(run(GetParam().symbol), GetParam().said);
    for (auto [number, expected] : GetParam().values)
        EXPECT_EQ(value(number), expected) << number;
}

constexpr uint32_t unaligned = 1 << 24;
// bits of the register CFSR
constexpr uint32_t preciseBus = 1 << 9, addressValid = 1 << 15, impreciseBus = 1 << 10;
const Case cases[] = {
    {"AnInterruptOfHigherPriorityPreempts", "Case_nesting", "abBA"},
    {"AnInterruptOfTheSamePriorityWaits", "Case_samePriority", "aAbB"},
    {"AtEqualPriorityTheLowestNumberRunsFirst", "Case_lowestNumberFirst", "aAbBcC"},
    {"SubPrioritiesSetTheOrderWithoutPreemption", "Case_subPriority", "aAcCbB"},
    // value of R0 in the handler: no instruction after CPSIE has been executed yet
    {"AnInterruptRunsRightAfterCpsie", "Case_primaskExact", "1aA2", {{0, 5}}},
    {"BasepriMasksItsPriorityAndLowerOnes", "Case_basepri", "1bB2aA3"},
    {"FaultmaskMasksAllInterrupts", "Case_faultmask", "1aA2"},
    {"PendSvRunsAfterInterrupts", "Case_switchLast", "aAp"},
    {"SvcIsTakenAtOnceAndReturnsToTheNextInstruction", "Case_supervisorCall", "s.", {{0, 42}}},
    {"SleepEndsAlthoughPrimaskIsSet", "Case_sleepMasked", "wt."},
    {"ALoadFromAnUnmappedAddressIsAPreciseBusFault",
     "Case_busFault",
     "u.",
     {{0, preciseBus | addressValid}, {1, 0x60000010}}},
    // TRM r2p1, 3.5: the fault of a store arrives late and without an address. value[4] is the
    // number of instructions that were executed between the store and the DSB.
    {"AStoreFaultIsImpreciseAndABarrierWaitsForIt",
     "Case_storeFault",
     "u.",
     {{0, impreciseBus}, {1, 0}, {4, 2}}},
    {"WithoutTheWriteBufferAStoreFaultIsPrecise",
     "Case_unbuffered",
     "u.",
     {{0, preciseBus | addressValid}, {1, 0x60000010}, {4, 0}}},
    // no hard fault was taken
    {"AMaskedStoreFaultStaysPending", "Case_storeMasked", "1u2", {{2, 0}}},
    {"AWriteToFlashOrUnmappedMemoryIsABusFault", "Case_noMemory", "u.u.", {{0, impreciseBus}}},
    {"AFaultWithoutAHandlerIsAHardFault", "Case_escalation", "h.", {{2, 1 << 30}}}, // FORCED
    {"AnNmiDuringAHardFaultIgnoresTheMpu",                                          // B3.5.1
     "Case_guardOff",
     "hn.",
     {{5, 0}}},
    {"AnUndefinedInstructionIsAUsageFault", "Case_undefinedInstruction", "f.", {{0, 1 << 16}}},
    {"AJumpOutOfThumbStateIsAUsageFault", "Case_armState", "f.", {{0, 1 << 17}}}, // INVSTATE
    // The stack frame is at PSP, the handler uses the other stack, and CONTROL.SPSEL is restored
    // afterwards.
    {"AnInterruptedProcessHasItsFrameOnTheProcessStack",
     "Case_process",
     "aA",
     {{0, 0}, {1, 1}, {2, 2}, {3, 0xFFFFFFFD}}},
    // A3.4, B1.5.8: the entry and the return of an exception close the exclusive monitor.
    {"AnExceptionEndsAnExclusiveAccess", "Case_exclusive", "aA", {{0, 0}, {1, 1}, {2, 1}}},
    {"MultipleAndExclusiveAccessesMustBeAligned",
     "Case_unaligned",
     "ffffff.",
     {{0, unaligned},
      {1, unaligned},
      {2, unaligned},
      {3, unaligned},
      {4, unaligned},
      {5, unaligned}}},
    // The region with the highest number decides. Subregions and the default memory map are also
    // tested.
    {"ExecutingExecuteNeverMemoryFaults",
     "Case_executeNever",
     "m12mm.",
     {{0, 1}, {1, 1}, {2, 1}, {3, 0}}},
    {"BasepriHasFourBits",
     "Case_basepriBits",
     "",
     {{0, 0}, {1, 0x50}, {2, 0x50}, {3, 0x50}, {4, 0x30}, {5, 0}}},
    // B5.2.3: at priority -1 or -2 FAULTMASK cannot be set.
    {"FaultmaskCannotBeSetInAnNmi",
     "Case_faultmaskIgnored",
     "naA",
     {{0, 0}, {1, 0}, {2, 0}, {3, 1}}},
    {"ReservedBitsOfTheMpuAreZero", "Case_regionBits", "", {{0, 0x173FFF3E}, {1, 0x20000005}}},
    {"TheCycleCounterCountsWhileItIsEnabled",
     "Case_cycleCounter",
     "",
     {{0, 0x40000000}, {1, 0}, {2, 0}, {3, 1}, {4, 0x40000001}, {5, 0}}},
    {"SysTickAcceptsALateReloadAndAnotherClock",
     "Case_tickRules",
     ".",
     {{0, 1}, {1, 1}, {2, 0}, {3, 0}}},
    {"IcsrShowsTheRunningException",
     "Case_interruptState",
     "aA",
     {{0, 16}, {1, 1}, {2, 17}, {3, 0}}},
    {"BitBandingMapsEachBitToAWord", "Case_bitBand", "", {{0, 8}, {1, 1}, {2, 1}, {3, 0}}},
    {"AReturnOutOfThumbStateIsAUsageFault", "Case_stackedState", "aAf.", {{0, 1 << 17}}},
    {"FramesAreAlignedToEight", "Case_alignment", "aA", {{2, 0}, {3, 0}}}};

INSTANTIATE_TEST_SUITE_P(Cpu, Manual, ::testing::ValuesIn(cases));

// A program that uses a feature which is not modelled is stopped with this message.
struct Refusal {
    const char *symbol, *message;
    friend void PrintTo(const Refusal& r, std::ostream* out) { *out << r.symbol; }
};
class NotModelledParts : public Cpu, public ::testing::WithParamInterface<Refusal> {};

TEST_P(NotModelledParts, StopTheProgramWithAMessage) {
    select(m3, GetParam().symbol);
    try {
        m3.run(100'000);
        FAIL() << "said " << m3.text("said") << ", " << m3.cpu.lastFault;
    } catch (const NotModelled& e) {
        EXPECT_NE(std::string(e.what()).find(GetParam().message), std::string::npos) << e.what();
    }
    EXPECT_EQ(m3.text("said"), "");
}
INSTANTIATE_TEST_SUITE_P(
    Cpu, NotModelledParts,
    ::testing::Values(Refusal{"Case_unprivileged", "unprivileged code (CONTROL.nPRIV)"},
                      Refusal{"Case_sleepOnExit",
                              "a write of 32 bits, 0x00000002, to the system register 0xE000ED10"},
                      Refusal{"Case_waitForEvent", "WFE"},
                      Refusal{"Case_unknownRegister", "a read of the system register 0xE000EDF0"},
                      Refusal{"Case_noBackground", "0xE000ED94"},
                      Refusal{"Case_alignmentTrap", "0xE000ED14"},
                      Refusal{"Case_byteOfRegister",
                              "a read of 8 bits from the system register 0xE000E010"},
                      Refusal{"Case_unprivilegedLoad", "unprivileged access (LDRT"},
                      Refusal{"Case_unprivilegedStore", "unprivileged access (LDRT"}));

TEST_F(Cpu, ALineThatStaysHighPendsAgainWhenItsPendingBitIsCleared) {
    m3.cpu.setInterrupt(2, true);
    m3.cpu.exceptions().pend(18, false);
    EXPECT_TRUE(m3.cpu.exceptions()[18].pending);
    m3.cpu.setInterrupt(2, false);
    m3.cpu.exceptions().pend(18, false);
    EXPECT_FALSE(m3.cpu.exceptions()[18].pending);
}

TEST_F(Cpu, SysTickHasTheExactPeriod) {
    EXPECT_EQ(run("Case_systick"), "tttt");
    EXPECT_EQ(value(0), 1000u);
    EXPECT_EQ(value(1), 1000u);
    EXPECT_GT(m3.cpu.sleepingCycles(), 2000u);
}

TEST_F(Cpu, AnAcknowledgementWithoutABarrierMayRepeatTheInterrupt) {
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

TEST_F(Cpu, AFaultInTheHardFaultHandlerLocksUpUntilReset) {
    select(m3, "Case_lockUp");
    EXPECT_EQ(m3.run(100'000), -1);
    EXPECT_TRUE(m3.cpu.isLockedUp());
    m3.cpu.reset();
    EXPECT_EQ(run("Case_nesting"), "abBA");
}

// C1.5: without a debugger, BKPT is a hard fault. The debugger of this test connects when the
// handler begins, so that the BKPT at the end stops the program.
TEST_F(Cpu, ABreakpointInstructionWithoutADebuggerIsAHardFault) {
    m3.cpu.hasDebugger = false;
    m3.cpu.listener.entered = [this](unsigned number) { m3.cpu.hasDebugger = number == 3; };
    EXPECT_EQ(run("Case_breakpoint"), "h.");
    EXPECT_EQ(value(2), 1u << 31) << "HFSR: DEBUGEVT";
    EXPECT_NE(m3.cpu.lastFault.find("BKPT without a debugger (at 0x"), std::string::npos)
        << m3.cpu.lastFault;
}

// B1.5.5: the lowest bit of the reset vector sets the Thumb state; SP is a multiple of four.
TEST_F(Cpu, AResetVectorWithoutTheThumbBitFaults) {
    const uint32_t vectors[] = {m3.cpu.word(0) | 3, m3.cpu.word(4) & ~1u};
    m3.cpu.writeMemory(0, vectors, sizeof vectors);
    m3.cpu.reset();
    EXPECT_EQ(m3.cpu.reg(CortexM3::Msp), vectors[0] & ~3u);
    m3.run(1000);
    EXPECT_NE(m3.cpu.lastFault.find("reset vector"), std::string::npos) << m3.cpu.lastFault;
}

TEST_F(Cpu, TheMpuForbidsOnlyWritesToTheStackGuard) {
    EXPECT_EQ(run("Case_guard"), "0m..");
    EXPECT_EQ(value(0), 1u << 1 | 1u << 7); // DACCVIOL, MMARVALID
    EXPECT_EQ(value(3), m3.image.symbol("guarded") + 32);
}

// TRM, table 3-1; a branch that is taken takes 1 + 2 cycles here.
TEST_F(Cpu, InstructionsTakeTheCyclesOfTheManual) {
    run("Case_cycles");
    uint32_t nothing = value(0);
    EXPECT_EQ(value(1) - nothing, 10u); // 10 NOP
    EXPECT_EQ(value(2) - nothing, 4u);  // 2 LDR
    EXPECT_EQ(value(3) - nothing, 10u); // PUSH and POP of four registers take 10 cycles
    EXPECT_EQ(value(4) - nothing, 3u);  // B
    EXPECT_EQ(value(5) - nothing, 4u);  // MOV, and a CBZ that is taken
    // MOV, CMP, IT, two skipped instructions, one executed instruction
    EXPECT_EQ(value(6) - nothing, 6u);
}

TEST_F(Cpu, AResetRequestRestartsAndKeepsTheMemory) {
    unsigned resets = 0;
    m3.cpu.listener.systemReset = [&] { ++resets; };
    EXPECT_EQ(run("Case_resetRequest"), "r");
    EXPECT_EQ(resets, 1u);
    EXPECT_EQ(m3.variable("boots"), 2u);
}

// This is the strongest test: two nested interrupts arrive before each single instruction of a
// computation.
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
    EXPECT_EQ(entered[1], left[0]); // the first instruction is executed 6 cycles later
}

TEST_F(Cpu, MaskedTimeIsMeasured) {
    m3.cpu.countMasked(0x80);
    run("Case_primaskExact");
    EXPECT_GT(m3.cpu.longestMasked().cycles, 5u);
    EXPECT_LT(m3.cpu.longestMasked().cycles, 100u);
    EXPECT_EQ(m3.image.functionAt(m3.cpu.longestMasked().from), "Case_primaskExact");
}

} // namespace
