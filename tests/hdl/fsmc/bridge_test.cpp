// SPDX-License-Identifier: MIT
//
// bridge_test: tests the FSMC bridge between the STM32's FSMC, a bus slave and a memory. Slave and
// memory may stall, fail or hang.

#include "VFsmcBridge.h"
#include "any_bridge.h"

namespace {

using Bridge = AnyBridge<VFsmcBridge>;

TEST_F(Bridge, MemoryEqualsAReferenceWithAllWidths) {
    traffic(b_, testSeed(), 3000);
}

TEST_F(Bridge, TheDriverCopiesAnyLengthToAnyAddress) {
    Random random(testSeed());
    for (int i = 0; i < 60; ++i) {
        uint32_t address = random.below(0x200), bytes = 1 + random.below(70);
        auto out = random.items<uint8_t>(bytes);
        std::vector<uint8_t> in(bytes);
        uint8_t before = b_.memory.byte(address + bytes);
        FSMC_writeMemory(address, out.data(), bytes);
        FSMC_readMemory(address, in.data(), bytes);
        EXPECT_EQ(in, out) << "SEED=" << testSeed() << " copy " << i;
        EXPECT_EQ(b_.memory.byte(address + bytes), before);
    }
}

TEST_F(Bridge, ADoorbellFlushesWritesAndDiscardsReadAheadData) {
    doorbellMakesWritesVisibleAndReadsFresh();
}

// The read begins one HCLK cycle after NWE's edge, sooner than the driver's BUSTURN allows. The
// read must return the written value, even if the synchroniser passes the write a clock late and
// the read in time (hdl.cdc.test_fsmc_pins).
TEST_F(Bridge, ARegisterReadAfterAWriteReturnsTheNewValue) {
    Random random(testSeed());
    FSMC_setHclk(120000000);
    for (unsigned i = 0; i < 300 && !HasFailure(); ++i) {
        const uint32_t place = 2 * random.below(1000), word = 64 + random.below(900);
        const auto value = static_cast<uint16_t>(random.next());
        const auto last = static_cast<uint16_t>(~value);
        const auto written = [&] { return b_.memory.byte(place) | b_.memory.byte(place + 1) << 8; };
        for (uint32_t btr : {0xA0000004u, 0xA000000Cu})
            fsmc_.write32(btr, fsmc::timing(2, 4)); // BUSTURN 0
        fsmc_.idle(random.below(8));
        fsmc_.write16(ddr + place, value);
        doorbell();
        EXPECT_EQ(written(), value) << "SEED=" << testSeed() << " access " << i;
        fsmc_.idle(random.below(8));
        fsmc_.write32(at(word), value);
        EXPECT_EQ(fsmc_.read32(at(word)), value) << "SEED=" << testSeed() << " access " << i;
        // the last step of FSMC_streamWrite reads a register, so the data must be in the memory
        // when it returns
        FSMC_streamWrite(place, &last, 1);
        EXPECT_EQ(written(), last) << "SEED=" << testSeed() << " stream " << i;
    }
    EXPECT_EQ(b_.errors, 0u);
}

TEST_F(Bridge, ASlaveErrorIsReportedWithItsAddress) {
    errorOfTheSlaveIsReportedWithItsPlace();
}

TEST_F(Bridge, AHungSlaveCausesAnErrorAndTheBridgeContinues) {
    hungSlaveEndsInAnError();
}

// NWAIT is off for NE2, against the rules of the bridge. A write during an earlier access to a slow
// slave is then lost, and the loss is reported.
TEST_F(Bridge, ARegisterWrittenTooEarlyIsLostAndReported) {
    const uint32_t bcr2 = fsmc::registersAt + 8, bcr = fsmc_.read32(bcr2);
    b_.slave.words[41] = 0x99998888;
    for (bool behindWrite : {true, false}) {
        unsigned errors = b_.errors;
        b_.slave.hung = true; // the slave hangs, but for less than the time-out
        fsmc_.write32(bcr2, bcr & ~fsmc::bcrAsyncWait);
        // The lost write below (to word 41) may change the high half of the word that is still in
        // transfer. Therefore it writes the value that this half already has.
        if (behindWrite)
            fsmc_.write32(at(40), 0x5A5A1234);
        else
            fsmc_.read16(at(40));
        fsmc_.idle(30); // after this time the slave has received the word
        EXPECT_EQ(b_.errors, errors);
        fsmc_.write16(at(41), 0x5A5A);
        fsmc_.idle(30);
        EXPECT_EQ(b_.errors, errors + 1);
        EXPECT_EQ(b_.errorAddr, 40u) << "address of the access that was in progress";
        EXPECT_EQ(b_.errorWrite, behindWrite);
        b_.slave.hung = false;
        fsmc_.write32(bcr2, bcr);
        fsmc_.write16(at(41) + 2, 0x7777);
        EXPECT_EQ(fsmc_.read32(at(41)), 0x99998888u);
        EXPECT_EQ(b_.errors, errors + 2)
            << "the high half of a word was written after its low half was lost";
        EXPECT_EQ(fsmc_.read32(at(40)), 0x5A5A1234u);
    }
}

TEST_F(Bridge, AHungMemoryCausesAnErrorAndTheBridgeContinues) {
    readOfAHungMemoryEndsInAnError();
    memoryWorksAgain();
}

// If the queue has no room for a write, the bridge reports an error and ends the access, as it does
// for a read without an answer. Two entries of the queue are reserved for such writes. When these
// entries are also full, further writes are lost.
TEST_F(Bridge, WritesToAHungMemoryCauseErrorsAndTheBridgeContinues) {
    b_.keepEvents();
    const uint32_t& event = b_.slave.words[b_.slave.clearWord];
    auto value = [](unsigned i) { return static_cast<uint16_t>(0xA000 + i); };
    b_.memory.hold(true);
    unsigned done = 0;
    for (; b_.errors == 0 && done < 32; ++done)
        fsmc_.write16(ddr + 8 * done, value(done)); // each write has another address
    const unsigned before = done - 1;
    EXPECT_EQ(before, 14u) << "two of the 16 places are reserved";
    EXPECT_EQ(b_.errorAddr, 0x3FFu);
    EXPECT_TRUE(b_.errorWrite);
    EXPECT_EQ(event, 0u);
    for (; done < before + 4; ++done)
        fsmc_.write16(ddr + 8 * done, value(done));
    EXPECT_EQ(b_.errors, 4u);
    fsmc_.idle(8); // after this time the last error has been counted
    b_.memory.hold(false);
    for (unsigned i = 0; i < done; ++i)
        EXPECT_EQ(fsmc_.read16(ddr + 8 * i), i < before + 2 ? value(i) : 0) << "write " << i;
    EXPECT_EQ(event, unsigned(SYSTEM_EVENT_LATE_MASK))
        << "the event must show that writes were lost";
    fsmc_.write16(ddr, 0x4321);
    EXPECT_EQ(fsmc_.read16(ddr), 0x4321);
    EXPECT_EQ(b_.errors, 4u);
}

// Accesses to registers wait for posted writes. If a memory does not accept these writes, this is
// reported, and the access to the register continues.
TEST_F(Bridge, RegistersRemainAccessibleWhileTheMemoryHangs) {
    b_.memory.hold(true);
    fsmc_.write16(ddr + 0x40, 0x1234);
    EXPECT_EQ(fsmc_.read32(at(0)), SYSTEM_ID_VALUE);
    EXPECT_GE(b_.errors, 1u);
    b_.memory.hold(false);
    unsigned errors = b_.errors;
    EXPECT_EQ(fsmc_.read16(ddr + 0x40), 0x1234) << "posted data must be written even after a delay";
    EXPECT_EQ(b_.errors, errors);
}

TEST_F(Bridge, AnAbortedAccessIsDoneCompletelyOrNotAtAll) {
    Random random(testSeed());
    for (int i = 0; i < 400; ++i) {
        uint32_t value = random.next(), other = random.next();
        unsigned word = 1 + random.below(100), hclk = 1 + random.below(30);
        uint32_t a = 2 * random.below(0x1FF8000);
        fsmc_.write32(at(word), value);
        fsmc_.write16(ddr + a, static_cast<uint16_t>(value));
        switch (random.below(5)) {
        case 0:
            fsmc_.abortRead(at(word), hclk);
            break;
        case 1:
            fsmc_.abortRead(ddr + a, hclk);
            break;
        case 2:
            fsmc_.abortWrite(at(word), static_cast<uint16_t>(other), hclk);
            break;
        case 3:
            fsmc_.abortWrite(ddr + a, static_cast<uint16_t>(other), hclk);
            break;
        default:
            fsmc_.abortRead(ddr + a + 64, hclk);
        }
        EXPECT_EQ(fsmc_.read32(at(word)), value) << "SEED=" << testSeed();
        EXPECT_EQ(fsmc_.read16(ddr + a), static_cast<uint16_t>(value));
        fsmc_.write32(at(word), other);
        EXPECT_EQ(fsmc_.read32(at(word)), other);
    }
    EXPECT_EQ(b_.errors, 0u);
}

// With the fastest timing and without NWAIT, the data is correct if the memory keeps up; otherwise
// the bridge reports the loss.
TEST_F(Bridge, StreamsAreCorrectWithASlowMemory) {
    Random random(testSeed());
    FSMC_setHclk(120000000);
    b_.keepEvents();
    uint64_t repeated = 0;
    for (double stall : {0.0, 0.3, 0.9, 0.97, 0.99}) {
        b_.memory.setStall(stall);
        for (int i = 0; i < 6; ++i) {
            uint32_t address = 2 * random.below(0x1FF8000), count = 1 + random.below(3000);
            auto out = random.items<uint16_t>(count);
            std::vector<uint16_t> in(count);
            uint32_t again = FSMC_streamWrite(address, out.data(), count);
            again += FSMC_streamRead(address, in.data(), count);
            ASSERT_EQ(in, out) << "SEED=" << testSeed() << " stall " << stall << " copy " << i;
            if (stall == 0.0) {
                EXPECT_EQ(again, 0u) << "a fast memory must not cause repetitions";
            }
            repeated += again;
        }
    }
    EXPECT_GT(repeated, 0u) << "a slow memory must cause repetitions";
}

// At an HCLK of 120 MHz, edges of NWE are 33.3 ns apart. With other ratios of the clocks, the edges
// have every phase relative to the bridge clock.
TEST(BridgeRatios, StreamWritesAreAcceptedAtEveryPhase) {
    Random random(testSeed());
    for (auto [hclk, clk] :
         {std::pair(120u, 100u), {1199u, 1000u}, {1000u, 999u}, {1083u, 1000u}}) {
        BridgeBench<VFsmcBridge> b(testSeed(), 0, hclk, clk);
        ASSERT_EQ(b.init(), FSMC_OK);
        FSMC_setHclk(static_cast<U32>(100e6 * hclk / clk));
        auto out = random.items<uint16_t>(5000);
        std::vector<uint16_t> in(out.size());
        uint64_t start = b.clocks();
        FSMC_streamWrite(0x400, out.data(), static_cast<U32>(out.size()));
        EXPECT_LT(b.clocks() - start, out.size() * 41 * clk / hclk / 10)
            << "an access must take 4 periods of HCLK";
        FSMC_streamRead(0x400, in.data(), static_cast<U32>(in.size()));
        EXPECT_EQ(in, out) << "SEED=" << testSeed() << " HCLK : clock = " << hclk << " : " << clk;
    }
}

TEST_F(Bridge, TheDriverSetsThePageAndReportsTheFirstBusError) {
    uint32_t* words = b_.slave.words.data() + MAP_SLOT_SYSTEM * 16;
    const uint8_t out[] = {1, 2, 3, 4};
    for (uint32_t page : {5u, 0u}) {
        FSMC_writeMemory(page << MAP_DDR_WINDOW_LOG2 | 0x100, out, sizeof out);
        doorbell();
        EXPECT_EQ(words[SYSTEM_PAGE], page);
        EXPECT_EQ(b_.memory.byte(0x103), 4);
    }
    b_.keepEvents();
    U32 where = 0;
    EXPECT_EQ(FSMC_checkError(&where), FSMC_OK);
    words[SYSTEM_EVENT] = SYSTEM_EVENT_BUS_ERROR_MASK | SYSTEM_EVENT_LATE_MASK;
    words[SYSTEM_ERROR_ADDR] = 0x123;
    EXPECT_EQ(FSMC_checkError(&where), FSMC_BUS_ERROR);
    EXPECT_EQ(where, 0x123u);
    doorbell();
    EXPECT_EQ(words[SYSTEM_EVENT], unsigned(SYSTEM_EVENT_LATE_MASK))
        << "exactly the reported event must be set";
}

TEST_F(Bridge, AccessesToOtherChipsAreIgnored) {
    constexpr uint32_t other = 0x68000000; // NE3
    fsmc_.write32(0xA0000010, 0x00001091);
    fsmc_.write32(0xA0000014, 0x00010805);
    fsmc_.write16(ddr + 0x10, 0x1234);
    for (int i = 0; i < 20; ++i) {
        fsmc_.write16(other + 0x10, 0xFFFF);
        EXPECT_EQ(fsmc_.read16(other + 0x10), 0xFFFF);
        EXPECT_EQ(fsmc_.read16(ddr + 0x10), 0x1234);
        EXPECT_EQ(fsmc_.read32(at(0)), SYSTEM_ID_VALUE);
    }
}

} // namespace
