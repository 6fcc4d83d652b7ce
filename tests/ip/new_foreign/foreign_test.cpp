// SPDX-License-Identifier: MIT
//
// foreign_test: tests third-party cores that `./icesoc core foreign` has connected: registers,
// pins, interrupt, a separate clock, and cores that answer at any time that their bus
// allows. Checkers of the bus rules (bus/*_rules.v) end the test if a wrapper or a core breaks a
// rule.

#include "Va_bridge_slot.h"
#include "Vmy_apb2_slot.h"
#include "Vmy_avalon_slot.h"
#include "Vmy_classic_slot.h"
#include "Vmy_fixed_slot.h"
#include "Vmy_late_slot.h"
#include "Vmy_memory_slot.h"
#include "Vmy_narrow_slot.h"
#include "Vmy_pipelined_slot.h"
#include "Vmy_port_slot.h"
#include "Vmy_port_slot___024root.h"
#include "Vmy_requests_slot.h"
#include "Vmy_slow_memory_slot.h"
#include "Vmy_ways_slot.h"
#include "Vmy_words_slot.h"
#include "a_bridge_regs.h"
#include "my_late_regs.h"
#include "my_memory_regs.h"
#include "my_narrow_regs.h"
#include "my_port_regs.h"
#include "my_requests_regs.h"
#include "registers_apart.h"
#include "same.h"
#include <gtest/gtest-spi.h>

