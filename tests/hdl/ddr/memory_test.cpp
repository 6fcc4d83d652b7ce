// SPDX-License-Identifier: MIT
//
// memory_test: compares the memory controller with a reference memory, under random traffic from
// all ports. It also tests accesses that a port makes before the memory is calibrated.

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
#include "mcb_model.h"
#include "memory_bench.h"
#include "npi_requester.h"
#include <cstring>
#include <gtest/gtest.h>
#include <memory>

namespace {

// A memory controller with `count` ports and an ADDR_WIDTH of `bits`.
template <class Module, unsigned count, unsigned bits = 27> struct Kind {
    static constexpr unsigned ports = count, width = bits;
    using Bench = MemoryBench<Module, count>;
    using Whole = MemoryBench<Module, count, size_t(1) << bits>;
};
using Kinds =
    ::testing::Types<Kind<VMemoryMcb2, 2>, Kind<VMemoryMcb3, 3>, Kind<VMemoryMcb4, 4>,
                     Kind<VMemoryMcb4Options, 4, 28>, Kind<VMemoryMcb5, 5>, Kind<VMemoryMcb6, 6>,
                     Kind<VMemoryMcb7, 7>, Kind<VMemoryMcb8, 8>, Kind<VMemoryMcbNetlist, 2>>;

template <class T> class Memory : public ::testing::Test {
protected:
    static constexpr unsigned ports = T::ports;
    uint64_t seed_ = testSeed();
    typename T::Bench memory_{seed_};

    void all(const NpiTraffic& traffic) {
        for (unsigned p = 0; p < ports; ++p)
            memory_.requesters.traffic(p) = traffic;
    }
    // Runs the traffic. If it fails, adds the seed to the message.
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

TYPED_TEST(Memory, FastReadersMayRequestMoreThanAFifoHolds) {
    NpiTraffic traffic;
    traffic.outstanding = 200;
    traffic.writes = 0.2;
    traffic.minSize = 4;
    this->all(traffic);
    this->run(20000);
}

TYPED_TEST(Memory, SlowReadersLoseNoWord) {
    NpiTraffic traffic;
    traffic.writes = 0.1;
    traffic.pop = 0.05;
    this->all(traffic);
    this->run(20000);
}

TYPED_TEST(Memory, SlowWritersDoNotDelayOtherPorts) {
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

TYPED_TEST(Memory, TheWholeMemoryIsAddressableAndHigherBitsAreIgnored) {
    uint64_t seed = testSeed();
    auto memory = std::make_unique<typename TypeParam::Whole>(seed);
    NpiTraffic traffic;
    traffic.bytes = 1u << TypeParam::width;
    traffic.above = ~(traffic.bytes - 1);
    for (unsigned p = 0; p < TypeParam::ports; ++p)
        memory->requesters.traffic(p) = traffic;
    ASSERT_NO_THROW(memory->run(5000); memory->drain()) << "SEED=" << seed;
}

TEST(Calibration, RequestsWaitUntilCalibrationSetsInitDone) {
    constexpr uint64_t data = 0x1122334455667788;
    constexpr uint32_t address = 0x40;
    Bench<VMemoryMcb2> bench;
    VMemoryMcb2& top = bench.top();
    McbModel memory{1 << 20};
    bench.addModel([&] { sampleMcb(top, memory); }, [&] { driveMcb(top, memory); });
    driveMcb(top, memory);
    bench.reset();
    setBits(top.npi_wr_data_i, 0, 64, data);
    setBits(top.npi_wr_be_i, 0, 8, 0xFF);
    setBits(top.npi_addr_i, 0, 32, address);
    top.npi_rmw_i = top.npi_wr_push_i = 1;
    bench.tick();
    top.npi_wr_push_i = 0;
    top.npi_addr_req_i = 1;
    top.eval();
    bench.waitFor([&] { return top.npi_addr_ack_o == 1; }, "the acknowledgement");
    bench.tick();
    top.npi_addr_req_i = 0;
    EXPECT_EQ(top.npi_init_done_o, 0);
    bench.waitFor([&] { return top.npi_init_done_o == 3; }, "InitDone");
    EXPECT_TRUE(memory.pins.calibDone);
    bench.tick(60);
    EXPECT_EQ(std::memcmp(memory.data() + address, &data, 8), 0);
}

} // namespace
