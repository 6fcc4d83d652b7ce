// SPDX-License-Identifier: MIT
//
// memory_models_test: tests the user port of the MCB model (order, flags, and commands that it
// refuses). Compares the times of the memory device with sums of data-sheet figures that were
// calculated by hand.

#include "ddr3_timing.h"
#include "mcb_model.h"
#include <ctime>
#include <functional>
#include <gtest/gtest.h>

namespace {

class Mcb : public ::testing::Test {
protected:
    void SetUp() override {
        while (!memory_.pins.calibDone)
            cycle();
    }
    void cycle(unsigned times = 1) {
        for (unsigned i = 0; i < times; ++i) {
            memory_.cycle();
            memory_.pins.cmdEn = memory_.pins.wrEn = memory_.pins.rdEn = false;
        }
    }
    void push(uint64_t data, uint8_t mask = 0) {
        memory_.pins.wrEn = true;
        memory_.pins.wrData = data;
        memory_.pins.wrMask = mask;
        cycle();
    }
    void command(uint8_t instruction, uint32_t address, unsigned words) {
        memory_.pins.cmdEn = true;
        memory_.pins.cmdInstr = instruction;
        memory_.pins.cmdByteAddr = address;
        memory_.pins.cmdBl = static_cast<uint8_t>(words - 1);
        cycle();
    }
    unsigned waitForWord() {
        unsigned clocks = 0;
        for (; memory_.pins.rdEmpty && clocks < 1000; ++clocks)
            cycle();
        return clocks;
    }
    uint64_t pop() {
        uint64_t data = memory_.pins.rdData;
        memory_.pins.rdEn = true;
        cycle();
        return data;
    }
    void refuses(const std::function<void()>& act, const std::string& why) {
        try {
            act();
            FAIL() << "expected: " << why;
        } catch (const McbError& error) {
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
            memory_.pins.cmdEn = memory_.pins.wrEn = memory_.pins.rdEn = false;
        }
    }

