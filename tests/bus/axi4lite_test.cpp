// SPDX-License-Identifier: MIT
//
// axi4lite_test: the adapter against AXI4-Lite slaves that are ready late, answer late, err and
// hang.

#include "VAxi4Lite.h"
#include "bus_master.h"
#include "random.h"
#include <gtest/gtest.h>
#include <map>

namespace {

constexpr unsigned pageWord = 3, firstWord = 8, timeoutEvent = 2;

// A memory behind AXI4-Lite; each channel is ready, and each response valid, after random waits.
class Slave {
public:
    Slave(Bench<VAxi4Lite>& bench, uint64_t seed) : top_(bench.top()), random_(seed) {
        bench.addModel([this] { sample(); }, [this] { drive(); });
    }
    double wait = 0; // probability a clock, on every channel
    bool hang = false, err = false;
    unsigned hangs = 0; // clocks that it still does, if not 0
    std::map<uint32_t, uint32_t> memory;
    unsigned responses = 0;

private:
    void sample() {
        if (hangs && !--hangs)
            hang = false;
        if (top_.axi_bvalid_i && top_.axi_bready_o) {
            bValid_ = aw_ = w_ = false;
            ++responses;
        }
        if (top_.axi_rvalid_i && top_.axi_rready_o) {
            rValid_ = ar_ = false;
            ++responses;
        }
        if (top_.axi_awvalid_o && top_.axi_awready_i) {
            aw_ = true;
            awAddr_ = top_.axi_awaddr_o;
        }
        if (top_.axi_wvalid_o && top_.axi_wready_i) {
            if (top_.axi_wstrb_o != 15)
                throw std::runtime_error("not a whole word");
            w_ = true;
            wData_ = top_.axi_wdata_o;
        }
        if (top_.axi_arvalid_o && top_.axi_arready_i) {
            ar_ = true;
            arAddr_ = top_.axi_araddr_o;
        }
        if (aw_ && w_ && !bValid_ && !hang && !random_.chance(wait)) {
            bValid_ = true;
            if (!err)
                memory[awAddr_] = wData_;
        }
        if (ar_ && !rValid_ && !hang && !random_.chance(wait)) {
            rValid_ = true;
            rData_ = memory[arAddr_];
        }
    }
    void drive() {
        top_.axi_awready_i = !aw_ && !random_.chance(wait);
        top_.axi_wready_i = !w_ && !random_.chance(wait);
        top_.axi_arready_i = !ar_ && !random_.chance(wait);
        top_.axi_bvalid_i = bValid_;
        top_.axi_rvalid_i = rValid_;
        top_.axi_bresp_i = err ? 2 : 0; // SLVERR
        top_.axi_rresp_i = err ? 3 : 0; // DECERR
        top_.axi_rdata_i = rValid_ ? rData_ : 0xBAD0BAD0;
    }

    VAxi4Lite& top_;
    Random random_;
    bool aw_ = false, w_ = false, ar_ = false, bValid_ = false, rValid_ = false;
    uint32_t awAddr_ = 0, arAddr_ = 0, wData_ = 0, rData_ = 0;
};

class Axi4Lite : public ::testing::Test {
protected:
    Axi4Lite() { bench_.reset(); }
    Bench<VAxi4Lite> bench_;
    BusMaster<VAxi4Lite> bus_{bench_};
    Slave slave_{bench_, testSeed(13)};
};

TEST_F(Axi4Lite, RandomTraffic) {
    Random random(testSeed(5));
    std::map<uint32_t, uint32_t> reference;
    unsigned count = 0;
    uint32_t page = 0;
    for (double wait : {0.0, 0.3, 0.6}) {
        slave_.wait = wait;
        for (int i = 0; i < 700; ++i) {
            if (random.chance(0.1)) {
                page = random.below(128) * 32;
                bus_.write(pageWord, page);
            }
            unsigned word = random.below(8);
            bool write = random.chance(0.5);
            uint32_t data = random.next();
            auto answer = bus_.transfer(write, firstWord + word, data);
            ASSERT_FALSE(answer.error) << "SEED " << testSeed(5) << ", step " << i;
            ++count;
            if (write)
                reference[page + 4 * word] = data;
            else
                ASSERT_EQ(answer.data, reference[page + 4 * word]) << "SEED " << testSeed(5);
        }
    }
    EXPECT_EQ(slave_.responses, count) << "one transfer an access";
    EXPECT_EQ(reference, slave_.memory);
}

TEST_F(Axi4Lite, SlaveAndDecodeErrors) {
    slave_.err = true;
    EXPECT_TRUE(bus_.transfer(true, firstWord, 1).error);
    auto answer = bus_.transfer(false, firstWord, 0);
    EXPECT_TRUE(answer.error);
    EXPECT_EQ(answer.data, 0u) << "no data leaks with an error";
    EXPECT_EQ(bus_.read(1), 0u) << "an error is no time-out";
}

// AXI cannot give a transfer up: its late response must not answer the next access.
TEST_F(Axi4Lite, ALateResponseIsNotTheNextAnswer) {
    slave_.memory[0x00] = 0x0000AAAA;
    slave_.memory[0x04] = 0x0000BBBB;
    slave_.hang = true;
    auto answer = bus_.transfer(false, firstWord, 0);
    EXPECT_TRUE(answer.error);
    EXPECT_EQ(answer.cycles, 41u) << "TIMEOUT is 40 clocks";
    EXPECT_EQ(bus_.read(1), timeoutEvent);
    EXPECT_TRUE(bus_.transfer(false, firstWord + 1, 0).error) << "the core still owes the first";
    slave_.hangs = 5; // it answers in the midst of the next access
    EXPECT_EQ(bus_.read(firstWord + 1), 0xBBBBu);
    EXPECT_EQ(bus_.read(firstWord), 0xAAAAu);
    bus_.write(firstWord, 7);
    EXPECT_EQ(bus_.read(firstWord), 7u);
}

} // namespace
