// SPDX-License-Identifier: MIT
//
// npi_flags_test: one port by hand: flags, flushes, InitDone, words of a cache line, byte enables.

#include "VMemoryMcb2.h"
#include "bench.h"
#include "mcb_pins.h"
#include "npi_requester.h"
#include <cstring>
#include <gtest/gtest.h>

namespace {

class NpiPort : public ::testing::Test {
protected:
    void SetUp() override {
        bench_.addModel([this] { sampleMcb(top_, memory_); }, [this] { driveMcb(top_, memory_); });
        driveMcb(top_, memory_);
        bench_.reset();
    }
    void start() {
        bench_.waitFor([this] { return top_.npi_init_done_o == 3; }, "InitDone");
    }
    void push(uint64_t data, uint8_t enables = 0xFF) {
        setBits(top_.npi_wr_data_i, 0, 64, data);
        setBits(top_.npi_wr_be_i, 0, 8, enables);
        top_.npi_wr_push_i = 1;
        bench_.tick();
        top_.npi_wr_push_i = 0;
        top_.eval();
    }
    void request(bool read, uint32_t address, unsigned size) {
        setBits(top_.npi_addr_i, 0, 32, address);
        setBits(top_.npi_size_i, 0, 4, size);
        top_.npi_rnw_i = read;
        top_.npi_rmw_i = 1;
        top_.npi_addr_req_i = 1;
        bench_.waitFor([this] { return top_.npi_addr_ack_o == 1; }, "the acknowledgement");
        bench_.tick();
        top_.npi_addr_req_i = 0;
        top_.eval();
    }
    uint64_t pop(unsigned* place = nullptr) {
        bench_.waitFor([this] { return !(top_.npi_rd_empty_o & 1); }, "a word");
        uint64_t data = getBits(top_.npi_rd_data_o, 0, 64);
        if (place)
            *place = static_cast<unsigned>(getBits(top_.npi_rd_word_o, 0, 4));
        top_.npi_rd_pop_i = 1;
        bench_.tick();
        top_.npi_rd_pop_i = 0;
        top_.eval();
        return data;
    }
    void wait(unsigned cycles) { bench_.tick(cycles); }
    uint64_t inMemory(uint32_t address) {
        uint64_t value;
        std::memcpy(&value, memory_.data() + address, 8);
        return value;
    }

    Bench<VMemoryMcb2> bench_;
    VMemoryMcb2& top_ = bench_.top();
    McbModel memory_{1 << 20};
};

TEST_F(NpiPort, InitDoneComesWithTheMemorysCalibration) {
    EXPECT_EQ(top_.npi_init_done_o, 0);
    start();
    EXPECT_TRUE(memory_.pins.calibDone);
}

TEST_F(NpiPort, ARequestBeforeTheCalibrationWaitsForIt) {
    push(0x1122334455667788);
    request(false, 0x40, 0);
    EXPECT_EQ(top_.npi_init_done_o, 0);
    start();
    wait(60);
    EXPECT_EQ(inMemory(0x40), 0x1122334455667788u);
}

TEST_F(NpiPort, TheWriteFifoIsFullWithThirtyTwoWordsAndEmptyAgain) {
    start();
    for (unsigned i = 0; i < 32; ++i) {
        EXPECT_FALSE(top_.npi_wr_almost_full_o & 1) << i;
        push(i);
    }
    EXPECT_TRUE(top_.npi_wr_almost_full_o & 1);
    wait(2);
    EXPECT_FALSE(top_.npi_wr_empty_o & 1);
    request(false, 0x1000, 5);
    wait(60);
    EXPECT_TRUE(top_.npi_wr_empty_o & 1);
    for (unsigned i = 0; i < 32; ++i)
        EXPECT_EQ(inMemory(0x1000 + 8 * i), i);
}

TEST_F(NpiPort, AFlushDropsWordsThatNoRequestHasClaimed) {
    start();
    for (unsigned i = 0; i < 3; ++i)
        push(0xDEAD);
    top_.npi_wr_flush_i = 1;
    wait(1);
    top_.npi_wr_flush_i = 0;
    top_.eval();
    EXPECT_TRUE(top_.npi_wr_empty_o & 1);
    push(0x600D);
    request(false, 0x20, 0);
    wait(30);
    EXPECT_EQ(inMemory(0x20), 0x600Du);
    EXPECT_EQ(inMemory(0x28), 0u);
}

TEST_F(NpiPort, AFlushDropsReadWordsThatHaveCome) {
    start();
    memory_.data()[0x40] = 1;
    memory_.data()[0x80] = 2;
    request(true, 0x40, 2);
    wait(60);
    EXPECT_FALSE(top_.npi_rd_empty_o & 1);
    top_.npi_rd_flush_i = 1;
    wait(1);
    top_.npi_rd_flush_i = 0;
    top_.eval();
    EXPECT_TRUE(top_.npi_rd_empty_o & 1);
    request(true, 0x80, 0);
    EXPECT_EQ(pop(), 2u);
    wait(60);
    EXPECT_TRUE(top_.npi_rd_empty_o & 1);
}

TEST_F(NpiPort, ACacheLineThatIsReadFromItsMiddleSaysWhichWordIsWhich) {
    start();
    for (unsigned i = 0; i < 4; ++i)
        memory_.data()[0x60 + 8 * i] = static_cast<uint8_t>(0xA0 + i);
    request(true, 0x70, 2);
    for (unsigned i = 0; i < 4; ++i) {
        unsigned place;
        EXPECT_EQ(pop(&place), 0xA0 + i);
        EXPECT_EQ(place, i);
    }
    request(true, 0x68, 1);
    unsigned place;
    EXPECT_EQ(pop(&place), 0xA0u);
    EXPECT_EQ(place, 0u);
    EXPECT_EQ(pop(&place), 0xA1u);
    EXPECT_EQ(place, 1u);
}

TEST_F(NpiPort, ByteEnablesChooseTheBytes) {
    start();
    for (unsigned b = 0; b < 8; ++b) {
        push(0x8877665544332211u, static_cast<uint8_t>(1u << b));
        request(false, 0x200 + 8 * b, 0);
    }
    wait(100);
    for (unsigned b = 0; b < 8; ++b)
        EXPECT_EQ(inMemory(0x200 + 8 * b), 0x8877665544332211u & 0xFFull << 8 * b);
}

TEST_F(NpiPort, AWriteIsSeenByAReadThatIsAcknowledgedAfterIt) {
    start();
    push(42);
    request(false, 0x300, 0);
    request(true, 0x300, 0);
    EXPECT_EQ(pop(), 42u);
}

} // namespace