    static constexpr uint8_t write = 0, read = 1, writePrecharge = 2, readPrecharge = 3,
                             refresh = 4;
    McbModel memory_{1 << 20};
};

TEST_F(Mcb, ReadsReturnMaskedWrites) {
    push(0x1111111111111111u);
    push(0x2222222222222222u, 0xF0);
    command(write, 0x108, 2);
    command(read, 0x108, 2);
    waitForWord();
    EXPECT_EQ(pop(), 0x1111111111111111u);
    waitForWord();
    EXPECT_EQ(pop(), 0x22222222u);
    EXPECT_TRUE(memory_.pins.rdEmpty);
}

TEST_F(Mcb, ReadLatencyIsTheSumOfItsParts) {
    command(read, 0, 1);
    // Latency in clocks: 6 into the controller, 4 in the memory (tRCD 6 + CL 6 + burst 4 = 16
    // memory clocks), 5 back out.
    EXPECT_EQ(waitForWord() + 1, 6u + 4 + 5);
    pop();
    command(read, 0, 1);
    EXPECT_EQ(waitForWord() + 1, 6u + 3 + 5)
        << "a row hit takes CL 6 + burst 4 = 10 memory clocks, which are 3 clocks";
}

// AR36413, 2: the write waits until the read data has ended, and then for 2 cycles and 1 cycle at
// the pins.
TEST_F(Mcb, AWriteWaitsForTheDataOfThePreviousRead) {
    auto clocksUntilEmpty = [&](bool behindRead) {
        push(1);
        if (behindRead)
            command(read, 0, 8);
        command(write, 64, 1);
        unsigned clocks = 0;
        for (; !memory_.pins.wrEmpty; ++clocks)
            cycle();
        cycle(100);
        return clocks;
    };
    (void)clocksUntilEmpty(true); // opens the row for the accesses below
    // Times in memory clocks since the first command of the read. The last of the four bursts has
    // its command at 12, and its data ends after CL (6) and burst (4), so the write starts at 25.
    // Without the read, the write would start at 4, one clock of the design later.
    EXPECT_EQ(clocksUntilEmpty(true), clocksUntilEmpty(false) + (25 - 4) / 4);
}

// AR36413, 3: commands are executed one at a time; an activate waits for the data of the previous
// read.
TEST_F(Mcb, AnActivateWaitsForTheDataOfThePreviousRead) {
    constexpr uint32_t bank = 2048;
    command(read, 0, 2);
    command(read, bank, 2);
    waitForWord();
    pop();
    pop();
    // the words of the first read arrive after CL 6 and burst 4; the second read then needs tRCD 6,
    // CL 6 and burst 4
    EXPECT_EQ(waitForWord() + 2, 16u / 4);
}

TEST_F(Mcb, PrechargingInstructionsCloseTheRow) {
    command(readPrecharge, 0, 1);
    waitForWord();
    pop();
    cycle(20);
    uint64_t misses = memory_.device().rowMisses;
    command(read, 0, 1);
    waitForWord();
    EXPECT_EQ(memory_.device().rowMisses, misses + 1);
    push(1);
    command(writePrecharge, 64, 1);
    cycle(30);
    EXPECT_EQ(memory_.data()[64], 1);
    uint64_t refreshes = memory_.device().refreshes;
    command(refresh, 0, 1);
    cycle(30);
    EXPECT_EQ(memory_.device().refreshes, refreshes + 1);
}

TEST_F(Mcb, TheMemorySideMovesTwoWordsPerClockAndThePortOne) {
    // all 64 words of this read are in the FIFO within 40 clocks of the first word
    command(read, 0, 64);
    waitForWord();
    unsigned clocks = 0;
    for (; !memory_.pins.rdFull; ++clocks)
        cycle();
    EXPECT_GE(clocks, 31u);
    EXPECT_LE(clocks, 32u);
    EXPECT_EQ(memory_.pins.rdCount, 64);
}

TEST_F(Mcb, TheWriteFlagsFollowTheFifo) {
    EXPECT_TRUE(memory_.pins.wrEmpty);
    for (unsigned i = 0; i < 64; ++i) {
        EXPECT_FALSE(memory_.pins.wrFull);
        push(i);
        EXPECT_EQ(memory_.pins.wrCount, i + 1);
    }
    EXPECT_TRUE(memory_.pins.wrFull);
    refuses([&] { push(64); }, "write FIFO overflow");
    command(write, 0, 64);
    cycle(60);
    EXPECT_TRUE(memory_.pins.wrEmpty);
    EXPECT_EQ(memory_.data()[8 * 63], 63);
}

TEST_F(Mcb, TheCommandFifoHoldsFourCommands) {
    for (unsigned i = 0; i < 4; ++i) {
        EXPECT_FALSE(memory_.pins.cmdFull);
        command(read, 0, 8);
    }
    EXPECT_TRUE(memory_.pins.cmdFull);
    refuses([&] { command(read, 0, 8); }, "command FIFO overflow");
}

TEST_F(Mcb, InvalidAccessesAreRefused) {
    refuses([&] { command(write, 0, 1); }, "before its data");
    EXPECT_TRUE(memory_.pins.wrUnderrun && memory_.pins.wrError);
    refuses([&] { command(read, 4, 1); }, "aligned");
    refuses([&] { command(read, (1 << 20) - 8, 2); }, "beyond the memory");
    refuses([&] { command(read, 0, 65); }, "more than 64 words");
    refuses([&] { pop(); }, "read of an empty FIFO");
    EXPECT_TRUE(memory_.pins.rdError);
    push(1);
    // this write uses the word in the FIFO that belongs to the previous command
    command(write, 0, 1);
    refuses([&] { command(write, 0, 1); }, "before its data");
}

TEST_F(Mcb, ReadWordsThatDoNotFitAreLost) {
    command(read, 0, 64);
    command(read, 512, 1);
    refuses([&] { cycle(200); }, "read FIFO overflow");
    EXPECT_TRUE(memory_.pins.rdOverflow);
}

TEST(McbStart, NoCommandBeforeCalibration) {
    McbModel memory(1 << 20);
    memory.pins.cmdEn = true;
    memory.pins.cmdInstr = 1;
    EXPECT_THROW(memory.cycle(), McbError);
}

// the sanitizers write to the whole memory
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Each flight makes a memory of the board's size, and uses a small part of it.
TEST(McbStart, ALargeMemoryStartsAsFastAsASmallOne) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < 50; ++i) {
        McbModel memory;
        ASSERT_EQ(memory.data()[memory.size() - 1], 0);
    }
    EXPECT_LT(std::clock() - begin, 2 * CLOCKS_PER_SEC);
}
#endif