namespace {

// Checks that two registers, beginning with `first`, keep the values that are written.
template <class Module>
void holdsRegisters(CoreSlot<Module>& slot, unsigned first, const std::string& how) {
    for (uint32_t round : {0x12345678u, 0xEDCBA987u}) {
        for (unsigned i = 0; i < 2; ++i)
            EXPECT_FALSE(slot.bus_.transfer(true, first + i, round + i).error) << how;
        for (unsigned i = 0; i < 2; ++i)
            EXPECT_EQ(slot.bus_.read(first + i), round + i) << how << ", register " << i;
    }
    EXPECT_EQ(slot.bus_.read(1), 0u) << how << ": a time-out occurred";
}

TEST(Wishbone, RegistersDriveThePinsAndTheInterruptArrives) {
    CoreSlot<Vmy_port_slot> slot;
    auto& top = slot.bench_.top();
    slot.bus_.write(MY_PORT_PAGE, 0);
    slot.bus_.write(MY_PORT_DRIVEN, 0xA5);
    EXPECT_EQ(top.port_out_o, 0xA5);
    top.port_in_i = 0x42;
    EXPECT_EQ(slot.bus_.read(MY_PORT_LEVELS), 0x42u);
    EXPECT_EQ(slot.bus_.read(1), 0u);
    top.port_in_i = 0x80;
    slot.tick();
    slot.tick();
    EXPECT_EQ(slot.bus_.read(1), MY_PORT_EVENT_CORE_MASK);
}

TEST(Wishbone, ACoreMayStallAndDelayReplies) {
    CoreSlot<Vmy_pipelined_slot> pipelined;
    CoreSlot<Vmy_classic_slot> classic;
    for (uint8_t late = 0; late < 6; ++late) {
        for (uint8_t stalls = 0; stalls < 6; ++stalls) {
            pipelined.bench_.top().late_i = late;
            pipelined.bench_.top().stalls_i = stalls;
            holdsRegisters(pipelined, 8,
                           std::to_string(stalls) + " stalls, answer after " +
                               std::to_string(late));
        }
        classic.bench_.top().late_i = late;
        classic.bench_.top().stalls_i = 0;
        holdsRegisters(classic, 8, "classic, answer after " + std::to_string(late));
    }
}

TEST(Avalon, ACoreMayDelayRequestsAndReplies) {
    CoreSlot<Vmy_avalon_slot> slot;
    for (uint8_t late = 0; late < 6; ++late)
        for (uint8_t waits = 0; waits < 6; ++waits) {
            slot.bench_.top().late_i = late;
            slot.bench_.top().waits_i = waits;
            holdsRegisters(slot, 8,
                           std::to_string(waits) + " waits, data after " + std::to_string(late));
        }
    CoreSlot<Vmy_fixed_slot> fixed; // this core has neither waitrequest nor readdatavalid
    fixed.bench_.top().waits_i = 0;
    fixed.bench_.top().late_i = 3;
    holdsRegisters(fixed, 8, "data after 3");
}

TEST(Own, ARequestWithAnAcknowledgeLastsOneClock) {
    CoreSlot<Vmy_ways_slot> slot;
    holdsRegisters(slot, 8, "two addresses, two acknowledges");
    EXPECT_EQ(slot.bus_.read(12), 4u) << "each write must be carried out exactly once";
}

TEST(Memory, ReadDataMayArriveAtOnceOrNineClocksLater) {
    CoreSlot<Vmy_memory_slot> memory;
    holdsRegisters(memory, 8, "at once");
    CoreSlot<Vmy_slow_memory_slot> slow;
    holdsRegisters(slow, 8, "nine clocks");
}

TEST(Axi4Lite, ACoreMayDelayEachChannel) {
    CoreSlot<Vmy_words_slot> slot;
    auto& top = slot.bench_.top();
    const uint8_t clocks[] = {0, 1, 4};
    // the core takes the address before the data, together with the data, or after it
    for (uint8_t address : clocks)
        for (uint8_t data : clocks)
            for (uint8_t late : clocks) {
                top.aw_late_i = address;
                top.w_late_i = data;
                top.late_i = late;
                holdsRegisters(slot, 8,
                               "address after " + std::to_string(address) + ", data after " +
                                   std::to_string(data) + ", answer after " + std::to_string(late));
            }
}

TEST(Apb, TransfersBeginWithoutEnableAndEndWithReady) {
    CoreSlot<Va_bridge_slot> slot;
    slot.bench_.top().waits_i = 1;
    slot.bus_.write(A_BRIDGE_REG1, 0x12345678);
    slot.bus_.write(A_BRIDGE_REG2, 0x9ABCDEF0);
    EXPECT_EQ(slot.bus_.read(A_BRIDGE_REG1), 0x12345678u);
    EXPECT_EQ(slot.bus_.read(A_BRIDGE_REG2), 0x9ABCDEF0u);
    EXPECT_TRUE(slot.bus_.transfer(false, A_BRIDGE_REG3, 0).error)
        << "the core refuses this access by PSLVERR";
    EXPECT_EQ(slot.bus_.read(A_BRIDGE_REG0), 5u);
    EXPECT_EQ(slot.bus_.read(1), 0u);
    slot.bench_.top().clk_div_i = 3; // activates the second of the core's interrupts
    slot.tick();
    slot.tick();
    EXPECT_EQ(slot.bus_.read(1), A_BRIDGE_EVENT_CORE_MASK);
}

TEST(Apb, CoresWithEarlyLateAndMissingReadyWork) {
    CoreSlot<Va_bridge_slot> slot;
    for (uint8_t waits = 0; waits < 6; ++waits) {
        slot.bench_.top().waits_i = waits;
        holdsRegisters(slot, A_BRIDGE_REG1, std::to_string(waits) + " waits");
        EXPECT_TRUE(slot.bus_.transfer(true, A_BRIDGE_REG3, 0).error)
            << "the core refuses this access by PSLVERR";
    }
    CoreSlot<Vmy_apb2_slot> apb2;
    apb2.bench_.top().waits_i = 0;
    holdsRegisters(apb2, A_BRIDGE_REG1, "no PREADY");
}

TEST(Apb, ByteRegistersInPackedStructuresAreAccessible) {
    CoreSlot<Vmy_narrow_slot> slot;
    for (unsigned i = 0; i < 9; ++i) {
        slot.bus_.write(MY_NARROW_PAGE, i / 8 * 32);
        EXPECT_FALSE(slot.bus_.transfer(true, MY_NARROW_REG0 + i % 8, 0x80 + i).error) << i;
    }
    for (unsigned i = 0; i < 9; ++i) {
        slot.bus_.write(MY_NARROW_PAGE, i / 8 * 32);
        EXPECT_EQ(slot.bus_.read(MY_NARROW_REG0 + i % 8), 0x80 + i);
    }
    // Register 8 contains 0x88: its bits 2 to 0, the colour, are 0, and its bit 7 lights the lamp.
    EXPECT_EQ(slot.bench_.top().lamp_o, 1u);
    EXPECT_TRUE(slot.bus_.transfer(false, MY_NARROW_REG9, 0).error)
        << "the core refuses this access by PSLVERR";
}

// Runs the generated test with a table in which two names belong to one register.
TEST(RegistersApart, ARegisterWithTheValueOfAnotherIsFound) {
    CoreSlot<Vmy_memory_slot> slot;
    const Hw_Register table[] = {MY_MEMORY_TABLE},
                      twice[] = {{{1, "A"}, Hw_rw, 8, 0, 32, 0}, {{1, "B"}, Hw_rw, 8, 0, 32, 0}};
    ::testing::internal::CaptureStdout(); // no notes
    expectRegistersApart(slot, table, MY_MEMORY_PAGE);
    EXPECT_NONFATAL_FAILURE(expectRegistersApart(slot, twice, MY_MEMORY_PAGE),
                            "A has what was written to B");
    ::testing::internal::GetCapturedStdout();
}

TEST(RegistersApart, EachRegisterThatIsNotReadBackIsReported) {
    CoreSlot<Vmy_port_slot> slot;
    slot.bench_.top().port_in_i = 0;
    const Hw_Register table[] = {MY_PORT_TABLE};
    ::testing::internal::CaptureStdout();
    expectRegistersApart(slot, table, MY_PORT_PAGE);
    EXPECT_EQ(::testing::internal::GetCapturedStdout(),
              "note: LEVELS: not read back: 0xc was written, 0x0 read\n"
              "note: DRIVEN: written and read back\n");
    const Hw_Register input[] = {{{6, "LEVELS"}, Hw_rw, 8, 0, 8, 0}};
    ::testing::internal::CaptureStdout();
    expectRegistersApart(slot, input, MY_PORT_PAGE);
    EXPECT_NE(::testing::internal::GetCapturedStdout().find("no register keeps"),
              std::string::npos);
}

// A model of a counter in place of a Verilated model; it counts once in `every` clocks.
struct Counter {
    explicit Counter(VerilatedContext*) {}
    void eval() { root_.count += clk_i && ++clocks_ % every == 0; }
    void final() {}
    static inline unsigned every;
    struct Root {
        unsigned count = 0, rest = 0;
    } root_;
    Root* rootp = &root_;
    unsigned clk_i = 0, rst_i = 0, clocks_ = 0;
};

std::vector<StateMember> stateOf(const Counter::Root& root) {
    return {{root, root.rest, "u_core.rest"}, {root, root.count, "u_core.count"}};
}

TEST(Sequences, AFailureShowsTheFirstDifference) {
    static const std::vector<int> got = {3, 4, 5}, other = {3, 7, 5}, longer = {3, 4, 5, 6};
    EXPECT_SAME(got, (std::vector<short>{3, 4, 5}));
    EXPECT_NONFATAL_FAILURE(EXPECT_SAME(got, other), "got differs at [1]: expected 7, got 4");
    EXPECT_NONFATAL_FAILURE(EXPECT_SAME(got, longer),
                            "got differs at [3]: expected 6, got its end (expected 4 elements, "
                            "got 3)");
}

TEST(RegistersApart, ABusyCoreIsReportedWithItsChangingSignals) {
    for (unsigned every : {1, 3, 20}) {
        Counter::every = every;
        Bench<Counter> bench;
        ::testing::internal::CaptureStdout();
        noteWhetherItRests(bench);
        const std::string said = ::testing::internal::GetCapturedStdout();
        EXPECT_EQ(!said.empty(), every < 10);
        if (every == 1) {
            EXPECT_EQ(said, "note: active in 1000 of 1000 idle clocks (most often u_core.count), "
                            "so a flight evaluates each clock: about 2 to 5 million per second "
                            "instead of 600 million. If the clock may stop between calls, give "
                            "the core idle_o (docs/hw-mapping.md#idle); otherwise make run "
                            "CLK_HZ=2000000 is faster\n");
        }
    }
    struct Idle : Counter {
        using Counter::Counter;
        bool idle_o = true;
    };
    Counter::every = 1;
    Bench<Idle> idle; // this core has a clock gate in the chip
    Bench<Vmy_port_slot> bench;
    bench.reset();
    ::testing::internal::CaptureStdout();
    noteWhetherItRests(idle);
    noteWhetherItRests(bench);
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TEST(Late, AValueIsReadOnceAndOneClockLater) {
    CoreSlot<Vmy_late_slot> slot;
    EXPECT_EQ(slot.bus_.read(MY_LATE_REG2), 0x3222u)
        << "the memory must contain the data of its file, whatever the current directory is";
    for (uint32_t i = 0; i < 4; ++i)
        slot.bus_.write(MY_LATE_REG0 + i, 0xA5C0 + i);
    for (uint32_t i = 0; i < 4; ++i) {
        EXPECT_EQ(slot.bus_.read(MY_LATE_REG0 + i), 0xA5C0 + i);
        EXPECT_EQ(slot.bus_.read(MY_LATE_REG0 + i), 0u);
    }
}

TEST(OwnClock, AnyRatioOfTheTwoClocksWorks) {
    CoreSlot<Vmy_requests_slot> slot;
    for (unsigned hz : {9000000u, 24576000u, 76000000u, 99999999u, 100000000u}) {
        slot.ownClock_.run(hz);
        for (uint32_t i = 0; i < 40; ++i) {
            const uint32_t value = i * 0x9E3779B9u;
            EXPECT_FALSE(slot.bus_.transfer(true, MY_REQUESTS_REG0 + i % 3, value).error) << hz;
            EXPECT_EQ(slot.bus_.read(MY_REQUESTS_REG0 + i % 3), value) << hz;
            EXPECT_EQ(slot.bus_.read(0), MY_REQUESTS_ID_VALUE) << hz;
            EXPECT_TRUE(slot.bus_.transfer(false, 4, 0).error) << hz << ": word 4 does not exist";
        }
    }
}

// A time-out of the core causes an event. The core's interrupt crosses the clock domains; when the
// write that clears the interrupt ends, the interrupt is inactive.
TEST(OwnClock, TheInterruptRisesAndFalls) {
    CoreSlot<Vmy_requests_slot> slot;
    slot.interrupt_ = [] {};
    slot.bus_.write(2, MY_REQUESTS_EVENT_TIMEOUT_MASK);
    EXPECT_TRUE(slot.bus_.transfer(false, MY_REQUESTS_REG3, 0).error);
    EXPECT_EQ(slot.bus_.read(1), MY_REQUESTS_EVENT_TIMEOUT_MASK);
    EXPECT_TRUE(slot.bench_.top().irq_o);
    slot.bus_.write(1, MY_REQUESTS_EVENT_TIMEOUT_MASK);
    EXPECT_FALSE(slot.bench_.top().irq_o);
}

TEST(OwnClock, AStoppedClockIsAnErrorAndHangsNothing) {
    CoreSlot<Vmy_requests_slot> slot;
    slot.bus_.write(MY_REQUESTS_REG0, 5);
    slot.ownClock_.run(0);
    for (int i = 0; i < 3; ++i) {
        auto answer = slot.bus_.transfer(false, MY_REQUESTS_REG0, 0);
        EXPECT_TRUE(answer.error);
        EXPECT_EQ(answer.data, 0u);
        EXPECT_LE(answer.cycles, 251u);
        EXPECT_FALSE(slot.bench_.top().irq_o);
    }
    slot.ownClock_.run(24576000);
    // this read must not return the late answer to the previous read
    EXPECT_EQ(slot.bus_.read(0), MY_REQUESTS_ID_VALUE);
    EXPECT_EQ(slot.bus_.read(MY_REQUESTS_REG0), 5u);
}

} // namespace
