// SPDX-License-Identifier: MIT
//
// memory_test: the memory controller with random traffic from all ports against a reference memory;
// and one port by hand: flags, flushes, InitDone.

#include "VMemoryMcb2.h"
#include "VMemoryMcb3.h"
#include "VMemoryMcb4.h"
#include "VMemoryMcb4Options.h"
#include "VMemoryMcb5.h"
#include "VMemoryMcb6.h"
#include "VMemoryMcb7.h"
#include "VMemoryMcb8.h"
#include "VMemoryMcbNetlist.h"
#include "bench.h"
#include "mcb_pins.h"
#include "memory_bench.h"
#include "npi_requester.h"
#include <cstring>
#include <gtest/gtest.h>
#include <memory>

namespace {

// A controller with its parameters; urgent: URGENT, run: URGENT_RUN, bits: ADDR_WIDTH.
template <class Module, unsigned count, unsigned urgent = 0, unsigned run = 3, unsigned bits = 27>
struct Kind {
    static constexpr unsigned ports = count, width = bits;
    using Bench = MemoryBench<Module, count>;
    using Whole = MemoryBench<Module, count, size_t(1) << bits>;

    // Requests of others granted before one of this port: npi_select's bounds.
    static unsigned bound(unsigned port) {
        unsigned u = static_cast<unsigned>(__builtin_popcount(urgent));
        if (u == 0 || u == count)
            return count - 1;
        return urgent >> port & 1 ? u + (u - 1) / run : (count - u) * (run + 1) - 1;
    }
};
using Kinds = ::testing::Types<Kind<VMemoryMcb2, 2>, Kind<VMemoryMcb3, 3, 7>, Kind<VMemoryMcb4, 4>,
                               Kind<VMemoryMcb4Options, 4, 8, 2, 28>, Kind<VMemoryMcb5, 5, 0x12, 1>,
                               Kind<VMemoryMcb6, 6>, Kind<VMemoryMcb7, 7, 0x78, 7>,
                               Kind<VMemoryMcb8, 8>, Kind<VMemoryMcbNetlist, 2>>;

template <class T> class Memory : public ::testing::Test {
protected:
    static constexpr unsigned ports = T::ports;
    uint64_t seed_ = testSeed();
    typename T::Bench memory_{seed_};

    void all(const NpiTraffic& traffic) {
        for (unsigned p = 0; p < ports; ++p)
            memory_.requesters.traffic(p) = traffic;
    }
    // Runs, and names the seed of a failure.
    void run(uint64_t cycles) {
        ASSERT_NO_THROW(memory_.run(cycles); memory_.drain()) << "SEED=" << seed_;
        for (unsigned p = 0; p < ports; ++p)
            EXPECT_GT(memory_.requesters.counters(p).requests, 0u) << "port " << p;
    }
};
TYPED_TEST_SUITE(Memory, Kinds);

TYPED_TEST(Memory, RandomTrafficOnOneSmallRegionEqualsTheReference) {
    NpiTraffic traffic;
    traffic.ask = 0.3;
    traffic.push = traffic.pop = 0.7;
    traffic.bytes = 2048; // all ports write and read the same words
    this->all(traffic);
    this->run(20000);
}

TYPED_TEST(Memory, FullSpeedTrafficOfEverySizeEqualsTheReference) {
    this->all(NpiTraffic());
    this->run(20000);
}

TYPED_TEST(Memory, ReadersThatTakeTheirWordsAtOnceMayAskForMoreThanAFifoHolds) {
    NpiTraffic traffic;
    traffic.outstanding = 200;
    traffic.writes = 0.2;
    traffic.minSize = 4;
    this->all(traffic);
    this->run(20000);
}

TYPED_TEST(Memory, RequestersThatTakeTheirWordsSlowlyLoseNone) {
    NpiTraffic traffic;
    traffic.writes = 0.1;
    traffic.pop = 0.05;
    this->all(traffic);
    this->run(20000);
}

TYPED_TEST(Memory, WordsThatArePushedSlowlyDoNotHoldOthersUp) {
    NpiTraffic slow;
    slow.writes = 1;
    slow.push = 0.02;
    slow.minSize = slow.maxSize = 5;
    this->all(NpiTraffic());
    this->memory_.requesters.traffic(0) = slow;
    this->run(20000);
    EXPECT_GT(this->memory_.requesters.counters(1).requests,
              5 * this->memory_.requesters.counters(0).requests);
}

TYPED_TEST(Memory, EveryPortIsServedWithinItsBound) {
    NpiTraffic traffic;
    traffic.maxSize = 0; // the queue is full of short ones: everybody waits
    this->all(traffic);
    this->run(20000);
    for (unsigned p = 0; p < this->ports; ++p) {
        unsigned bound = TypeParam::bound(p);
        uint64_t others = this->memory_.requesters.counters(p).othersMax;
        EXPECT_LE(others, bound) << "port " << p;
        EXPECT_GE(others + 1, std::min(bound, 3u)) << "port " << p << ": nobody was in its way";
    }
}

TYPED_TEST(Memory, AddressesOfTheWholeMemoryAndBitsAboveIt) {
    uint64_t seed = testSeed();
    auto memory = std::make_unique<typename TypeParam::Whole>(seed);
    NpiTraffic traffic;
    traffic.bytes = 1u << TypeParam::width;
    traffic.above = ~(traffic.bytes - 1);
    for (unsigned p = 0; p < TypeParam::ports; ++p)
        memory->requesters.traffic(p) = traffic;
    ASSERT_NO_THROW(memory->run(5000); memory->drain()) << "SEED=" << seed;
}

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
    void push(uint64_t data) {
        setBits(top_.npi_wr_data_i, 0, 64, data);
        setBits(top_.npi_wr_be_i, 0, 8, 0xFF);
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
    uint64_t pop() {
        bench_.waitFor([this] { return !(top_.npi_rd_empty_o & 1); }, "a word");
        uint64_t data = getBits(top_.npi_rd_data_o, 0, 64);
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

} // namespace