// x16 memory: a page has 2 KiB, and there are eight banks
constexpr uint32_t bankStep = 2048, rowStep = 8 * 2048;

TEST(Ddr3Timing, TheFirstReadOpensItsRow) {
    Ddr3Timing device(mt41j64m16);
    EXPECT_EQ(device.access(100, true, 0), 100u + 6) << "tRCD";
    EXPECT_EQ(device.rowMisses, 1u);
}

TEST(Ddr3Timing, BurstsInAnOpenRowFollowEachOtherByTccd) {
    Ddr3Timing device(mt41j64m16);
    uint64_t first = device.access(100, true, 0);
    for (unsigned i = 1; i < 128; ++i)
        EXPECT_EQ(device.access(0, true, 16 * i), first + 4 * i);
    EXPECT_EQ(device.rowHits, 127u);
}

TEST(Ddr3Timing, AnotherRowOfTheBankWaitsForPrechargeAndActivate) {
    Ddr3Timing device(mt41j64m16);
    uint64_t first = device.access(100, true, 0); // the row is activated at clock 100
    // precharge at clock 100 + tRAS (15), because tRAS is longer than tRCD + tRTP; then tRP (6) and
    // tRCD (6)
    EXPECT_EQ(device.access(first + 1, true, rowStep), 100u + 15 + 6 + 6);
}

TEST(Ddr3Timing, AWriteHoldsItsRowForWriteRecovery) {
    Ddr3Timing device(mt41j64m16);
    uint64_t cas = device.access(100, false, 0);
    // the write needs CWL 5, burst 4, tWR 6; the next access needs tRP 6, tRCD 6
    EXPECT_EQ(device.access(cas + 1, false, rowStep), cas + 5 + 4 + 6 + 6 + 6);
}

TEST(Ddr3Timing, TurnaroundsKeepTheDataBusFree) {
    Ddr3Timing device(mt41j64m16);
    uint64_t read = device.access(100, true, 0);
    uint64_t write = device.access(0, false, 16);
    EXPECT_EQ(write, read + 6 + 4 + 2 - 5) << "CL + tCCD + 2 - CWL";
    EXPECT_EQ(device.access(0, true, 32), write + 5 + 4 + 4) << "CWL + burst + tWTR";
    EXPECT_EQ(device.turnarounds, 2u);
}

TEST(Ddr3Timing, ActivatesOfBanksAreSpacedByTrrdAndTfaw) {
    Ddr3Timing device(mt41j64m16);
    uint64_t act[6];
    for (unsigned bank = 0; bank < 6; ++bank)
        act[bank] = device.access(100, true, bank * bankStep) - 6;
    EXPECT_EQ(act[0], 100u);
    EXPECT_EQ(act[1], 104u) << "tRRD";
    EXPECT_EQ(act[3], 112u);
    EXPECT_EQ(act[4], 120u) << "tFAW: 50 ns after the first of the four before";
    EXPECT_EQ(act[5], 124u);
}

TEST(Ddr3Timing, RefreshComesEveryTrefiAndTakesTrfc) {
    Ddr3Timing device(mt41j64m16);
    device.access(100, true, 0);
    // a refresh is due at 3120: precharge all (tRP 6), refresh (tRFC 44), activate, tRCD 6
    EXPECT_EQ(device.access(3120, true, 0), 3120u + 6 + 44 + 6);
    EXPECT_EQ(device.refreshes, 1u);
    device.access(4'000'000, true, 0); // after 10 ms, which are 1282 intervals of 7.8 us
    EXPECT_EQ(device.refreshes, 1282u);
}

TEST(Ddr3Timing, AControllerMayPostponeRefresh) {
    Ddr3Timing device(mt41j64m16, 2);
    device.access(100, true, 0);
    EXPECT_EQ(device.access(3120, true, 0), 3120u + 6 + 2 + 44 + 6);
}

TEST(Ddr3Timing, AClosedBankNeedsNoPrecharge) {
    Ddr3Timing device(mt41j64m16);
    uint64_t cas = device.access(100, true, 0);
    device.autoPrecharge(0);
    EXPECT_EQ(device.access(cas + 100, true, rowStep), cas + 100 + 6);
}

} // namespace
